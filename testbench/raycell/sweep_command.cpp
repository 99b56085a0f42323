// raycell sweep: runs machines that differ in the options that are swept, and tells them apart.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include "testbench/common/configuration.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/common/traffic_options.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/sweep/results.hpp"
#include "testbench/sweep/runs.hpp"

namespace raycell {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
    std::string config;
    std::string prefix = "sweep";
    bool synthetic = false;
    int seeds = 0;  ///< 0: as --seed says
    int jobs = int(std::max(1U, std::thread::hardware_concurrency()));
    bool dry_run = false;
    bool keep = false;
    bool quiet = false;
};

/// The program whose options are swept.
struct SweptProgram {
    explicit SweptProgram(bool synthetic) : app(""), table(app) {
        app.name(synthetic ? "deadlock_tb" : "raycell render");
        if (synthetic) {
            add_traffic_options(table, traffic);
            add_preset_option(app);
            path = program_beside("deadlock_tb");
        } else {
            add_render_options(table, render);
            add_preset_option(app);
            path = program_beside("raycell");
        }
    }
    CLI::App app;
    OptionTable table;
    TrafficOptions traffic;
    RenderOptions render;
    std::string path;
};

std::vector<SweepRun> runs_of(const SweepDesign& design, const SweepOptions& options,
                              const std::string& program, const std::string& folder) {
    const std::string identity = digest_of(program);
    std::vector<SweepRun> runs;
    for (const SweepPoint& point : design.points()) {
        SweepRun run;
        run.prefix = (fs::path(folder) / design.name(point, identity)).string();
        run.command = {program};
        if (!options.synthetic) run.command.emplace_back("render");
        for (const std::string& word : design.words(point)) run.command.push_back(word);
        run.command.insert(run.command.end(), {"--quiet", "--output=" + run.prefix});
        runs.push_back(std::move(run));
    }
    return runs;
}

void list(const std::vector<SweepRun>& runs) {
    std::size_t done = 0;
    for (const SweepRun& run : runs) {
        done += run.done();
        std::cout << (run.done() ? "done    " : "to do   ");
        for (const std::string& word : run.command) std::cout << ' ' << word;
        std::cout << '\n';
    }
    std::cout << runs.size() << " runs, " << done << " done\n";
}

SweepProgress progress_of(const SweepOptions& options, std::size_t already) {
    if (options.quiet || !isatty(STDERR_FILENO)) return [](std::size_t, std::size_t, double) {};
    return [already](std::size_t done, std::size_t all, double seconds) {
        std::ostringstream text;
        text << "sweep: " << done << " of " << all << " runs, " << long(seconds) << " s";
        if (done > already && done < all)
            text << ", about " << long(seconds / double(done - already) * double(all - done)) + 1
                 << " s left";
        std::cerr << "\r\033[K" << text.str() << std::flush;
    };
}

std::vector<SweepRow> rows_of(const SweepDesign& design, const std::vector<SweepRun>& runs) {
    const std::vector<SweepPoint> points = design.points();
    std::vector<SweepRow> rows;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::ifstream file(runs[i].prefix + ".json");
        try {
            rows.push_back(row_of(points[i], nlohmann::ordered_json::parse(file)));
        } catch (const std::exception& error) {
            throw std::runtime_error(runs[i].prefix + ".json: " + error.what());
        }
    }
    return rows;
}

std::string configuration_of(const SweepDesign& design, bool synthetic) {
    nlohmann::ordered_json values;
    if (synthetic) values["synthetic"] = true;
    for (const SweepAxis& axis : design.axes) {
        if (axis.values.size() == 1) {
            values[axis.option] = axis.values.front();
        } else {
            values[axis.option] = axis.values;
        }
    }
    for (const std::string& word : design.fixed) {
        const auto equals = word.find('=');
        values[word.substr(2, equals - 2)].push_back(word.substr(equals + 1));
    }
    return to_toml(values);
}

int run(SweepOptions options, std::vector<std::string> words) {
    if (!options.config.empty()) {
        std::vector<std::string> from_file = sweep_words_from_file(options.config);
        const auto synthetic = std::find(from_file.begin(), from_file.end(), "--synthetic=true");
        if (synthetic != from_file.end()) {
            options.synthetic = true;
            from_file.erase(synthetic);
        }
        words.insert(words.begin(), from_file.begin(), from_file.end());
    }
    if (options.seeds > 0) words.push_back("--seed=1.." + std::to_string(options.seeds));
    SweptProgram program(options.synthetic);
    const SweepDesign design = read_sweep(words, program.app);
    const auto has = [&](const std::string& option) {
        return std::any_of(design.axes.begin(), design.axes.end(),
                           [&](const SweepAxis& axis) { return axis.option == option; });
    };
    if (!options.synthetic && !has("scene") && !has("frames"))
        throw UsageError("sweep: no scene given; expected one or several, or --synthetic");
    if (has("frames") && !has("frame"))
        throw UsageError("sweep: --frames: a run is of one frame; expected --frame K, or --frame 1..N");
    const std::string folder = options.prefix + ".runs";
    const std::vector<SweepRun> runs = runs_of(design, options, program.path, folder);
    if (options.dry_run) {
        list(runs);
        return exit_done;
    }
    check_place("--output", options.prefix);
    OutputSet outputs(options.prefix);
    outputs.announce({".csv", ".md", ".svg", ".toml"});
    fs::create_directories(folder);
    const auto already = std::size_t(
        std::count_if(runs.begin(), runs.end(), [](const SweepRun& each) { return each.done(); }));
    const bool all = make_runs(runs, options.jobs, options.keep, progress_of(options, already));
    if (!options.quiet && isatty(STDERR_FILENO)) end_progress();
    if (!all) {
        std::cerr << "raycell: interrupted: the same command goes on where it was\n";
        return exit_interrupted;
    }
    const std::vector<SweepRow> rows = rows_of(design, runs);
    const std::string table = sweep_table(design, rows);
    const std::string chart = sweep_chart(design, rows);
    outputs.write(".csv", sweep_csv(design, rows));
    outputs.write(".md", table);
    outputs.write_if(!chart.empty(), ".svg", [&] { return chart; });
    outputs.write(".toml", configuration_of(design, options.synthetic));
    outputs.publish();
    if (options.quiet) return exit_done;
    std::cout << table << '\n'
              << options.prefix << ".csv, .md" << (chart.empty() ? "" : ", .svg") << "; runs in " << folder
              << "/\n";
    return exit_done;
}

}  // namespace

Command add_sweep_command(CLI::App& program) {
    auto options = std::make_shared<SweepOptions>();
    CLI::App* app = program.add_subcommand("sweep",
                                           "Runs every combination of options' values: which machines end, "
                                           "in how many cycles, for how many bits");
    app->allow_extras();
    app->footer(
        "raycell sweep SCENE ... [--OPTION VALUES ...] -o PREFIX\n"
        "raycell sweep --synthetic [--OPTION VALUES ...] -o PREFIX\n\n"
        "OPTION: any of 'raycell render' or, with --synthetic, of deadlock_tb. VALUES: one value, a list "
        "(1,2,4) or a "
        "range (1..8, 8..64:8).\nM, the slots of a cell's ray store, is --ray-store; --buffer is the depth "
        "of the links' "
        "buffers.");
    app->add_option("--config", options->config,
                    "a sweep from a file, as a sweep writes it; the command line adds to it")
        ->type_name("FILE");
    app->add_option("-o,--output", options->prefix,
                    "where results go: PREFIX.csv, .md, .svg, .toml, PREFIX.runs/")
        ->type_name("PREFIX")
        ->capture_default_str();
    app->add_flag("--synthetic", options->synthetic, "ray traffic without a scene, as deadlock_tb makes it");
    app->add_option("--seeds", options->seeds, "the same as --seed 1..N")->check(CLI::Range(1, 100000));
    app->add_option("-j,--jobs", options->jobs, "runs at a time")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    app->add_flag("--dry-run", options->dry_run, "lists the runs and makes none");
    app->add_flag("--keep-files", options->keep, "keeps all files of the runs, not .json and .toml alone");
    app->add_flag("--quiet", options->quiet, "no progress, no table");
    return {app, [options, app] { return run(*options, app->remaining()); }};
}

}  // namespace raycell
