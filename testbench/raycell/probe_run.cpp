#include "testbench/raycell/probe_run.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "testbench/raycell/scene_input.hpp"

namespace raycell {
namespace {

/// The cells of all ranges, row by row, each once.
std::vector<const CellModule*> cells_of(const std::vector<CellRange>& ranges, Machine& machine) {
    std::vector<const CellModule*> cells;
    for (const auto& module : machine.array().cells()) {
        const Cell& cell = module->cell();
        if (std::any_of(ranges.begin(), ranges.end(),
                        [&](const CellRange& range) { return range.contains(cell.x(), cell.y()); })) {
            cells.push_back(module.get());
        }
    }
    return cells;
}

ProbeSettings settings_of(const ProbeOptions& options) {
    return {options.window.from, options.window.to, std::uint64_t(options.limit_mb) * 1000000};
}

std::string file_name(const std::string& prefix) { return std::filesystem::path(prefix).filename().string(); }

}  // namespace

void check_probes(const RenderOptions& options) {
    const ProbeOptions& p = options.probes;
    const bool whole_run = p.window.from == 0 && p.window.to == CycleWindow::open;
    if (options.engine == Engine::untimed && (!p.cells.empty() || p.on_deadlock)) {
        throw UsageError(std::string(p.on_deadlock ? "--vcd-on-deadlock" : "--probe") +
                         ": the untimed engine has no cycles to show; expected --engine timed");
    }
    if (p.on_deadlock && !p.cells.empty()) {
        throw UsageError("--vcd-on-deadlock: it finds its cells itself; expected no --probe beside it");
    }
    if (p.cells.empty() && !whole_run) throw UsageError("--window: expected --probe beside it");
    for (const CellRange& range : p.cells) {
        const int width = options.picture.width;
        const int height = options.picture.height;
        if (range.x1 < width && range.y1 < height) continue;
        throw UsageError("--probe: cell (" + std::to_string(range.x1) + ", " + std::to_string(range.y1) +
                         ") lies outside the array; expected x from 0 to " + std::to_string(width - 1) +
                         ", y from 0 to " + std::to_string(height - 1));
    }
}

ProbeRun::ProbeRun(const RenderOptions& options, Machine& machine)
    : machine_(machine),
      name_(file_name(options.prefix)),
      file_(options.prefix + ".vcd"),
      probe_(cells_of(options.probes.cells, machine), machine.environment(), file_.stream(),
             settings_of(options.probes),
             [path = options.prefix + ".vcd", progress = shows_progress(options)](const std::string& text) {
                 if (progress) end_progress();
                 std::cerr << path << ": warning: " << text << '\n';
             }) {
    machine.environment().scheduler.set_sampler([this](Cycle now) { probe_.sample(now); });
}

void ProbeRun::finish() {
    const Cycle last = machine_.environment().scheduler.now();
    machine_.environment().scheduler.set_sampler({});
    if (!probe_.begun()) {
        std::cerr << file_.path() << ": warning: the run ended in cycle " << last
                  << ", before --window begins: the dump has no values\n";
    }
    probe_.finish(last);
}

void ProbeRun::write(OutputSet& outputs) {
    outputs.write(".vcd", [this](const std::string&) { file_.finish(); });
    outputs.write(".gtkw", [this](const std::string& path) { write_text(path, probe_.save_file(name_)); });
}

}  // namespace raycell
