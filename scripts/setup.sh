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

# An up-to-date build prints nothing and compiles nothing; a failing one prints its last lines.
raycell_build() {
    local build=$1
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
    if ! cmake --build "$build" "${targets[@]}" >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        echo "The build in $build failed; the whole log is $log" >&2
        exit 1
    fi
}
