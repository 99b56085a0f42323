// deadlock_tb: synthetic ray traffic through the simulated machine, without a scene: does it lock, and where?
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <systemc>

#include "cells/clock/wall_time.hpp"
#include "cells/meters/observer_list.hpp"
#include "model/tracing/traffic.hpp"
#include "testbench/common/cells_csv.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/deadlock_dump.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/interruptible.hpp"
#include "testbench/common/knot_report.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/probe_run.hpp"
#include "testbench/common/recording.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/common/traffic_options.hpp"
#include "testbench/raycell/commands.hpp"

namespace {

using namespace raycell;
using Json = nlohmann::ordered_json;

/// Whether all finished pixels equal the untimed machine's, bit for bit.
bool equals(const Picture& picture, const Picture& golden) {
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Pixel& a = picture.pixels[i];
        const Pixel& b = golden.pixels[i];
        if (a.cycle == 0) continue;  // not finished
        if (a.colour != b.colour || a.normal != b.normal || a.depth != b.depth || a.polygon != b.polygon) {
            return false;
        }
    }
    return true;
}

void summarise(const Json& json, std::uint64_t seed) {
    const Json& pixels = json["pixels"];
    std::cout << "verdict " << json["verdict"].get<std::string>() << " after " << json["cycles"]["trace"]
              << " cycles of trace, seed " << seed << "; " << pixels["completed"] << " of " << pixels["all"]
              << " pixels, the untimed picture " << (json["equals_untimed"] ? "equal" : "DIFFERS") << '\n'
              << "ray store: peak " << json["ray_store"]["peak"] << " of " << json["ray_store"]["capacity"]
              << ", mean " << std::setprecision(3) << json["ray_store"]["mean"].get<double>()
              << "; buffers, peak of " << json["buffers"]["depth"] << ":";
    for (const auto& [name, peak] : json["buffers"]["peak"].items()) {
        if (name != "load") std::cout << ' ' << name << ' ' << peak;
    }
    std::cout << "\npostponed " << json["deadlock"]["postponed"] << " rays of "
              << json["messages"]["rays"]["sent"] << " sent\n";
}

/// The files of a run that has ended, published together. False if a signal cut short the waveforms.
bool write_results(const RenderOptions& o, Machine& machine, const RunResult& result, const Json& json,
                   ProbeRun* probes, const Recording& recording, OutputSet& outputs) {
    std::string cells = cells_csv_header();
    for (const std::string& row : cells_csv_rows(machine, result)) cells += row;
    outputs.write(".toml", to_toml(json["config"]));
    outputs.write(".cells.csv", cells);
    outputs.write_if(!result.waits.nodes().empty(), ".waits.json",
                     [&] { return to_text(waits_json(result)); });
    outputs.write_if(result.waits.deadlocked(), ".knot.svg",
                     [&] { return knot_svg(result, o.picture.width, o.picture.height); });
    outputs.write(".json", to_text(json));
    if (probes) probes->write(outputs);
    recording.write(outputs);
    bool whole = true;
    if (o.probes.on_deadlock && result.verdict == Verdict::deadlock) {
        try {
            dump_deadlock({"deadlock_tb"}, o, json["config"], deadlocked_cells(result, machine),
                          result.schedule_hash, outputs);
        } catch (const Interrupted&) {
            std::cerr << "deadlock_tb: interrupted: no waveforms\n";
            for (const char* suffix : {".vcd", ".gtkw"}) outputs.write_if(false, suffix, {});
            whole = false;
        }
    }
    outputs.publish();
    return whole;
}

/// Announces all files; throws UsageError for places that are refused.
void announce(const RenderOptions& o, OutputSet& outputs) {
    if (o.prefix.empty()) return;
    check_place("--output", o.prefix);
    outputs.announce({".toml", ".cells.csv", ".waits.json", ".knot.svg", ".json"});
    if (!o.probes.cells.empty() || o.probes.on_deadlock) outputs.announce({".vcd", ".gtkw"});
    outputs.announce(recording_suffixes(o));
    spare_inputs(o, outputs);
}

int run(TrafficOptions& options, const OptionTable& table) {
    RenderOptions& o = options.run;
    check_granularity(o);
    check_probes(o);
    check_recording(o);
    OutputSet outputs(o.prefix);
    announce(o, outputs);
    check_memory(o);
    PictureSettings picture = traffic_picture(o.picture.width, o.picture.height, o.picture.max_depth);
    picture.pixels_wide = o.picture.pixels_wide;
    picture.pixels_high = o.picture.pixels_high;
    o.machine.seed = options.traffic.seed;
    const SyntheticTraffic traffic(options.traffic);
    const CellScene scene = traffic_scene(picture, options.traffic);
    const Bound bound = bound_of(Context(scene, picture), o.machine);
    warn_of(bound, "deadlock_tb");
    const auto start = WallClock::now();
    const Picture golden = UntimedMachine(scene, picture, nullptr, &traffic).render();
    const double wall_untimed = seconds_since(start);
    const auto built = WallClock::now();
    // Never destroyed: SystemC takes ports down in quadratic time.
    static Machine* const machine =
        new Machine("machine", scene, picture, o.machine, nullptr, &traffic, granularity_of(o));
    const double wall_build = seconds_since(built);
    std::unique_ptr<ProbeRun> probes;
    if (!o.probes.cells.empty()) probes = std::make_unique<ProbeRun>(o, *machine, outputs);
    CellObserverList observers;
    Recording recording(o, *machine, observers);
    if (!observers.empty()) machine->environment().meters.observer = &observers;
    const bool progress = shows_progress(o);
    const Interruptible interruptible(*machine);
    const RunResult result =
        machine->run(progress ? show_progress : std::function<void(const RunProgress&)>());
    if (progress) end_progress();
    if (probes) probes->finish();
    recording.finish();
    machine->environment().meters.observer = nullptr;

    Json json = report(result, scene, picture, o.machine);
    const bool equal = equals(result.picture, golden);
    json["equals_untimed"] = equal;
    json["config"] = table.values();
    json["model"]["wall_seconds"] = {{"untimed", wall_untimed},
                                     {"build", wall_build},
                                     {"load", result.wall_load},
                                     {"trace", result.wall_trace}};
    const bool whole =
        o.prefix.empty() || write_results(o, *machine, result, json, probes.get(), recording, outputs);
    explain(result, bound, "deadlock_tb");
    if (!o.quiet) summarise(json, options.traffic.seed);
    const bool waveforms = probes || (o.probes.on_deadlock && whole && result.verdict == Verdict::deadlock);
    if (!o.quiet && waveforms) tell_waveforms(o.prefix);
    if (!o.quiet && !o.prefix.empty()) tell_page(o.prefix);
    if (!equal) std::cerr << "deadlock_tb: the picture is not that of the untimed machine\n";
    if (!equal) return exit_comparison;
    return whole ? exit_code(result.verdict) : int(exit_interrupted);
}

/// The arguments of --preset and --config, followed by those of the command line, which so take precedence.
std::vector<std::string> with_configuration(const std::vector<std::string>& words, const CLI::App& app) {
    std::vector<std::string> all = preset_arguments(words, app);
    const std::string path = configuration_named(words);
    if (!path.empty()) {
        const std::vector<std::string> from_file = arguments_from_file(path, app);
        all.insert(all.end(), from_file.begin(), from_file.end());
    }
    all.insert(all.end(), words.begin() + 1, words.end());
    return all;
}

int run(int argc, char** argv) {
    TrafficOptions options;
    CLI::App app{"Synthetic ray traffic through the cell array, without a scene: does it lock?"};
    app.name("deadlock_tb");
    OptionTable table(app);
    add_preset_option(app);
    app.add_option("--config", options.run.config,
                   "options from a file as a run writes it; the command line has precedence")
        ->type_name("FILE");
    add_traffic_options(table, options);
    std::vector<std::string> words = with_configuration({argv, argv + argc}, app);
    return parse_and_run(app, std::move(words), [&] { return run(options, table); });
}

}  // namespace

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("deadlock_tb", "a smaller array", [&] { return run(argc, argv); });
}
