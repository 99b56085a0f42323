// cell_tb: one cell with drivers on its sides. Runs scripted scenarios, or golden vectors of a real run.
#include <algorithm>
#include <iostream>
#include <systemc>

#include "cells/probes/probe.hpp"
#include "testbench/cell/loading_export.hpp"
#include "testbench/cell/record.hpp"
#include "testbench/cell/scenarios.hpp"
#include "testbench/cell/traversal_export.hpp"
#include "testbench/cell/vectors.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/golden/cell_bench.hpp"
#include "testbench/golden/traversal.hpp"
#include "testbench/raycell/commands.hpp"

namespace {

using namespace raycell;

constexpr int exit_differs = 2;
constexpr const char* vcd_suffix = ".vcd";

struct Options {
    std::vector<std::string> names;
    std::vector<std::string> replay;
    std::string vcd;
    std::string write;
    std::string folder;
    bool shading = false;
    bool list = false;
    bool quiet = false;
};

std::vector<Scenario> chosen_scenarios(const Options& options) {
    std::vector<Scenario> all = all_scenarios();
    if (options.names.empty()) return all;
    std::vector<Scenario> scenarios;
    for (const std::string& name : options.names) {
        const auto found =
            std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
        if (found == all.end()) throw UsageError("no scenario '" + printable(name) + "'; see --list");
        scenarios.push_back(*found);
    }
    return scenarios;
}

/// Waveforms of a bench's cell, from its first cycle to its last.
class Waveform {
  public:
    Waveform(const std::string& path, CellBench& bench, OutputSet& outputs)
        : outputs_(outputs),
          file_(outputs.begin(vcd_suffix)),
          probe_({&bench.cell()}, bench.environment(), file_.stream(), {},
                 [path](const std::string& text) { std::cerr << path << ": warning: " << text << '\n'; }),
          scheduler_(bench.environment().scheduler) {
        scheduler_.set_sampler([this](Cycle now) { probe_.sample(now); });
    }
    void finish() {
        scheduler_.sample();
        scheduler_.set_sampler({});
        probe_.finish(scheduler_.now());
        const std::string& path = file_.path();
        const std::string prefix = path.substr(0, path.rfind('.'));
        outputs_.write(".gtkw", probe_.save_file(prefix.substr(prefix.rfind('/') + 1)));  // npos + 1 is 0
        outputs_.publish();
    }

  private:
    OutputSet& outputs_;
    NewFile& file_;
    Probe probe_;
    Scheduler& scheduler_;
};

/// What is to be run: scenarios and records of cells, or records of traversal units.
struct Chosen {
    std::vector<Scenario> scenarios;
    std::vector<Record> traversals;
};

Chosen recorded(const Options& options) {
    Chosen chosen;
    for (const std::string& path : options.replay) {
        Record record = record_of_file(path);
        if (record.file.traversal) {
            chosen.traversals.push_back(std::move(record));
        } else {
            chosen.scenarios.push_back(
                {path, "", std::move(record.setup), std::move(record.file.events), record.file.last});
        }
    }
    return chosen;
}

void check(const Options& options, std::size_t scenarios, std::size_t traversals) {
    if (!options.replay.empty() && (!options.names.empty() || options.list || !options.write.empty()))
        throw UsageError("--replay: expected no scenario, --list or --write beside it");
    if (!options.folder.empty() &&
        (options.replay.empty() || (scenarios > 0 && traversals > 0) || !options.vcd.empty()))
        throw UsageError(
            "--hardware: expected records of traversal units alone, or of cells alone, to --replay, and no "
            "--vcd");
    if (options.shading && options.folder.empty())
        throw UsageError("--shading: expected --hardware beside it");
    if ((scenarios != 1 || traversals > 0) && !options.vcd.empty())
        throw UsageError("--vcd: it shows one cell; expected one scenario or one file to replay");
    if (scenarios != 1 && !options.write.empty() && !is_folder(options.write))
        throw UsageError(
            "--write: several scenarios go into a folder; expected one, or a name that ends in /");
    const std::string& vcd = options.vcd;
    if (!vcd.empty() && (vcd.size() < 5 || vcd.substr(vcd.size() - 4) != vcd_suffix))
        throw UsageError("--vcd: '" + printable(vcd) + "': expected a name that ends in .vcd");
}

/// Announces the files to be written. Throws UsageError if one would overwrite a file to be replayed.
void announce(const Options& options, const std::vector<Scenario>& scenarios, OutputSet& outputs) {
    if (!options.write.empty()) {
        outputs.announce(vector_suffixes(scenarios, options.write));
    } else if (!options.vcd.empty()) {
        outputs.announce({vcd_suffix, ".gtkw"});
    }
    for (const std::string& path : outputs.announced()) {
        for (const std::string& input : options.replay) {
            if (same_file(path, input))
                throw UsageError(path +
                                 ": it would be overwritten, but is to be replayed; expected another name");
        }
    }
}

/// Says how one scenario or file went.
void say(const Options& options, const std::string& name, const std::vector<std::string>& failures,
         const std::string& more) {
    if (!options.quiet) std::cout << (failures.empty() ? "passed  " : "FAILED  ") << name << more << '\n';
    for (const std::string& failure : failures) std::cerr << name << ": " << failure << '\n';
}

/// Returns how many failed.
std::size_t run_traversals(const Options& options, const std::vector<Record>& records) {
    std::size_t failed = 0;
    for (const Record& record : records) {
        const TraversalReplay replay = replay_traversal(record.file, record.setup);
        failed += !replay.failures.empty();
        say(options, record.file.name, replay.failures, "; " + std::to_string(replay.tests) + " tests");
    }
    return failed;
}

/// Returns how many failed.
std::size_t run_cells(const Options& options, const std::vector<Scenario>& scenarios, OutputSet& outputs) {
    std::vector<std::unique_ptr<CellBench>> benches;  // all before the first run: SystemC elaborates once
    for (const Scenario& scenario : scenarios) {
        const std::string name = "bench_" + std::to_string(benches.size());
        benches.push_back(
            std::make_unique<CellBench>(name.c_str(), scenario.setup, scenario.events, scenario.last));
    }
    std::unique_ptr<Waveform> waveform;
    if (!options.vcd.empty()) waveform = std::make_unique<Waveform>(options.vcd, *benches.front(), outputs);
    std::size_t failed = 0;
    for (std::size_t i = 0; i < benches.size(); ++i) {
        const std::vector<std::string> failures = benches[i]->run();
        failed += !failures.empty();
        const std::string& says = scenarios[i].says;
        say(options, scenarios[i].name, failures,
            (says.empty() ? "" : ": " + says) + "; " + std::to_string(benches[i]->matched()) +
                " events to cycle " + std::to_string(benches[i]->environment().scheduler.now()));
    }
    if (waveform) waveform->finish();
    return failed;
}

/// The files of traversal units or, from records of cells, of loading.
std::string export_hardware(const Chosen& chosen, const std::string& folder, bool shading) {
    if (chosen.scenarios.empty()) {
        std::vector<TraversalRecord> records;
        for (const Record& record : chosen.traversals) records.push_back({&record.file, &record.setup});
        return export_traversal(records, folder, shading);
    }
    std::vector<LoadRecord> records;
    for (const Scenario& cell : chosen.scenarios) records.push_back({cell.name, &cell.setup, &cell.events});
    return export_loading(records, folder);
}

int run(const Options& options) {
    const Chosen chosen = options.replay.empty() ? Chosen{chosen_scenarios(options), {}} : recorded(options);
    const std::vector<Scenario>& scenarios = chosen.scenarios;
    check(options, scenarios.size(), chosen.traversals.size());
    if (!options.folder.empty()) {
        try {
            std::cout << export_hardware(chosen, options.folder, options.shading);
        } catch (const std::invalid_argument& error) {
            throw UsageError(options.replay.front() + ": " + error.what());
        }
        return exit_done;
    }
    if (options.list) {
        for (const Scenario& scenario : scenarios)
            std::cout << scenario.name << ": " << scenario.says << '\n';
        return exit_done;
    }
    const std::string& vcd = options.vcd;
    OutputSet outputs(options.write.empty() ? vcd.substr(0, vcd.rfind('.')) : vector_prefix(options.write));
    announce(options, scenarios, outputs);
    if (!options.write.empty()) {
        write_vectors(scenarios, options.write, outputs);
        outputs.publish();
        return exit_done;
    }
    const std::size_t failed =
        run_cells(options, scenarios, outputs) + run_traversals(options, chosen.traversals);
    const std::size_t all = scenarios.size() + chosen.traversals.size();
    if (!options.quiet) std::cout << all - failed << " of " << all << " passed\n";
    return failed ? exit_differs : exit_done;
}

int run(int argc, char** argv) {
    CLI::App app{
        "One cell with drivers on its four sides: scripted scenarios, and golden vectors of real runs"};
    app.name("cell_tb");
    Options options;
    app.add_option("scenario", options.names, "scenarios to run; default: all of them");
    app.add_flag("--list", options.list, "print the scenarios' names and what they show");
    app.add_option("--replay", options.replay,
                   "golden vectors of 'raycell render --golden', to be driven and checked")
        ->type_name("FILE");
    app.add_option("--vcd", options.vcd,
                   "waveforms of the cell, of one scenario or file; FILE.gtkw beside it")
        ->type_name("FILE.vcd");
    app.add_option(
           "--write", options.write,
           "write a scenario as golden vectors instead of running it; several, or all, into a folder: a name "
           "that ends in /")
        ->type_name("FILE|FOLDER/");
    app.add_option("--hardware", options.folder,
                   "write the records of one run's traversal units for traversal.sv: microprograms, voxels, "
                   "rays; those of "
                   "its cells for loading.sv: microprograms, load messages")
        ->type_name("FOLDER");
    app.add_flag("--shading", options.shading,
                 "with --hardware: also the shading unit's programs, and jobs for the hits among the rays");
    app.add_flag("--quiet", options.quiet, "print nothing but failures");
    return parse_and_run(app, {argv + 1, argv + argc}, [&] { return run(options); });
}

}  // namespace

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("cell_tb", "fewer files at once", [&] { return run(argc, argv); });
}
