#include "scenes/load_scene.hpp"

#include <string>

#include "scenes/emitters.hpp"
#include "scenes/text_source.hpp"

namespace raycell {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return extension;
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const std::optional<std::filesystem::path>& view_file,
                 Diagnostics& diagnostics, const std::optional<std::filesystem::path>& source_file) {
    const std::string file = printable_path(path);
    const std::string extension = lower_extension(path);
    if (extension != ".nff" && extension != ".obj") {
        // Opened first, so that a missing file or a folder gets its own message.
        const TextSource exists(path);
        throw InputError(file, 0, "unknown kind of scene file", "a name that ends in .nff or .obj");
    }
    Scene scene = extension == ".nff" ? read_nff(path, diagnostics) : read_obj(path, diagnostics);
    if (extension == ".obj") add_emitters(scene, diagnostics);
    if (view_file) {
        if (lower_extension(*view_file) == ".obj") {
            throw InputError(printable_path(*view_file), 0, "an OBJ file has no view",
                             "an NFF file with 'v'");
        }
        take_view(scene, read_view_file(*view_file, diagnostics));
    } else if (extension == ".nff" && !scene.view) {
        throw InputError(file, 1, "the scene has no view", "a 'v' entity, or a view file");
    }
    if (source_file) take_sources(scene, read_sources(*source_file));
    if (!view_file && extension == ".obj") add_default_view(scene, diagnostics);
    if (scene.primitives.empty()) {
        diagnostics.warn(file, 0, "no primitives", "the scene has no objects; the picture is its background");
    }
    if (scene.sources.empty()) {
        diagnostics.warn(file, 0, "no sources", "the scene has no light source; only ambient light remains");
    }
    return scene;
}

}  // namespace raycell
