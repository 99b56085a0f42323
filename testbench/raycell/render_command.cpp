// raycell render: the scene through the simulated machine, and its results as files.
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <thread>

#include "cells/clock/wall_time.hpp"
#include "cells/meters/observer_list.hpp"
#include "model/machine/losses.hpp"
#include "model/machine/untimed.hpp"
#include "model/truth/clip.hpp"
#include "model/truth/exterior.hpp"
#include "model/truth/sample.hpp"
#include "model/truth/truth.hpp"
#include "testbench/common/array_files.hpp"
#include "testbench/common/cells_csv.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/deadlock_dump.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/interruptible.hpp"
#include "testbench/common/knot_report.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/picture_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/probe_run.hpp"
#include "testbench/common/ray_watch.hpp"
#include "testbench/common/recording.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/common/time_estimate.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/frames_run.hpp"
#include "testbench/raycell/golden_run.hpp"
#include "testbench/raycell/rank_run.hpp"
#include "testbench/raycell/render_hooks.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::uint64_t memory_bytes() {
    std::uint64_t pages = 0;
    std::uint64_t resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

struct Run {
    RunResult result;
    double wall_build = 0;
    std::uint64_t bytes_per_cell = 0;
    Forecast forecast;
    ExpectedSeconds expected;
    std::string cells_csv;
    std::unique_ptr<ProbeRun> probes;              ///< null: none
    std::unique_ptr<Recording> recording;          ///< of a timed run
    std::unique_ptr<GoldenRun> golden;             ///< null: none
    DeadlockedCells deadlocked;                    ///< with --vcd-on-deadlock
    Json ranks;                                    ///< empty: one process
    std::unique_ptr<Interruptible> interruptible;  ///< of a timed run, until its results are published
};

/// Estimates the run's duration and prints it if it is long.
void foretell(const RenderOptions& options, const CellScene& scene, const TruthRenderer* truth, Run& run) {
    run.forecast = forecast(scene, options.picture, truth);
    const auto cells = std::size_t(options.picture.width) * std::size_t(options.picture.height);
    run.expected =
        expected_seconds(run.forecast, cells, options.hosts == Hosts::cell, launched_ranks().count);
    if (!options.load_array.empty()) run.expected.load = 0;
    if (run.expected.sum() > long_run && !options.quiet)
        std::cerr << expectation(run.forecast, run.expected) << '\n';
}

Run run_timed(const RenderOptions& options, const std::string& configuration, const CellScene& scene,
              const TruthRenderer* truth, const ExteriorTracer* tracer, RankRun* ranks,
              const CellFactory& own_cells, OutputSet& outputs) {
    Run run;
    ArrayFiles arrays(options, scene);
    if (!ranks || ranks->first()) foretell(options, scene, truth, run);
    const auto start = WallClock::now();
    const std::uint64_t before = memory_bytes();
    // Never destroyed: SystemC takes ports down in quadratic time (minutes for 256x256 cells), and a process
    // has only one elaboration anyway.
    Granularity granularity = granularity_of(options);
    granularity.own_cells = own_cells;
    static Machine* const kept =
        new Machine("machine", scene, options.picture, options.machine, tracer, nullptr, granularity,
                    ranks ? &ranks->exchange(scene, options) : nullptr);
    Machine& machine = *kept;
    const std::uint64_t cells = std::uint64_t(options.picture.width) * std::uint64_t(options.picture.height);
    const std::uint64_t after = memory_bytes();
    run.bytes_per_cell = after > before ? (after - before) / cells : 0;
    run.wall_build = seconds_since(start);
    arrays.attach(machine, outputs);
    CellObserverList observers;
    const std::unique_ptr<RayWatch> watch = watch_of(options, std::cout);
    if (watch) observers.add(*watch);
    if (!options.golden.empty()) {
        run.golden = std::make_unique<GoldenRun>(options, configuration, machine, outputs);
        observers.add(run.golden->observer());
    }
    run.recording = std::make_unique<Recording>(options, machine, observers);
    if (!observers.empty()) machine.environment().meters.observer = &observers;
    if (!options.probes.cells.empty()) run.probes = std::make_unique<ProbeRun>(options, machine, outputs);
    const bool progress = shows_progress(options) && !watch && (!ranks || ranks->first());
    run.interruptible = std::make_unique<Interruptible>(machine);
    run.result = machine.run(progress ? show_progress : std::function<void(const RunProgress&)>());
    if (progress) end_progress();
    if (watch) watch->finish(machine.environment().scheduler.now());
    machine.environment().meters.observer = nullptr;
    if (run.probes) run.probes->finish();
    run.recording->finish();
    if (run.golden) run.golden->finish();
    if (options.probes.on_deadlock && run.result.verdict == Verdict::deadlock) {
        run.deadlocked = deadlocked_cells(run.result, machine);
    }
    std::vector<std::string> rows = cells_csv_rows(machine, run.result);
    if (ranks) rows = ranks->gather_rows(rows);
    run.cells_csv = cells_csv_header();
    for (const std::string& row : rows) run.cells_csv += row;
    if (ranks) run.ranks = ranks->report(machine, peak_memory_bytes());
    const bool traced = options.picture.stage == RunStage::trace;
    if (traced && run.result.verdict == Verdict::completed)
        run.result.trace_binding.consider(machine.longest_tree());
    return run;
}

Run run_untimed(const RenderOptions& options, const CellScene& scene, const ExteriorTracer* tracer) {
    Run run;
    const auto start = WallClock::now();
    const std::uint64_t before = memory_bytes();
    UntimedMachine machine(scene, options.picture, tracer);
    RunResult& result = run.result;
    result.wall_load = seconds_since(start);
    const bool progress = shows_progress(options);
    const auto traced = WallClock::now();
    result.picture = machine.render([&](int row) {
        if (progress)
            std::cerr << "\rrow " << row + 1 << " of " << scene.frame.picture_height() << std::flush;
    });
    if (progress) end_progress();
    result.wall_trace = seconds_since(traced);
    const std::uint64_t after = memory_bytes();
    run.bytes_per_cell = after > before ? (after - before) / machine.cells().size() : 0;
    result.counters.rays = machine.rays();
    result.precast_hops = machine.precast_hops();
    result.geometry.items = machine.loaded().polygons;
    result.precomputation.items = machine.loaded().trapezes;
    result.distribution.items = machine.loaded().spans;
    result.storage = machine.storage();
    run.cells_csv = cells_csv(machine);
    if (result.storage.overflowed > 0) result.verdict = Verdict::capacity;
    return run;
}

Json expected_report(const Run& run) {
    const Forecast& f = run.forecast;
    const ExpectedSeconds& s = run.expected;
    return {{"hops", {{"load", f.load_hops}, {"precast", f.precast_hops}, {"trace", f.trace_hops}}},
            {"load_steps", f.load_steps},
            {"voxels", f.voxels},
            {"seconds", {{"load", s.load}, {"precast", s.precast}, {"trace", s.trace}}}};
}

Json model_report(const Run& run) {
    const RunResult& r = run.result;
    const double seconds = r.wall_load + r.wall_precast + r.wall_trace;
    const double hops = double(r.counters.load_hops + r.counters.rays.ray_hops + r.counters.rays.return_hops);
    return {{"wall_seconds",
             {{"build", run.wall_build},
              {"load", r.wall_load},
              {"precast", r.wall_precast},
              {"trace", r.wall_trace}}},
            {"processor_seconds",
             {{"load", r.processor_load}, {"precast", r.processor_precast}, {"trace", r.processor_trace}}},
            {"expected", expected_report(run)},
            {"hops_per_second", seconds > 0 ? hops / seconds : 0.0},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"bytes_per_cell", run.bytes_per_cell}};
}

const std::vector<std::string> truth_suffixes = {".truth.exr", ".truth.png", ".difference.png"};

/// Renders the scene's truth beside the picture and reports how far apart they are, and of that, how far the
/// machine is from the truth of its polygons and these are from the scene. Throws Interrupted.
Json render_truth(const RenderOptions& options, const CellScene& scene, const Picture& picture,
                  OutputSet& outputs) {
    const CellScene clipped = options.clip_truth ? clip_scene(scene) : scene;
    TruthSettings tree = truth_settings(options.picture, options.truth_samples);
    const bool progress = shows_progress(options);
    const TruthRenderer::Progress tell = [&](int done, int all) {
        stop_if_interrupted();
        if (progress) std::cerr << "\rtruth: row " << done << " of " << all << std::flush;
    };
    const TruthRenderer truth(clipped, tree);
    const Picture itself = truth.render(0, tell);
    const bool exterior = options.picture.exterior == ExteriorMode::host && !options.clip_truth;
    tree.of = TruthOf::polygons;
    tree.beyond = exterior ? &truth : nullptr;
    const Picture polygons = clipped.curved.empty() ? itself : TruthRenderer(clipped, tree).render(0, tell);
    if (progress) end_progress();
    Json accuracy = report(picture, polygons);
    // Which polygon is hit first is no question against the scene.
    for (const auto& [name, from] : {std::pair("scene", &picture), std::pair("tessellation", &polygons)}) {
        Json part = report(*from, itself);
        part.erase("wrong_hit_percent");
        accuracy[name] = std::move(part);
    }
    outputs.write(truth_suffixes[0], [&](NewFile& file) { write_exr(itself, file); });
    outputs.write(truth_suffixes[1], [&](NewFile& file) { write_png(itself, file); });
    outputs.write(truth_suffixes[2], [&](NewFile& file) { write_png(difference(picture, itself), file); });
    return accuracy;
}

/// Compares a sample of the picture's pixels with the truth of the polygons; only this shows that words are
/// too short for a scene. `truth` is the exterior's. Warns if much is lost and only words can be the reason.
void add_sample(const RenderOptions& options, const RunResult& result, const CellScene& scene,
                const TruthRenderer* truth, Json& losses) {
    losses["sample"] = {{"pixels", 0}, {"psnr_db", nullptr}};
    const bool finished = result.verdict == Verdict::completed || result.verdict == Verdict::capacity;
    if (!truth || !finished || options.picture.stage == RunStage::load) return;
    constexpr int pixels = 512;
    const bool exterior = options.picture.exterior == ExteriorMode::host;
    TruthSettings tree{options.picture.max_depth, options.picture.min_weight, false,
                       TruthOf::polygons,         exterior ? truth : nullptr, options.truth_samples};
    // The machine's own places: only words may make a difference, and other points of an area.
    tree.samples = options.picture.samples;
    tree.filter = options.picture.filter;
    const TruthRenderer polygons(scene, tree);
    const SampledAccuracy sample = sample_accuracy(result.picture, scene.frame, polygons, pixels);
    losses["sample"] = {{"pixels", sample.pixels}, {"psnr_db", sample.psnr_db}};
    constexpr double good = 45;  // dB; the default machine gives 60 to 90 on scenes that fit its words
    const PictureSettings& p = options.picture;
    const bool areas = std::any_of(scene.sources.begin(), scene.sources.end(),
                                   [](const Source& source) { return is_area(source.kind); });
    const bool words_alone = !areas && p.numbers.arithmetic == Numbers::fixed && p.hit == HitTest::edge &&
                             p.normals == Normals::linear && p.shadows == Shadows::per_hit &&
                             p.exterior == ExteriorMode::host && result.verdict == Verdict::completed;
    if (words_alone && sample.psnr_db < good && !options.quiet) {
        std::cerr << options.scene << ": warning: words of " << p.numbers.word_bits
                  << " bits: " << sample.pixels << " sampled pixels are "
                  << std::round(10 * sample.psnr_db) / 10
                  << " dB from the truth; expected longer words (--word-bits), see losses in the report\n";
    }
}

/// The suffixes of all files that the run may write.
std::vector<std::string> suffixes_of(const RenderOptions& options) {
    std::vector<std::string> all = {".exr",        ".png",      ".cells.csv", ".ledger.csv",
                                    ".waits.json", ".knot.svg", ".toml",      ".json"};
    const auto add = [&](const std::vector<std::string>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    if (options.truth) add(truth_suffixes);
    if (!options.probes.cells.empty() || options.probes.on_deadlock) add({".vcd", ".gtkw"});
    add(recording_suffixes(options));
    add(golden_suffixes(options));
    return all;
}

/// Announces all files of the run. Throws UsageError for what is refused.
void announce(const RenderOptions& options, OutputSet& outputs) {
    check_place("--output", options.prefix);
    outputs.announce(suffixes_of(options));
    if (options.save_array.empty()) return;
    check_place("--save-array", options.save_array);
    for (const std::string& path : outputs.announced()) {
        if (same_file(path, options.save_array))
            throw UsageError("--save-array " + options.save_array +
                             ": --output has a file of this name; expected another");
    }
    outputs.announce_file(options.save_array);
}

/// Writes and publishes all files of an ended run together. False if a signal cut short the work after the
/// run.
bool write_results(const RenderOptions& options, const CellScene& scene, const Run& run, const Json& config,
                   Json& json, OutputSet& outputs) {
    const RunResult& result = run.result;
    bool whole = true;
    const auto unless_interrupted = [&](const char* what, const std::vector<std::string>& suffixes,
                                        const std::function<void()>& work) {
        try {
            work();
        } catch (const Interrupted&) {
            std::cerr << "raycell: interrupted: " << what << '\n';
            for (const std::string& suffix : suffixes) outputs.write_if(false, suffix, {});
            whole = false;
        }
    };
    if (options.truth) {
        unless_interrupted("no truth", truth_suffixes,
                           [&] { json["accuracy"] = render_truth(options, scene, result.picture, outputs); });
    }
    json["config"] = config;
    json["model"] = model_report(run);
    if (!run.ranks.empty()) json["ranks"] = run.ranks;
    outputs.write(".exr", [&](NewFile& file) { write_exr(result.picture, file); });
    outputs.write(".png", [&](NewFile& file) { write_png(result.picture, file); });
    outputs.write(".cells.csv", run.cells_csv);
    outputs.write_if(result.ledger.destroyed() > 0, ".ledger.csv", [&] { return ledger_csv(result.ledger); });
    outputs.write_if(!result.waits.nodes().empty(), ".waits.json",
                     [&] { return to_text(waits_json(result)); });
    outputs.write_if(result.waits.deadlocked(), ".knot.svg",
                     [&] { return knot_svg(result, options.picture.width, options.picture.height); });
    outputs.write(".toml", to_toml(config));
    outputs.write(".json", to_text(json));
    if (run.probes) run.probes->write(outputs);
    if (run.recording) run.recording->write(outputs);
    if (!run.deadlocked.cells.empty()) {
        unless_interrupted("no waveforms", {".vcd", ".gtkw"}, [&] {
            dump_deadlock({"raycell", "render"}, options, config, run.deadlocked, result.schedule_hash,
                          outputs);
        });
    }
    outputs.publish();
    return whole;
}

void summarise(const RenderOptions& options, const Json& json, bool whole) {
    const auto& cycles = json["cycles"];
    std::cout << "verdict " << json["verdict"].get<std::string>() << "; cycles: load " << cycles["load"]
              << ", precast " << cycles["precast"] << ", trace " << cycles["trace"] << "; "
              << json["voxels"]["stored"] << " voxels\n";
    if (json.contains("accuracy")) {
        const Json& accuracy = json["accuracy"];
        const auto psnr = [](const Json& part) { return part["psnr_db"].get<double>(); };
        std::cout << "accuracy " << psnr(accuracy["scene"]) << " dB; polygons against the scene "
                  << psnr(accuracy["tessellation"]) << " dB, machine against the polygons " << psnr(accuracy)
                  << " dB, other first hit in " << accuracy["wrong_hit_percent"].get<double>()
                  << " % of the pixels\n";
    }
    std::cout << "picture: " << options.prefix << ".png\n";
    const bool dumped = options.probes.on_deadlock && json["verdict"] == "deadlock" && whole;
    if (dumped || !options.probes.cells.empty()) {
        tell_waveforms(options.prefix);
    }
    tell_page(options.prefix);
}

int run(const RenderOptions& options, const OptionTable& table, int jobs, const RenderHooks& hooks) {
    check_granularity(options);
    check_wires(options);
    watch_of(options, std::cout);  // throws early for what can't be watched
    check_probes(options);
    check_recording(options);
    check_golden(options);
    check_samples(options.picture);
    if (hooks.check) hooks.check(options);
    if (!options.frames.empty() && options.frame == 0)
        return run_frames(options, table, suffixes_of(options), jobs);
    check_ranks(options);
    check_arrays(options);
    const auto start = WallClock::now();
    OutputSet outputs(options.prefix);
    const auto read = [&] {
        announce(options, outputs);
        check_memory(options);
        CellScene scene = read_and_place(options, outputs);
        const Context context(scene, options.picture);
        for (const std::string& warning : loss_warnings(losses_of(context), context)) {
            std::cerr << options.scene << ": warning: " << warning << '\n';
        }
        if (options.engine == Engine::timed) warn_of(bound_of(context, options.machine));
        return scene;
    };
    const std::unique_ptr<RankRun> ranks = launched_ranks().count > 1 ? std::make_unique<RankRun>() : nullptr;
    const CellScene scene = ranks ? ranks->share_scene(read) : read();
    if (hooks.placed && !hooks.placed(options, scene)) return exit_done;
    const bool traces = options.picture.stage == RunStage::trace && (!ranks || ranks->first());
    const bool exterior = options.picture.exterior == ExteriorMode::host && traces;
    std::unique_ptr<TruthRenderer> whole;
    std::unique_ptr<ClassicalExterior> tracer;
    if (exterior || (traces && options.engine == Engine::timed)) {  // the forecast needs it, too
        whole = std::make_unique<TruthRenderer>(
            scene, TruthSettings{options.picture.max_depth, options.picture.min_weight, false, TruthOf::scene,
                                 nullptr, options.picture.source_samples});
    }
    if (exterior) tracer = std::make_unique<ClassicalExterior>(scene, *whole);
    const double wall_placing = seconds_since(start);
    const Json config = table.values();
    Run done = options.engine == Engine::timed
                   ? run_timed(options, to_toml(config), scene, whole.get(), tracer.get(), ranks.get(),
                               hooks.own_cells, outputs)
                   : run_untimed(options, scene, tracer.get());
    done.wall_build += wall_placing;
    if (ranks && !ranks->first()) {
        ranks->finish();
        return exit_done;
    }

    if (ranks) ranks->others_are_done();
    const RunResult& result = done.result;
    Json json = report(result, scene, options.picture, options.machine);
    add_sample(options, result, scene, whole.get(), json["losses"]);
    const bool uncut = write_results(options, scene, done, config, json, outputs);
    explain(result, bound_of(Context(scene, options.picture), options.machine));
    if (!options.quiet) summarise(options, json, uncut);
    if (ranks) ranks->finish();
    const int code = uncut ? exit_code(result.verdict) : int(exit_interrupted);
    return hooks.ended ? hooks.ended(code) : code;
}

}  // namespace

Command add_render_command(CLI::App& program) { return add_render_command(program, RenderHooks()); }

Command add_render_command(CLI::App& program, RenderHooks hooks) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* app = program.add_subcommand("render", "Renders a scene with the simulated machine");
    auto table = std::make_shared<OptionTable>(*app);
    add_preset_option(*app);
    app->add_option("--config", options->config,
                    "options from a file as a run writes it; the command line has precedence")
        ->type_name("FILE");
    add_render_options(*table, *options);
    add_rank_options(*app, *options);
    auto jobs = std::make_shared<int>(int(std::max(1U, std::thread::hardware_concurrency())));
    app->add_option("-j,--jobs", *jobs, "frames of --frames at a time")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    if (hooks.add_options) hooks.add_options(*app);
    return {app,
            [options, table, jobs, hooks = std::move(hooks)] { return run(*options, *table, *jobs, hooks); }};
}

}  // namespace raycell
