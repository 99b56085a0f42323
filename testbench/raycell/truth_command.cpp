// raycell truth: the exact picture of a scene, or its rays counted by the rules of the SPD.
#include <chrono>
#include <iostream>

#include "model/truth/clip.hpp"
#include "model/truth/truth.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/picture_file.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

struct TruthOptions : RenderOptions {
    bool clip = false;
    int count = 0;
    TruthOf of = TruthOf::scene;
};

TruthRenderer::Progress progress_for(const TruthOptions& options) {
    if (!shows_progress(options)) return {};
    return [](int done, int all) { std::cerr << "\rtruth: row " << done << " of " << all << std::flush; };
}

int print_counts(const TruthOptions& options, const TruthRenderer& truth) {
    const TruthCounts counts = truth.count(options.count, 0, progress_for(options));
    if (shows_progress(options)) end_progress();
    std::cout << "rays through " << options.count << " x " << options.count << " points\n"
              << "eye rays      " << counts.eye << '\n'
              << "eye hits      " << counts.eye_hits << '\n'
              << "reflected     " << counts.reflected << '\n'
              << "refracted     " << counts.refracted << '\n'
              << "shadow rays   " << counts.shadow << '\n';
    return exit_done;
}

int run(const TruthOptions& options, const OptionTable& table) {
    OutputSet outputs(options.prefix);
    if (options.count == 0) {
        check_place("--output", options.prefix);
        outputs.announce({".exr", ".png", ".toml", ".json"});
    }
    CellScene scene = read_and_place(options, outputs);
    if (options.clip) scene = clip_scene(scene);
    TruthSettings settings = truth_settings(options.picture, options.truth_samples);
    settings.of = options.of;
    const TruthRenderer truth(scene, settings);
    if (options.count > 0) return print_counts(options, truth);
    const auto start = std::chrono::steady_clock::now();
    const Picture picture = truth.render(0, progress_for(options));
    if (shows_progress(options)) end_progress();
    nlohmann::ordered_json json;
    json["verdict"] = "completed";
    json["config"] = table.values();
    json["hash"]["image"] = hex(image_hash(picture));
    json["model"]["wall_seconds"]["trace"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outputs.write(".exr", [&](NewFile& file) { write_exr(picture, file); });
    outputs.write(".png", [&](NewFile& file) { write_png(picture, file); });
    outputs.write(".toml", to_toml(table.values()));
    outputs.write(".json", to_text(json));
    outputs.publish();
    if (!options.quiet) std::cout << options.prefix << ".png\n";
    return exit_done;
}

}  // namespace

Command add_truth_command(CLI::App& program) {
    auto options = std::make_shared<TruthOptions>();
    CLI::App* app = program.add_subcommand("truth", "Renders a scene exactly, without the machine");
    auto table = std::make_shared<OptionTable>(*app);
    add_preset_option(*app);
    app->add_option("--config", options->config,
                    "options from a file that truth or render wrote; the command line has precedence")
        ->type_name("FILE");
    add_scene_options(*table, *options);
    table->choice("truth-of", options->of, {{"scene", TruthOf::scene}, {"polygons", TruthOf::polygons}},
                  "what is rendered: spheres and cones as such, or the polygons that the machine loads");
    add_truth_samples(*table, *options);
    table->flag("clip", options->clip, "clip the scene to the cube");
    table->number(
        "count", options->count, 0, 8193,
        "count rays by the rules of the SPD instead of rendering: so many each way, 513 for theirs");
    return {app, [options, table] { return run(*options, *table); }};
}

}  // namespace raycell
