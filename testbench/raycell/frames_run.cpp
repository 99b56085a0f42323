#include "testbench/raycell/frames_run.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "model/files/input_file.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/frames_report.hpp"
#include "testbench/sweep/runs.hpp"

namespace raycell {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string number_of(std::size_t frame) {
    char digits[24];
    std::snprintf(digits, sizeof digits, "%04zu", frame);
    return digits;
}

/// What follows the prefix in a file's name: ".0001.png".
std::string suffix_of(std::size_t frame, const std::string& suffix) {
    return "." + number_of(frame) + suffix;
}

/// A folder for the frames' files until they are published; removed at the end.
class Scratch {
  public:
    explicit Scratch(const std::string& prefix) : path_(prefix + ".frames.part" + std::to_string(getpid())) {
        fs::create_directory(path_);
    }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    fs::path path_;
};

void refuse_what_one_frame_needs(const RenderOptions& o) {
    const std::pair<const char*, bool> given[] = {
        {"--save-array", !o.save_array.empty()},   {"--load-array", !o.load_array.empty()},
        {"--probe", !o.probes.cells.empty()},      {"--vcd-on-deadlock", o.probes.on_deadlock},
        {"--golden", !o.golden.empty()},           {"--watch-ray", !o.watch_rays.empty()},
        {"--watch-pixel", !o.watch_pixels.empty()}};
    for (const auto& [option, is_given] : given) {
        if (is_given)
            throw UsageError(std::string(option) +
                             ": it is for one frame of --frames; expected --frame K with it");
    }
    if (launched_ranks().count > 1)
        throw RanksRefused("--frames can't be run by several ranks; expected one process, or --frame K");
}

/// Scene and view of each frame. Reads every scene once, so that faults are told before any frame is run.
Json places_of(const RenderOptions& options, const std::vector<FrameLine>& frames, const OutputSet& outputs) {
    const auto list = [](const dvec3& v) { return Json{v.x, v.y, v.z}; };
    std::map<fs::path, View> views;
    Json places = Json::array();
    for (const FrameLine& frame : frames) {
        if (views.count(frame.scene) == 0) {
            FrameLine scene_alone;
            scene_alone.scene = frame.scene;
            Diagnostics told_by_the_frames;
            views[frame.scene] = *read_frame(options, scene_alone, outputs, told_by_the_frames).view;
        }
        const View view = view_of(frame, views[frame.scene], options.frames);
        places.push_back({{"scene", frame.scene.empty() ? options.scene : frame.scene.string()},
                          {"view",
                           {{"from", list(view.from)},
                            {"at", list(view.at)},
                            {"up", list(view.up)},
                            {"angle", view.angle}}}});
    }
    return places;
}

/// Announces the files of all frames, and those that an earlier, longer row has left behind them, which are
/// returned: they are no part of this one.
std::vector<std::string> announce(const RenderOptions& options, std::size_t count,
                                  const std::vector<std::string>& suffixes, OutputSet& outputs) {
    check_place("--output", options.prefix);
    outputs.announce({".json", ".toml"});
    for (std::size_t i = 1; i <= count; ++i) {
        for (const std::string& suffix : suffixes) outputs.announce({suffix_of(i, suffix)});
    }
    std::vector<std::string> outdated;
    for (std::size_t i = count + 1; fs::exists(options.prefix + suffix_of(i, ".json")); ++i) {
        for (const std::string& suffix : suffixes) {
            if (fs::exists(options.prefix + suffix_of(i, suffix))) outdated.push_back(suffix_of(i, suffix));
        }
    }
    return outdated;
}

std::vector<SweepRun> runs_of(const Json& config, std::size_t count, const Scratch& scratch) {
    const std::string configuration = scratch.file("run.toml");
    write_text(configuration, to_toml(config));
    const std::string program = fs::read_symlink("/proc/self/exe").string();
    std::vector<SweepRun> runs;
    for (std::size_t i = 1; i <= count; ++i) {
        SweepRun run;
        run.title = "frame " + std::to_string(i);
        run.prefix = scratch.file(number_of(i));
        run.command = {program,
                       "render",
                       "--config=" + configuration,
                       "--frame=" + std::to_string(i),
                       "--quiet",
                       "--output=" + run.prefix};
        runs.push_back(std::move(run));
    }
    return runs;
}

SweepProgress progress_of(const RenderOptions& options) {
    if (!shows_progress(options)) return [](std::size_t, std::size_t, double) {};
    return [](std::size_t done, std::size_t all, double seconds) {
        std::ostringstream text;
        text << "frames: " << done << " of " << all << ", " << long(seconds) << " s";
        if (done > 0 && done < all)
            text << ", about " << long(seconds / double(done) * double(all - done)) + 1 << " s left";
        std::cerr << "\r\033[K" << text.str() << std::flush;
    };
}

/// Prints what the frames had to say, in their order; of equal lines the first, with the number of the
/// others.
void tell_messages(const std::vector<SweepRun>& runs) {
    std::vector<std::pair<std::string, std::size_t>> first;  // a line and its frame
    std::map<std::string, std::size_t> times;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::ifstream file(messages_of(runs[i]));
        for (std::string line; std::getline(file, line);) {
            if (times[line]++ == 0) first.emplace_back(line, i + 1);
        }
    }
    for (const auto& [line, frame] : first) {
        std::cerr << "frame " << frame;
        if (times[line] > 1) std::cerr << " and " << times[line] - 1 << " more";
        std::cerr << ": " << line << '\n';
    }
}

/// Takes over the files of a frame's run. Its report and configuration were written for another prefix.
Json take_over(const RenderOptions& options, const SweepRun& run, std::size_t frame,
               const std::vector<std::string>& suffixes, OutputSet& outputs) {
    std::ifstream file(run.prefix + ".json");
    Json report = Json::parse(file);
    report["config"]["output"] = options.prefix + "." + number_of(frame);
    report["config"]["quiet"] = options.quiet;
    for (const std::string& suffix : suffixes) {
        const std::string name = suffix_of(frame, suffix);
        if (suffix == ".json") {
            outputs.write(name, to_text(report));
        } else if (suffix == ".toml") {
            outputs.write(name, to_toml(report["config"]));
        } else if (fs::exists(run.prefix + suffix)) {
            outputs.adopt(name, run.prefix + suffix);
        } else {
            outputs.write_if(false, name, {});
        }
    }
    return report;
}

}  // namespace

int run_frames(const RenderOptions& options, const OptionTable& table,
               const std::vector<std::string>& suffixes, int jobs) {
    refuse_what_one_frame_needs(options);
    const std::vector<FrameLine> frames = read_frame_list(options.frames);
    OutputSet outputs(options.prefix);
    const std::vector<std::string> outdated = announce(options, frames.size(), suffixes, outputs);
    spare_inputs(options, outputs);
    const Json places = places_of(options, frames, outputs);
    const NotedSignals noted;
    const Scratch scratch(options.prefix);
    const Json config = table.values();
    const std::vector<SweepRun> runs = runs_of(config, frames.size(), scratch);
    const bool all = make_runs(runs, jobs, true, progress_of(options));
    if (shows_progress(options)) end_progress();
    std::vector<Json> reports;
    if (all) {
        tell_messages(runs);
        for (std::size_t i = 0; i < runs.size(); ++i)
            reports.push_back(take_over(options, runs[i], i + 1, suffixes, outputs));
    }
    if (!all || *noted_signal()) {
        std::cerr << "raycell: interrupted; no files were written\n";
        return exit_interrupted;
    }
    const Verdict worst = worst_of(reports);
    Json json;
    json["verdict"] = name_of(worst);
    json["frames"] = frames_report(reports, options.machine.clock_mhz);
    json["frames"]["each"] = each_frame(reports);
    for (std::size_t i = 0; i < frames.size(); ++i) json["frames"]["each"][i].update(places[i]);
    json["config"] = config;
    outputs.write(".json", to_text(json));
    outputs.write(".toml", to_toml(config));
    for (const std::string& suffix : outdated) outputs.write_if(false, suffix, {});
    outputs.publish();
    if (!options.quiet) {
        std::cout << frames_summary(json["frames"], worst, options.machine.clock_mhz)
                  << "pictures: " << options.prefix << suffix_of(1, ".png");
        if (frames.size() > 1) std::cout << " to " << options.prefix << suffix_of(frames.size(), ".png");
        std::cout << '\n';
    }
    return exit_code(worst);
}

}  // namespace raycell
