#include "testbench/raycell/size_frames.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "testbench/common/configuration.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/size_frame_report.hpp"
#include "testbench/raycell/size_report.hpp"
#include "testbench/sweep/design.hpp"
#include "testbench/sweep/runs.hpp"

namespace raycell {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string decimals(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

/// What the search may choose; of each the cheapest first.
std::vector<FrameAxis> axes_of(const RenderOptions& options, const FrameGoal& goal, bool curved,
                               int least_store) {
    std::vector<std::string> stores;
    for (const int slots : {least_store, least_store + 1, 8, 12, 16, 24, 32}) {
        if (stores.empty() || slots > std::stoi(stores.back())) stores.push_back(std::to_string(slots));
    }
    std::vector<std::string> levels;
    for (int power = 16; power < options.picture.depth_levels; power *= 4)
        levels.push_back(std::to_string(power));
    levels.push_back(std::to_string(options.picture.depth_levels));
    // The whole error is that of the polygons and the machine's own.
    std::vector<std::string> polygons = {"0"};
    if (curved && goal.accuracy.psnr_db > 0) {
        polygons.clear();
        for (const double more : {0.0, 1.5, 3.0, 6.0, 10.0})
            polygons.push_back(decimals(std::min(goal.accuracy.psnr_db + more, 100.0)));
    }
    return {{"tessellate-for", polygons, true},
            {"hit", {"depth", "interval", "plane", "mask", "edge"}, true},
            {"normals", {"voxel", "linear"}, true},
            {"shadows", {"per-hit", "precast"}, true},
            {"word-bits", {"8", "10", "11", "12", "13", "14", "16", "18", "20", "24", "28", "32"}, true},
            {"depth", levels, true},
            {"ray-store", stores, false},
            {"buffer", {"1", "2", "4", "8"}, false},
            {"loading-units", {"1", "2", "4"}, false},
            {"traversal-units", {"1", "2", "4"}, false},
            {"networks", {"half", "quadrant"}, false},
            {"feed-lanes", {"4", "16", "64", "128"}, false}};
}

/// The machine from which pictures are tried: words of 20 bits, or of 32 for what needs more; the cheapest
/// machine, which no picture depends on.
FramePoint start_of(const std::vector<FrameAxis>& axes, const FrameGoal& goal) {
    constexpr double most_at_20_bits = 55;  // dB
    FramePoint start(axes.size(), 0);
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::vector<std::string>& values = axes[i].values;
        if (axes[i].picture) start[i] = values.size() - 1;
        if (axes[i].option == "shadows") start[i] = 0;
        if (axes[i].option == "word-bits" && goal.accuracy.psnr_db < most_at_20_bits)
            start[i] = std::size_t(std::find(values.begin(), values.end(), "20") - values.begin());
    }
    return start;
}

/// Machines as processes of their own, two or more at a time.
class RunModel : public FrameModel {
  public:
    RunModel(const RenderOptions& options, const std::vector<FrameAxis>& axes)
        : options_(options), axes_(axes), folder_(options.prefix + ".runs") {
        fs::create_directories(folder_);
        RenderOptions base = options;
        base.prefix = RenderOptions().prefix;
        base.truth = true;
        base.clip_truth = options.picture.exterior == ExteriorMode::none;
        configuration_ = to_toml(render_configuration(base));
        identity_ = digest_of(program_) + digest_of(options.scene) + digest_of(options.view) +
                    digest_of(options.sources);
        write_text(base_file(), configuration_);
    }

    std::vector<FrameTrial> run(const std::vector<FramePoint>& points, bool timed) const override {
        std::vector<SweepRun> runs;
        for (const FramePoint& point : points) runs.push_back(run_of(point, timed));
        const int jobs = int(std::max(1U, std::thread::hardware_concurrency()));
        const bool all = make_runs(runs, jobs, false, [&](std::size_t done, std::size_t of, double) {
            if (shows_progress(options_))
                std::cerr << "\r\033[Ksize: " << step_ << ": " << done << " of " << of << " runs, "
                          << before_ + done << " in all" << std::flush;
        });
        if (!all) throw Interrupted();
        before_ += runs.size();
        std::vector<FrameTrial> trials;
        for (std::size_t i = 0; i < points.size(); ++i) trials.push_back(trial_of(points[i], runs[i], timed));
        return trials;
    }

    std::uint64_t loading_floor(const FramePoint& point, std::uint64_t voxels) const override {
        RenderOptions chosen;
        CLI::App unused;
        OptionTable table(unused);
        add_machine_options(table, chosen);
        const std::size_t hit = axis("hit");
        unused.parse("--hit=" + axes_[hit].values[point[hit]]);
        return (voxels + most_units - 1) / most_units * options_.machine.costs.load_voxel(chosen.picture.hit);
    }

    void step_begins(const std::string& what) const override { step_ = what; }

    struct Interrupted {};

  private:
    std::string base_file() const { return folder_ + "/base.toml"; }

    std::size_t axis(const std::string& option) const {
        return std::size_t(
            std::find_if(axes_.begin(), axes_.end(), [&](const FrameAxis& a) { return a.option == option; }) -
            axes_.begin());
    }

    SweepRun run_of(const FramePoint& point, bool timed) const {
        SweepRun run;
        std::vector<std::string> words = {std::string("--engine=") + (timed ? "timed" : "untimed")};
        for (std::size_t i = 0; i < axes_.size(); ++i)
            words.push_back("--" + axes_[i].option + "=" + axes_[i].values[point[i]]);
        std::string all = configuration_ + identity_;
        for (const std::string& word : words) all += word;
        run.prefix = folder_ + "/" + digest(all);
        run.command = {program_, "render", "--config=" + base_file()};
        run.command.insert(run.command.end(), words.begin(), words.end());
        run.command.insert(run.command.end(), {"--quiet", "--output=" + run.prefix});
        return run;
    }

    FrameTrial trial_of(const FramePoint& point, const SweepRun& run, bool timed) const {
        std::ifstream file(run.prefix + ".json");
        FrameTrial trial;
        trial.point = point;
        trial.run = run.prefix;
        try {
            const Json json = Json::parse(file);
            trial.accuracy.psnr_db = json.at("accuracy").at("scene").at("psnr_db");
            trial.accuracy.wrong_hit_percent = json.at("accuracy").at("wrong_hit_percent");
            trial.most_voxels = json.at("voxels").at("max_per_cell");
            trial.voxel_bits = json.at("voxels").at("max_bits_per_cell");
            if (timed) trial.voxel_bits = json.at("load_queue").at("max_bits_per_cell");
            const auto cells = std::uint64_t(options_.picture.width) * std::uint64_t(options_.picture.height);
            const std::uint64_t feed = json.at("feed_bits").at("total");
            trial.bits = trial.voxel_bits + json.at("storage_bits").at("total").get<std::uint64_t>() +
                         (feed + cells - 1) / cells;
            if (timed) {
                trial.verdict = json.at("verdict");
                const Json& cycles = json.at("cycles");
                trial.load = cycles.at("load");
                trial.trace =
                    cycles.at("precast").get<std::uint64_t>() + cycles.at("trace").get<std::uint64_t>();
            }
        } catch (const Json::exception& error) {
            throw std::runtime_error(run.prefix + ".json: " + error.what());
        }
        return trial;
    }

    const RenderOptions& options_;
    const std::vector<FrameAxis>& axes_;
    const std::string folder_;
    const std::string program_ = program_beside("raycell");
    std::string configuration_;
    std::string identity_;
    mutable std::string step_;
    mutable std::size_t before_ = 0;  ///< runs of earlier calls
};

/// The configuration of a run as render takes it, without where its results went.
std::string configuration_of(const FrameTrial& trial) {
    std::ifstream file(trial.run + ".json");
    Json config = Json::parse(file).at("config");
    config["output"] = RenderOptions().prefix;
    config["quiet"] = config["truth"] = false;
    return to_toml(config);
}

}  // namespace

int size_frames(const RenderOptions& options, const FrameGoal& goal, bool curved, int least_store,
                OutputSet& outputs) {
    const std::vector<FrameAxis> axes = axes_of(options, goal, curved, least_store);
    const RunModel model(options, axes);
    FrameSearch search(model, goal, axes, start_of(axes, goal));
    std::optional<FrameTrial> found;
    try {
        found = search.find();
    } catch (const RunModel::Interrupted&) {
        if (shows_progress(options)) end_progress();
        std::cerr << "raycell: interrupted: the same command goes on where it was\n";
        return exit_interrupted;
    }
    if (shows_progress(options)) end_progress();
    const FrameReport report(axes, search.tried(), goal);
    outputs.write(".csv", report.csv());
    outputs.write(".json", report.json(found, search.nearest()));
    outputs.write(".svg", report.chart(found));
    outputs.write_if(found.has_value(), ".toml", [&] { return configuration_of(*found); });
    outputs.publish();
    if (!options.quiet) std::cout << report.front_table();
    if (!found) {
        std::cout.flush();
        std::cerr << "raycell: no machine tried reaches the goal; nearest: "
                  << report.words_for(search.nearest()) << '\n';
        return exit_comparison;
    }
    if (!options.quiet)
        std::cout << "\nsmallest machine: " << report.words_for(*found)
                  << "\nconfiguration: " << options.prefix << ".toml\n";
    return exit_done;
}

}  // namespace raycell
