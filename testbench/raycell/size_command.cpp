// raycell size: the smallest machine that renders a scene as accurately as wanted.
#include <iostream>
#include <memory>
#include <mutex>

#include "model/machine/untimed.hpp"
#include "model/truth/clip.hpp"
#include "model/truth/exterior.hpp"
#include "model/truth/truth.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/machine_run.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/size_frames.hpp"
#include "testbench/raycell/size_report.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

struct SizeOptions : RenderOptions {
    SizeOptions() { prefix = "size"; }
    SizeGoal goal;
    std::int64_t frame_cycles = 0;  ///< 0: cycles do not matter
};

PictureSettings picture_of(const RenderOptions& options, const SizeSetting& setting) {
    PictureSettings picture = options.picture;
    picture.hit = setting.hit;
    picture.normals = setting.normals;
    picture.shadows = setting.shadows;
    picture.depth_levels = setting.depth_levels;
    picture.numbers.word_bits = setting.word_bits;
    return picture;
}

/// The scene as placed with this number of depth levels, on which nothing else of it depends.
CellScene with_levels(CellScene scene, int depth_levels) {
    scene.frame.depth_levels = depth_levels;
    return scene;
}

/// What the cells of an array hold, independent of what normals and shadow bits add to a voxel.
class LoadedCells {
  public:
    LoadedCells(const CellScene& scene, const PictureSettings& picture) {
        const Context context(scene, picture);
        for (const CellStore& cell : load_array(scene, picture, context.arithmetic)) {
            counts_.add(cell, {});
            const std::size_t voxels = cell.voxels.size();
            if (most_edges_.size() <= voxels) most_edges_.resize(voxels + 1, none);
            most_edges_[voxels] = std::max(most_edges_[voxels], std::int64_t(cell.edges.size()));
        }
    }

    StorageCounts storage(const VoxelBits& each) const {
        const auto base = std::uint64_t(each.base);
        const auto per_edge = std::uint64_t(each.per_edge);
        StorageCounts counts = counts_;
        counts.bits = counts.voxels * base + counts.edges * per_edge;
        for (std::size_t voxels = 0; voxels < most_edges_.size(); ++voxels) {
            if (most_edges_[voxels] == none) continue;
            const std::uint64_t bits = voxels * base + std::uint64_t(most_edges_[voxels]) * per_edge;
            counts.max_cell_bits = std::max(counts.max_cell_bits, bits);
        }
        return counts;
    }

  private:
    static constexpr std::int64_t none = -1;
    StorageCounts counts_;
    std::vector<std::int64_t> most_edges_;  ///< by number of voxels in a cell: most edges of such cells
};

/// Machines of one scene, measured by the untimed engine: their colours against the scene's truth, their
/// first hits against the polygons'.
class ArrayModel : public SizeModel {
  public:
    ArrayModel(const RenderOptions& options, const CellScene& scene, const ExteriorTracer* exterior,
               const Picture& truth, const Picture& polygons)
        : options_(options), scene_(scene), exterior_(exterior), truth_(truth), polygons_(polygons) {}

    StorageCounts storage(const SizeSetting& setting) const override {
        const PictureSettings picture = picture_of(options_, setting);
        const Formats formats(picture.numbers.word_bits, picture.numbers.rounding, extent_of(scene_.frame));
        return loaded(setting).storage(
            voxel_bits(picture, formats, SourceCounts(scene_.sources, picture.source_samples).lights));
    }

    SizeTrial run(const SizeSetting& setting) const override {
        show(setting);
        const CellScene scene = with_levels(scene_, setting.depth_levels);
        UntimedMachine machine(scene, picture_of(options_, setting), exterior_);
        SizeTrial trial;
        trial.setting = setting;
        const Picture picture = machine.render();
        trial.accuracy = compare(picture, truth_);
        trial.accuracy.wrong_hit_percent = compare(picture, polygons_).wrong_hit_percent;
        trial.image = image_hash(picture);
        trial.storage = machine.storage();
        return trial;
    }

    void step_begins(const SizeStep& step) const override {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (step.number != step_.number) runs_before_ = runs_;
        step_ = step;
    }

  private:
    const LoadedCells& loaded(SizeSetting setting) const {
        setting.normals = Normals::linear;
        setting.shadows = Shadows::per_hit;
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            const auto found = loaded_.find(setting);
            if (found != loaded_.end()) return found->second;
        }
        const CellScene scene = with_levels(scene_, setting.depth_levels);
        LoadedCells cells(scene, picture_of(options_, setting));
        const std::lock_guard<std::mutex> lock(mutex_);
        return loaded_.emplace(setting, std::move(cells)).first->second;
    }

    void show(const SizeSetting& setting) const {
        if (!shows_progress(options_)) return;
        SizeTrial trial;
        trial.setting = setting;
        const std::lock_guard<std::mutex> lock(mutex_);
        std::cerr << "\r\033[Ksize: step " << step_.number << " of " << SizeStep::count << ", " << step_.what;
        if (step_.number == 3) std::cerr << ' ' << step_.part << " of " << step_.parts;
        std::cerr << "; run " << ++runs_;
        if (step_.number < 3) std::cerr << " of " << runs_before_ + step_.parts;
        std::cerr << ": " << words_for(report(trial)) << std::flush;
    }

    const RenderOptions& options_;
    const CellScene& scene_;
    const ExteriorTracer* exterior_;
    const Picture& truth_;
    const Picture& polygons_;
    mutable std::mutex mutex_;
    mutable std::map<SizeSetting, LoadedCells> loaded_;
    mutable std::size_t runs_ = 0;
    mutable std::size_t runs_before_ = 0;  ///< the present step
    mutable SizeStep step_{1, "hit tests", 0, 0};
};

/// The limit, and the powers of two below it.
std::vector<int> levels_to_try(int limit) {
    std::vector<int> levels = {limit};
    for (int power = 65536; power >= 1; power /= 2) {
        if (power < limit) levels.push_back(power);
    }
    return levels;
}

/// The found machine as options of render: no larger voxel capacity than it needs, the fewest slots that are
/// guaranteed to end (design, section 5), buffers of one message.
RenderOptions machine_of(const SizeOptions& options, const CellScene& scene, const SizeTrial& found) {
    RenderOptions machine = options;
    machine.prefix = RenderOptions().prefix;
    machine.quiet = false;
    machine.picture = picture_of(options, found.setting);
    machine.picture.voxel_capacity = int(found.storage.max_voxels);
    machine.machine.ray_store =
        std::max(1, bound_of(Context(scene, machine.picture), machine.machine).generations);
    machine.machine.buffer_depth = 1;
    machine.engine = Engine::timed;
    machine.clip_truth = options.picture.exterior == ExteriorMode::none;
    return machine;
}

RunResult run_timed(const SizeOptions& options, const RenderOptions& found, const CellScene& scene,
                    const ExteriorTracer* tracer) {
    // Never destroyed, as in render.
    static Machine* const machine = new Machine("machine", scene, found.picture, found.machine, tracer);
    const bool progress = shows_progress(options);
    RunResult result = machine->run(progress ? show_progress : std::function<void(const RunProgress&)>());
    if (progress) end_progress();
    return result;
}

void print_timed(const RunResult& timed, const MachineSettings& machine) {
    std::cout << "timed run: " << name_of(timed.verdict) << " after "
              << timed.load_cycles + timed.precast_cycles + timed.trace_cycles
              << " cycles; ray store M = " << machine.ray_store << ", " << timed.ray_store_peak
              << " in use at most; buffers of " << machine.buffer_depth << ", in use at most:";
    for (const RunResult::BufferUse& use : timed.buffers) std::cout << ' ' << use.name << ' ' << use.peak;
    std::cout << '\n';
}

int report_found(const SizeOptions& options, const CellScene& scene, const ExteriorTracer* tracer,
                 const SizeTrial& found, Json json, OutputSet& outputs) {
    const CellScene placed = with_levels(scene, found.setting.depth_levels);
    const RenderOptions machine = machine_of(options, placed, found);
    const Bound bound = bound_of(Context(placed, machine.picture), machine.machine);
    warn_of(bound);
    const RunResult timed = run_timed(options, machine, placed, tracer);
    if (timed.verdict == Verdict::completed && image_hash(timed.picture) != found.image) {
        throw std::logic_error("internal error: the timed machine's picture is not the untimed one's");
    }
    json["found"] = report(found);
    json["found"]["voxel_capacity"] = machine.picture.voxel_capacity;
    json["found"]["ray_store"] = machine.machine.ray_store;
    json["found"]["buffer_depth"] = machine.machine.buffer_depth;
    json["timed"] = report(timed, placed, machine.picture, machine.machine);
    outputs.write(".csv", tried_csv(json["tried"]));
    outputs.write(".json", to_text(json));
    outputs.write(".toml", to_toml(render_configuration(machine)));
    outputs.publish();
    explain(timed, bound);
    if (options.quiet) return exit_code(timed.verdict);
    std::cout << "\nsmallest machine: " << words_for(json["found"]) << '\n'
              << "accuracy " << accuracy_words(json["found"]) << "\n\n"
              << beside_the_paper(json["found"]) << '\n';
    print_timed(timed, machine.machine);
    std::cout << "configuration: " << options.prefix << ".toml\n";
    return exit_code(timed.verdict);
}

int report_unreachable(const SizeTrial& nearest, Json json, OutputSet& outputs) {
    json["nearest"] = report(nearest);
    outputs.write(".csv", tried_csv(json["tried"]));
    outputs.write(".json", to_text(json));
    outputs.publish();
    std::cout.flush();
    std::cerr << "raycell: no setting reaches the goal; nearest: " << accuracy_words(json["nearest"])
              << " with " << words_for(json["nearest"]) << '\n';
    return exit_comparison;
}

int run(const SizeOptions& options, const OptionTable& table, const CLI::App& app) {
    if (app.count("--psnr") + app.count("--wrong-hits") + app.count("--frame-cycles") == 0) {
        throw UsageError(
            "no goal given; expected --psnr, --wrong-hits, --frame-cycles or several, see --help");
    }
    OutputSet outputs(options.prefix);
    check_place("--output", options.prefix);
    outputs.announce({".csv", ".json", ".toml"});
    if (options.frame_cycles > 0) outputs.announce({".svg"});
    check_memory(options);
    check_samples(options.picture);
    const CellScene scene = read_and_place(options, outputs);
    if (options.frame_cycles > 0) {
        const int generations = bound_of(Context(scene, options.picture), options.machine).generations;
        const FrameGoal goal{options.goal, std::uint64_t(options.frame_cycles)};
        return size_frames(options, goal, !scene.curved.empty(), std::max(1, generations), outputs);
    }
    TruthSettings tree = truth_settings(options.picture, options.truth_samples);
    const bool exterior = options.picture.exterior == ExteriorMode::host;
    const CellScene clipped = exterior ? CellScene() : clip_scene(scene);
    const CellScene& seen = exterior ? scene : clipped;
    const TruthRenderer truth(seen, tree);
    const Picture exact = truth.render();
    tree.of = TruthOf::polygons;
    tree.beyond = exterior ? &truth : nullptr;
    const Picture polygons = seen.curved.empty() ? exact : TruthRenderer(seen, tree).render();
    const ClassicalExterior outside(seen, truth);
    const ExteriorTracer* const tracer = exterior ? &outside : nullptr;

    const ArrayModel model(options, scene, tracer, exact, polygons);
    SizeSearch search(model, options.goal, levels_to_try(options.picture.depth_levels));
    const std::optional<SizeTrial> found = search.find();
    if (shows_progress(options)) end_progress();
    Json json;
    json["goal"] = {{"psnr_db", options.goal.psnr_db}, {"wrong_hit_percent", options.goal.wrong_hit_percent}};
    json["reached"] = found.has_value();
    json["paper"] = paper_figures();
    json["config"] = table.values();
    json["tried"] = Json::array();
    for (const SizeTrial& trial : search.tried()) json["tried"].push_back(report(trial));
    if (!options.quiet) std::cout << tried_table(json["tried"]);
    if (!found) return report_unreachable(search.nearest(), std::move(json), outputs);
    return report_found(options, scene, tracer, *found, std::move(json), outputs);
}

}  // namespace

Command add_size_command(CLI::App& program) {
    auto options = std::make_shared<SizeOptions>();
    CLI::App* app = program.add_subcommand(
        "size", "Finds the smallest machine for an accuracy; exit code 2 if there is none");
    auto table = std::make_shared<OptionTable>(*app);
    add_preset_option(*app);
    app->add_option("--config", options->config,
                    "options from a file that size or render wrote; the command line has precedence")
        ->type_name("FILE");
    add_scene_options(*table, *options);
    table->number("psnr", options->goal.psnr_db, 0.0, 200.0, "goal: at least this PSNR, dB");
    table->number("wrong-hits", options->goal.wrong_hit_percent, 0.0, 100.0,
                  "goal: at most so many pixels with another first hit, percent");
    table->number("frame-cycles", options->frame_cycles, std::int64_t(0), std::int64_t(1) << 62,
                  "goal: at most so many cycles for a frame, loading and trace; 0: any");
    table->number("depth", options->picture.depth_levels, 1, 65536, "most depth levels of the cube to try");
    table->choice("exterior", options->picture.exterior,
                  {{"host", ExteriorMode::host}, {"none", ExteriorMode::none}},
                  "rays that leave the cube: traced on by the exterior processors, or lost");
    add_source_samples(*table, options->picture);
    add_truth_samples(*table, *options);
    table->number("seed", options->machine.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1,
                  "of the back-off's jitter in the timed run");
    return {app, [options, table, app] { return run(*options, *table, *app); }};
}

}  // namespace raycell
