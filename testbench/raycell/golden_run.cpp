#include "testbench/raycell/golden_run.hpp"

#include <algorithm>

#include "testbench/common/cell_ranges.hpp"

namespace raycell {
namespace {

constexpr int most_files = 256;  // all of them are open at once

std::string suffix_of(int x, int y) {
    return ".golden_" + std::to_string(x) + "_" + std::to_string(y) + ".txt";
}

}  // namespace

void check_golden(const RenderOptions& options) {
    if (options.golden.empty()) return;
    if (options.engine == Engine::untimed) {
        throw UsageError("--golden: the untimed engine sends no messages; expected --engine timed");
    }
    check_inside("--golden", options.golden, options.picture);
    int cells = 0;
    for (const CellRange& range : options.golden)
        cells += (range.x1 - range.x0 + 1) * (range.y1 - range.y0 + 1);
    if (cells > most_files) {
        throw UsageError("--golden: " + std::to_string(cells) + " cells, a file each; expected " +
                         std::to_string(most_files) + " at most");
    }
}

std::vector<std::string> golden_suffixes(const RenderOptions& options) {
    std::vector<std::string> suffixes;
    for (const CellRange& range : options.golden) {
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x) suffixes.push_back(suffix_of(x, y));
    }
    std::sort(suffixes.begin(), suffixes.end());
    suffixes.erase(std::unique(suffixes.begin(), suffixes.end()), suffixes.end());
    return suffixes;
}

GoldenRun::GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine,
                     OutputSet& outputs) {
    std::vector<GoldenRecorder::Target> targets;
    for (const Cell* cell : cells_in(options.golden, machine.array())) {
        targets.push_back({cell, outputs.begin(suffix_of(cell->x(), cell->y())).stream()});
    }
    recorder_ = new GoldenRecorder("golden", machine, targets, configuration);
}

}  // namespace raycell
