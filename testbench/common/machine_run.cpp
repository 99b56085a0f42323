#include "testbench/common/machine_run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>

#include "testbench/common/cell_ranges.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/common/time_estimate.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

/// Memory that this computer has for a process, page cache included; only free pages where the system doesn't
/// say.
double free_bytes() {
    std::ifstream file("/proc/meminfo");
    std::string key;
    double kilobytes = 0;
    std::string unit;
    while (file >> key >> kilobytes >> unit) {
        if (key == "MemAvailable:") return kilobytes * 1024;
    }
    return double(sysconf(_SC_AVPHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
}

/// Address space that this process may still take (`ulimit -v`).
double allowed_bytes() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::numeric_limits<double>::infinity();
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return std::max(double(limit.rlim_cur) - pages * double(sysconf(_SC_PAGESIZE)), 0.0);
}

/// Memory that grows with the array before anything is loaded: cells with their links, the picture, and its
/// copy in the result. With several ranks, the needs of all on this machine: each has a picture beside its
/// cells, and rank 0 puts them together.
double needed_bytes(const RenderOptions& options) {
    constexpr double untimed_cell = 200;
    const PictureSettings& p = options.picture;
    const double cells = double(p.width) * p.height;
    const double picture = cells * p.block() * double(sizeof(Pixel) + (p.samples > 1 ? sizeof(PixelSum) : 0));
    if (options.engine == Engine::untimed) return cells * untimed_cell + picture;
    const LaunchedRanks ranks = launched_ranks();
    const double pictures = ranks.count == 1 ? 2 : ranks.on_this_machine + 3;
    const double share = double(ranks.on_this_machine) / ranks.count;
    return pictures * picture + share * Array::bytes(granularity_of(options), p.width, p.height,
                                                     buffer_classes(options.machine.networks));
}

std::string gigabytes(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f GB", bytes < 10e9 ? 1 : 0, bytes / 1e9);
    return text;
}

}  // namespace

void check_memory(const RenderOptions& options) {
    constexpr double worth_telling = 1e9;
    const double needed = needed_bytes(options);
    const double there = std::min(free_bytes(), allowed_bytes());
    if (needed > there) {
        const bool modules = options.engine == Engine::timed && options.hosts == Hosts::cell;
        throw UsageError("--cells: " + gigabytes(needed) + " would be needed for so many cells, " +
                         gigabytes(there) + " are free; expected a smaller array" +
                         (modules ? ", or --granularity tile" : ""));
    }
    if (needed > worth_telling && !options.quiet) {
        std::cerr << "about " << gigabytes(needed) << " of memory before anything is loaded, "
                  << gigabytes(there) << " are free\n";
    }
}

void check_wires(const RenderOptions& options) {
    if (!options.machine.wire_check) return;
    if (options.engine == Engine::untimed)
        throw UsageError("--wire-check: the untimed engine has no links; expected --engine timed");
    if (options.picture.numbers.arithmetic == Numbers::exact)
        throw UsageError("--wire-check: exact numbers are no words; expected --arithmetic fixed");
}

void check_granularity(const RenderOptions& options) {
    if (options.detail.empty()) return;
    if (options.engine == Engine::untimed)
        throw UsageError("--detail: the untimed engine has no modules; expected --engine timed");
    if (options.hosts == Hosts::cell)
        throw UsageError("--detail: every cell is a module already; expected --granularity auto or tile");
    check_inside("--detail", options.detail, options.picture);
}

Granularity granularity_of(const RenderOptions& options) {
    Granularity granularity;
    granularity.every_cell = options.hosts == Hosts::cell;
    granularity.detail = options.detail;
    if (options.hosts == Hosts::automatic) {
        for (const auto* more : {&options.probes.cells, &options.golden})
            granularity.detail.insert(granularity.detail.end(), more->begin(), more->end());
    }
    return granularity;
}

void show_progress(const RunProgress& p) { std::cerr << "\r" << progress_line(p) << "\033[K" << std::flush; }

int exit_code(Verdict verdict) {
    switch (verdict) {
        case Verdict::completed:
            return exit_done;
        case Verdict::deadlock:
        case Verdict::livelock:
            return exit_stuck;
        case Verdict::cycle_limit:
        case Verdict::capacity:
            return exit_limit;
        case Verdict::interrupted:
            return exit_interrupted;
    }
    return exit_usage;
}

void tell_waveforms(const std::string& prefix) {
    std::cout << "waveforms: " << prefix << ".vcd, to be opened with " << prefix << ".gtkw\n";
}

void tell_page(const std::string& prefix) {
    std::cout << "page of the run: scripts/study report " << prefix << ".json\n";
}

void warn_of(const Bound& bound, const char* program) {
    if (bound.met()) return;
    std::cerr << program << ": warning: the run may end in a " << name_of(bound.may) << ": " << bound.advice()
              << '\n';
}

namespace {

/// The places of the oldest knot's ring: "(3, 4) -> (3, 5) -> (3, 4)".
std::string ring_of(const WaitGraph& waits) {
    constexpr std::size_t shown = 13;
    const std::vector<WaitGraph::Index> ring = waits.ring(waits.knots().front());
    std::string text;
    std::string last;
    std::size_t cells = 0;
    for (std::size_t i = 0; i <= ring.size(); ++i) {
        const WaitGraph::Node& node = waits.nodes()[ring[i % ring.size()]];
        const std::string place = "(" + std::to_string(node.x) + ", " + std::to_string(node.y) + ")";
        if (place == last) continue;  // two places of one cell
        if (!last.empty()) text += " -> ";
        if (++cells > shown) return text + "... and back, " + std::to_string(ring.size()) + " places in all";
        text += last = place;
    }
    return text;
}

}  // namespace

void explain(const RunResult& result, const Bound& bound, const char* program) {
    if (result.verdict == Verdict::completed) return;
    std::cerr << program << ": verdict " << name_of(result.verdict);
    if (result.storage.overflowed > 0) {
        std::cerr << ": " << result.storage.overflowed << " voxels did not fit (--voxel-capacity "
                  << result.storage.max_voxels << "), the fullest cell would need "
                  << result.storage.max_needed;
    }
    const bool stuck = result.verdict == Verdict::deadlock || result.verdict == Verdict::livelock;
    if (stuck && !bound.met()) std::cerr << ": " << bound.advice();
    std::cerr << '\n';
    constexpr std::size_t shown = 10;
    for (std::size_t i = 0; i < result.report.size() && i < shown; ++i)
        std::cerr << "  " << result.report[i] << '\n';
    if (result.waits.deadlocked()) {
        const WaitGraph& waits = result.waits;
        std::size_t places = 0;
        for (const auto& knot : waits.knots()) places += knot.size();
        const bool several = waits.knots().size() > 1;
        std::cerr << "  " << (several ? "the oldest knot's ring" : "a ring")
                  << ", each waiting for the next: " << ring_of(waits) << "\n  " << waits.knots().size()
                  << (several ? " knots" : " knot") << " of " << places << " places, " << waits.tails()
                  << " more wait for them; " << (several ? "the oldest stands" : "it stands")
                  << " since cycle " << result.knot_formed << ", the last movement was in cycle "
                  << result.ended << '\n';
    }
    if (result.report.size() > shown) {
        std::cerr << "  ... " << result.report.size() << " in all, see deadlock.report in the JSON\n";
    }
}

}  // namespace raycell
