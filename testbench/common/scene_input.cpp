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

/// The chosen line of --frames; without the option one that changes nothing.
FrameLine frame_of(const RenderOptions& options) {
    if (options.frames.empty()) {
        if (options.frame == 0) return {};
        throw UsageError("--frame " + std::to_string(options.frame) +
                         ": there is no list of frames; expected --frames FILE");
    }
    const std::vector<FrameLine> frames = read_frame_list(options.frames);
    const std::string allowed = "expected --frame from 1 to " + std::to_string(frames.size());
    if (options.frame == 0)
        throw UsageError("--frames: only 'raycell render' takes all frames of a list; " + allowed);
    if (std::size_t(options.frame) > frames.size())
        throw UsageError("--frame " + std::to_string(options.frame) + ": " + options.frames +
                         " has no such frame; " + allowed);
    return frames[std::size_t(options.frame) - 1];
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
    if (!options.sources.empty()) spare(outputs, options.sources, "sources");
    if (!options.frames.empty()) spare(outputs, options.frames, "list of frames");
    if (!options.load_array.empty()) spare(outputs, options.load_array, "loaded array");
    if (!options.config.empty() && !same_file(options.config, options.prefix + ".toml"))
        spare(outputs, options.config, "configuration");
}

Scene read_frame(const RenderOptions& options, const FrameLine& frame, const OutputSet& outputs,
                 Diagnostics& diagnostics) {
    const std::filesystem::path path =
        frame.scene.empty() ? std::filesystem::path(options.scene) : frame.scene;
    if (path.empty()) throw UsageError("no scene given; expected a file .nff or .obj, see --help");
    spare(outputs, path, "scene");
    std::optional<std::filesystem::path> view;
    if (!options.view.empty()) view = options.view;
    std::optional<std::filesystem::path> sources;
    if (!options.sources.empty()) sources = options.sources;
    Scene scene = load_scene(path, view, diagnostics, sources);
    for (const std::string& library : scene.libraries) spare(outputs, library, "material library");
    scene.view = view_of(frame, *scene.view, options.frames);
    return scene;
}

CellScene read_and_place(const RenderOptions& options, const OutputSet& outputs) {
    spare_inputs(options, outputs);
    Diagnostics diagnostics;
    const Scene scene = read_frame(options, frame_of(options), outputs, diagnostics);
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
