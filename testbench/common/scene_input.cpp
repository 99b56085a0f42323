#include "testbench/common/scene_input.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "model/truth/fineness.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {

namespace {

void spare(const OutputSet& outputs, const std::string& input, const char* what) {
    for (const std::string& path : outputs.announced()) {
        if (same_file(path, input))
            throw UsageError(path + ": it would be overwritten, but is the run's " + what +
                             "; expected another name for what is written");
    }
}

/// Chord errors for --tessellate-for; none without it.
std::vector<double> chosen_chord_errors(const RenderOptions& options, const Scene& scene,
                                        const Frame& frame) {
    if (!(options.picture.tessellate_for > 0)) return {};
    Fineness fineness = fineness_for(scene, frame, options.picture);
    if (!fineness.reached) {
        std::cerr << scene.name << ": warning: the finest polygons are " << fineness.psnr_db
                  << " dB from the scene, not " << options.picture.tessellate_for << " (--tessellate-for)\n";
    }
    return std::move(fineness.chord_errors);
}

}  // namespace

void spare_inputs(const RenderOptions& options, const OutputSet& outputs) {
    if (!options.scene.empty()) spare(outputs, options.scene, "scene");
    if (!options.view.empty()) spare(outputs, options.view, "view");
    if (!options.load_array.empty()) spare(outputs, options.load_array, "loaded array");
    if (!options.config.empty() && !same_file(options.config, options.prefix + ".toml"))
        spare(outputs, options.config, "configuration");
}

CellScene read_and_place(const RenderOptions& options, const OutputSet& outputs) {
    spare_inputs(options, outputs);
    if (options.scene.empty()) throw UsageError("no scene given; expected a file .nff or .obj, see --help");
    Diagnostics diagnostics;
    std::optional<std::filesystem::path> view;
    if (!options.view.empty()) view = options.view;
    const Scene scene = load_scene(options.scene, view, diagnostics);
    for (const std::string& library : scene.libraries) spare(outputs, library, "material library");
    for (const std::string& message : diagnostics.messages()) std::cerr << message << '\n';
    const Frame frame = place_frame(scene, options.picture);
    if (!std::isfinite(frame.cell_width) || !(frame.cell_width > 0) || !std::isfinite(frame.depth)) {
        throw InputError(scene.name, 0, "the view and the scene's extent give no cube of finite size",
                         "a scene whose extent is within reach of the viewer's distance");
    }
    CellScene placed = place_scene(scene, frame, options.picture, chosen_chord_errors(options, scene, frame));
    for (const std::string& warning : placed.warnings)
        std::cerr << scene.name << ": warning: " << warning << '\n';
    return placed;
}

void check_place(const std::string& option, const std::string& path) {
    const std::filesystem::path file(path);
    // Folders that are not there will be made.
    std::filesystem::path folder = file.parent_path();
    while (!folder.empty() && !std::filesystem::exists(folder)) folder = folder.parent_path();
    if (folder.empty()) folder = ".";
    if (file.filename().empty() || !std::filesystem::is_directory(folder) ||
        access(folder.c_str(), W_OK | X_OK) != 0) {
        throw UsageError(option + " " + path +
                         ": expected a name in a folder that can be written to, or made where it is missing");
    }
}

bool shows_progress(const RenderOptions& options) { return !options.quiet && isatty(STDERR_FILENO); }

void end_progress() { std::cerr << "\r\033[K" << std::flush; }

}  // namespace raycell
