#include "testbench/raycell/golden_run.hpp"

#include "testbench/raycell/cell_ranges.hpp"

namespace raycell {
namespace {

constexpr int most_files = 256;  // all of them are open at once

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

GoldenRun::GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine) {
    std::vector<GoldenRecorder::Target> targets;
    for (const Cell* cell : cells_in(options.golden, machine.array())) {
        const std::string suffix =
            ".golden_" + std::to_string(cell->x()) + "_" + std::to_string(cell->y()) + ".txt";
        files_.push_back({suffix, std::make_unique<NewFile>(options.prefix + suffix)});
        targets.push_back({cell, files_.back().file->stream()});
    }
    recorder_ = new GoldenRecorder("golden", machine, targets, configuration);
}

void GoldenRun::write(OutputSet& outputs) {
    for (File& file : files_) outputs.write(file.suffix, [&](const std::string&) { file.file->finish(); });
}

}  // namespace raycell
