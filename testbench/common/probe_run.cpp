#include "testbench/common/probe_run.hpp"

#include <filesystem>
#include <iostream>

#include "testbench/common/cell_ranges.hpp"
#include "testbench/common/scene_input.hpp"

namespace raycell {
namespace {

ProbeSettings settings_of(const ProbeOptions& options) {
    return {options.window.from, options.window.to, std::uint64_t(options.limit_mb) * 1000000,
            options.mark < 0 ? never : Cycle(options.mark)};
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
    if (p.on_deadlock && p.mark >= 0)
        throw UsageError(
            "--vcd-mark: --vcd-on-deadlock marks the cycle in which the knot formed; expected one of them");
    if (p.cells.empty() && !whole_run) throw UsageError("--window: expected --probe beside it");
    if (options.prefix.empty() && (!p.cells.empty() || p.on_deadlock))
        throw UsageError("--output: expected one, for the files of --probe and --vcd-on-deadlock");
    check_inside("--probe", p.cells, options.picture);
}

ProbeRun::ProbeRun(const RenderOptions& options, Machine& machine, OutputSet& outputs)
    : machine_(machine),
      name_(file_name(options.prefix)),
      file_(outputs.begin(".vcd")),
      probe_(cells_in(options.probes.cells, machine.array()), machine.environment(), file_.stream(),
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

void ProbeRun::write(OutputSet& outputs) { outputs.write(".gtkw", probe_.save_file(name_)); }

}  // namespace raycell
