# Sourced by the other scripts: installs the Debian packages that are missing, then configures and builds.
# Usage: raycell_setup; raycell_build BUILD_DIR [TARGET ...]

raycell_packages="g++ cmake ninja-build pkg-config libsystemc-dev libglm-dev libopenexr-dev libpng-dev
    libembree-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libtinyobjloader-dev libgtest-dev
    libopenmpi-dev openmpi-bin"

raycell_setup() {
    local missing=() package
    for package in $raycell_packages "$@"; do
        if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
            missing+=("$package")
        fi
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local install="apt-get install -y --no-install-recommends ${missing[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
            as_root=(sudo)
        else
            echo "Packages are missing. As root, run: apt-get update && $install" >&2
            exit 1
        fi
    fi
    echo "Installing: ${missing[*]}" >&2
    if ! { "${as_root[@]}" apt-get update -qq && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive $install; } \
        >"${TMPDIR:-/tmp}/raycell-apt.log" 2>&1; then
        tail -n 20 "${TMPDIR:-/tmp}/raycell-apt.log" >&2
        echo "Installing failed. As root, run: apt-get update && $install" >&2
        exit 1
    fi
}

# Of a build's lines "[n/N] what is done": the last one on a terminal, every twentieth elsewhere.
raycell_progress() {
    local line number
    while IFS= read -r line; do
        [[ $line == \[*/*\]* ]] || continue
        number=${line%%/*}
        number=${number#[}
        if [ -t 2 ]; then
            printf '\r\033[K%.*s' "$((${COLUMNS:-100} - 1))" "$line" >&2
        elif ((number % 20 == 0)); then
            echo "$line" >&2
        fi
    done
    if [ -t 2 ]; then printf '\r\033[K' >&2; fi
}

# Prints progress and, at the end, how long it took; nothing if all is up to date. A failing build prints its
# last lines.
raycell_build() {
    local build=$1 started=$SECONDS
    shift
    local log="$build/build.log"
    mkdir -p "$build"
    if [ ! -f "$build/build.ninja" ]; then
        echo "Configuring $build" >&2
        cmake -S "$raycell_root" -B "$build" -G Ninja "${raycell_cmake_options[@]}" >"$log" 2>&1 ||
            { tail -n 30 "$log" >&2; exit 1; }
    fi
    local targets=()
    [ $# -gt 0 ] && targets=(--target "$@")
    if ! cmake --build "$build" "${targets[@]}" 2>&1 | tee "$log" | raycell_progress; then
        tail -n 60 "$log" >&2
        echo "The build in $build failed; the whole log is $log" >&2
        exit 1
    fi
    local took=$((SECONDS - started))
    if ((took > 2)); then echo "Built $build in $((took / 60)) min $((took % 60)) s" >&2; fi
}

# Whether the words ask for help alone.
raycell_asks_help() {
    local word
    for word in "$@"; do
        if [ "$word" = -h ] || [ "$word" = --help ]; then return 0; fi
    done
    return 1
}

# The comment at the head of a script.
raycell_usage() { sed -n '2,/^set/{s/^# \{0,1\}//p}' "$1"; }
