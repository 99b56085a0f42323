#include "testbench/raycell/golden_run.hpp"

#include <algorithm>

#include "testbench/common/cell_ranges.hpp"

namespace raycell {
namespace {

constexpr int most_recorded = 256;  // three files each, all open at once

/// PREFIX.golden_X_Y, without the ending.
std::string stem_of(int x, int y) { return ".golden_" + std::to_string(x) + "_" + std::to_string(y); }

std::string traversal_suffix(int x, int y) {
    return ".traversal_" + std::to_string(x) + "_" + std::to_string(y) + ".txt";
}

}  // namespace

void check_golden(const RenderOptions& options) {
    if (options.golden.empty()) return;
    if (options.engine == Engine::untimed) {
        throw UsageError("--golden: the untimed engine sends no messages; expected --engine timed");
    }
    if (options.picture.own_samples() > 1) {
        throw UsageError(
            "--golden: records are of cells with a primary ray each; expected --pixels to be the --cells, "
            "and "
            "--samples 1");
    }
    check_inside("--golden", options.golden, options.picture);
    int cells = 0;
    for (const CellRange& range : options.golden)
        cells += (range.x1 - range.x0 + 1) * (range.y1 - range.y0 + 1);
    if (cells > most_recorded) {
        throw UsageError("--golden: " + std::to_string(cells) + " cells, with files for each; expected " +
                         std::to_string(most_recorded) + " at most");
    }
}

std::vector<std::string> golden_suffixes(const RenderOptions& options) {
    std::vector<std::string> suffixes;
    for (const CellRange& range : options.golden) {
        for (int y = range.y0; y <= range.y1; ++y)
            for (int x = range.x0; x <= range.x1; ++x) {
                if (options.golden_part == GoldenPart::traversal) {
                    suffixes.push_back(traversal_suffix(x, y));
                    continue;
                }
                for (const char* ending : {".txt", memory_in_suffix, memory_out_suffix})
                    suffixes.push_back(stem_of(x, y) + ending);
            }
    }
    std::sort(suffixes.begin(), suffixes.end());
    suffixes.erase(std::unique(suffixes.begin(), suffixes.end()), suffixes.end());
    return suffixes;
}

GoldenRun::GoldenRun(const RenderOptions& options, const std::string& configuration, Machine& machine,
                     OutputSet& outputs) {
    if (options.golden_part == GoldenPart::cell) {
        record_cells(options, configuration, machine, outputs);
        return;
    }
    std::vector<TraversalRecorder::Target> targets;
    for (const Cell* cell : cells_in(options.golden, machine.array()))
        targets.push_back({cell, outputs.begin(traversal_suffix(cell->x(), cell->y())).stream()});
    traversal_ = std::make_unique<TraversalRecorder>(machine, targets, configuration);
}

void GoldenRun::record_cells(const RenderOptions& options, const std::string& configuration, Machine& machine,
                             OutputSet& outputs) {
    std::vector<GoldenRecorder::Target> targets;
    const bool packed = options.picture.numbers.arithmetic == Numbers::fixed;
    for (const Cell* cell : cells_in(options.golden, machine.array())) {
        const std::string stem = stem_of(cell->x(), cell->y());
        GoldenRecorder::Target target{cell, outputs.begin(stem + ".txt").stream(), nullptr, nullptr};
        for (auto& [file, ending] : {std::pair(&target.memory_in, memory_in_suffix),
                                     std::pair(&target.memory_out, memory_out_suffix)}) {
            if (packed) {
                *file = outputs.begin(stem + ending).stream();
            } else {
                outputs.write_if(false, stem + ending, {});
            }
        }
        targets.push_back(target);
    }
    recorder_ = new GoldenRecorder("golden", machine, targets, configuration);
}

CellObserver& GoldenRun::observer() {
    if (recorder_) return *recorder_;
    return *traversal_;
}

void GoldenRun::finish() {
    if (recorder_) recorder_->finish();
    if (traversal_) traversal_->finish();
}

}  // namespace raycell
