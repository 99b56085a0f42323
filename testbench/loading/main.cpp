// loading_tb: the loading pipeline alone, without rays. Does it load what it should, in order, and what
// delays it?
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <systemc>

#include "cells/clock/wall_time.hpp"
#include "model/machine/losses.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/interruptible.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/loading/random_scene.hpp"
#include "testbench/loading/report.hpp"
#include "testbench/loading/tap.hpp"
#include "testbench/raycell/commands.hpp"

namespace {

using namespace raycell;
using namespace raycell::loading;
using Json = nlohmann::ordered_json;
struct Options {
    RenderOptions run;  ///< scene, array, machine, --output, --quiet
    RandomPolygons random;
};

void add_random_options(OptionTable& table, RandomPolygons& r) {
    table.number("random", r.count, 0, 10000000,
                 "draws so many polygons instead of reading a scene; 0: none");
    table.number("sides", r.sides, 3, 16, "random polygons: corners of each");
    table.number("objects", r.objects, 1, 1000000, "random polygons: objects that they belong to");
    table.number("least-size", r.least_size, 1e-3, 1e4, "random polygons: least diameter, cells");
    table.number("most-size", r.most_size, 1e-3, 1e4, "random polygons: largest diameter, cells");
    table.choice("sizes", r.sizes, {{"log", Sizes::log}, {"uniform", Sizes::uniform}},
                 "random polygons: whether the diameter's logarithm is uniform or the diameter");
    table.choice("slopes", r.slopes,
                 {{"isotropic", Slopes::isotropic}, {"angle", Slopes::angle}, {"slope", Slopes::slope}},
                 "random polygons: every direction alike, or angle with the screen or its tangent uniform to "
                 "most-slope");
    table.number("most-slope", r.most_slope, 0.0, 1e6, "random polygons: largest depth per cell; see slopes");
    table.number("cube-depth", r.depth, 1e-3, 1e6, "random polygons: depth of the cube, cells");
}

void add_options(OptionTable& table, Options& options) {
    RenderOptions& run = options.run;
    table.text("output", run.prefix, "PREFIX",
               "writes PREFIX.json, .toml, .columns.csv, .rows.csv, .links.csv; empty: no files");
    add_placement_options(table, run);
    add_random_options(table, options.random);
    add_voxel_options(table, run.picture);
    add_word_options(table, run.picture.numbers);
    table.number("buffer", run.machine.buffer_depth, 1, 1024,
                 "depth of every buffer between distributors, before and in cells, messages");
    add_link_options(table, run.machine);
    table.number("seed", run.machine.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1,
                 "of random polygons and stalls");
    table.costs(run.machine.costs);
    table.flag("quiet", run.quiet, "no progress, no summary");
}

CellScene scene_of(Options& options, const OutputSet& outputs) {
    RandomPolygons& random = options.random;
    random.seed = options.run.machine.seed;
    if (random.count == 0) return read_and_place(options.run, outputs);
    spare_inputs(options.run, outputs);
    if (!options.run.scene.empty()) throw UsageError("--random and a scene; expected one of them");
    return random_scene(random, options.run.picture);
}

std::vector<const CellStore*> stores_of(Machine& machine) {
    std::vector<const CellStore*> stores;
    for (const Cell& cell : machine.array().cells()) stores.push_back(&cell.store());
    return stores;
}

/// A stopped run has loaded only a part of the scene, so the expected contents of its cells are unknown.
NamedFaults check(Loading& loading, LoadWatch& watch) {
    const Verdict verdict = loading.result.verdict;
    const bool whole = verdict == Verdict::completed || verdict == Verdict::capacity;
    NamedFaults checks;
    if (whole) {
        watch.finish();
        watch.finish_at(loading.result.load_cycles);
        const Arithmetic arithmetic(loading.picture.numbers, extent_of(loading.scene.frame));
        const std::vector<CellStore> untimed = load_array(loading.scene, loading.picture, arithmetic);
        checks.emplace_back("stores", compare_stores(loading.cells, untimed, loading.plan.layout.width));
    }
    checks.emplace_back("content", watch.content());
    checks.emplace_back("order", watch.order());
    checks.emplace_back("promptness", watch.promptness());
    if (whole) {
        checks.emplace_back("conservation", watch.conservation());
        checks.emplace_back("bound", check_bound(loading.result.load_cycles, loading.plan.bound()));
    }
    return checks;
}

void write(const Loading& loading, const Json& json, OutputSet& outputs) {
    outputs.write(".columns.csv", columns_csv(loading));
    outputs.write(".rows.csv", rows_csv(loading));
    outputs.write(".links.csv", links_csv(loading));
    outputs.write(".toml", to_toml(json["config"]));
    outputs.write(".json", to_text(json));
    outputs.publish();
}

void complain(const NamedFaults& checks) {
    for (const auto& [name, faults] : checks) {
        if (faults.count == 0) continue;
        std::cerr << "loading_tb: check '" << name << "' failed, " << faults.count << " faults\n";
        for (const std::string& fault : faults.first) std::cerr << "  " << fault << '\n';
    }
}

/// Runs the machine. False if the machine itself found that messages were lost.
bool load(Machine& machine, const LoadPlan& plan, LoadWatch& watch, const RenderOptions& options,
          RunResult& result) {
    const MachineTap tap(machine, plan.layout, watch);
    const bool progress = shows_progress(options);
    try {
        result = machine.run(progress ? show_progress : std::function<void(const RunProgress&)>());
    } catch (const std::logic_error& error) {
        watch.finish();
        std::cerr << "loading_tb: " << error.what() << '\n';
        complain(
            {{"content", watch.content()}, {"order", watch.order()}, {"conservation", watch.conservation()}});
        return false;
    }
    if (progress) end_progress();
    return true;
}

int run(Options& options, const OptionTable& table) {
    RenderOptions& o = options.run;
    o.picture.stage = RunStage::load;
    o.picture.source_samples = 1;  // nothing that is loaded depends on it
    OutputSet outputs(o.prefix);
    if (!o.prefix.empty()) {
        check_place("--output", o.prefix);
        outputs.announce({".columns.csv", ".rows.csv", ".links.csv", ".toml", ".json"});
    }
    check_memory(o);
    const CellScene scene = scene_of(options, outputs);
    const Context context(scene, o.picture);
    for (const std::string& warning : loss_warnings(losses_of(context), context)) {
        std::cerr << "loading_tb: warning: " << warning << '\n';
    }
    const auto start = WallClock::now();
    const LoadPlan plan = plan_loading(scene, o.picture, o.machine);
    const double wall_plan = seconds_since(start);
    // Never destroyed: SystemC takes ports down in quadratic time.
    static Machine* const machine = new Machine("machine", scene, o.picture, o.machine, nullptr);
    LoadWatch watch(plan, o.machine);
    RunResult result;
    const Interruptible interruptible(*machine);
    if (!load(*machine, plan, watch, o, result)) return exit_comparison;
    Loading loading{plan, watch, result, o.picture, o.machine, scene, stores_of(*machine), {}};
    loading.checks = check(loading, watch);
    Json json = report(loading);
    json["config"] = table.values();
    json["model"]["wall_seconds"] = {{"plan", wall_plan}, {"load", result.wall_load}};
    if (!o.prefix.empty()) write(loading, json, outputs);
    explain(result, Bound(), "loading_tb");
    complain(loading.checks);
    if (!o.quiet) std::cout << summary(json);
    return count_of(loading.checks) > 0 ? exit_comparison : exit_code(result.verdict);
}

/// The arguments of --preset and --config, followed by those of the command line, which so take precedence. A
/// file that `raycell render` wrote serves too: options that only rays need are ignored.
std::vector<std::string> with_configuration(const std::vector<std::string>& words, const CLI::App& app) {
    std::vector<std::string> all = preset_arguments(words, app);
    const std::string path = configuration_named(words);
    if (!path.empty()) {
        const std::vector<std::string> from_file = arguments_from_render_file(path, app);
        all.insert(all.end(), from_file.begin(), from_file.end());
    }
    all.insert(all.end(), words.begin() + 1, words.end());
    return all;
}

int run(int argc, char** argv) {
    Options options;
    options.run.prefix.clear();
    CLI::App app{"The loading pipeline alone: does it load what it should, and what holds it up?"};
    app.name("loading_tb");
    OptionTable table(app);
    add_preset_option(app);
    app.add_option(
           "--config", options.run.config,
           "options from a file as a run writes it, or raycell render; the command line has precedence")
        ->type_name("FILE");
    add_options(table, options);
    std::vector<std::string> words = with_configuration({argv, argv + argc}, app);
    return parse_and_run(app, std::move(words), [&] { return run(options, table); });
}

}  // namespace

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("loading_tb", "a smaller array or fewer polygons",
                                [&] { return run(argc, argv); });
}
