// The function through which all programs read scenes.
#pragma once

#include <filesystem>
#include <optional>

#include "model/geometry/scene.hpp"
#include "scenes/default_view.hpp"
#include "scenes/diagnostics.hpp"
#include "scenes/nff_reader.hpp"
#include "scenes/obj_reader.hpp"
#include "scenes/source_file.hpp"

namespace raycell {

/// Reads an .nff or .obj file (known by its extension, in upper or lower case) and returns a scene with a
/// view. Faces of an .obj that emit light are sources. `view_file` is an NFF file that replaces the scene's
/// background and view, and its sources if the file has any; without it an OBJ scene gets the view of
/// add_default_view(). `source_file` is a file of sources that replaces the sources or adds to them. Warns of
/// a scene without sources or without primitives. Throws InputError, also for an NFF scene without both `v`
/// and `view_file`.
Scene load_scene(const std::filesystem::path& path, const std::optional<std::filesystem::path>& view_file,
                 Diagnostics& diagnostics, const std::optional<std::filesystem::path>& source_file = {});

}  // namespace raycell
