// The one door through which programs read scenes.
#pragma once

#include <filesystem>
#include <optional>

#include "model/geometry/scene.hpp"
#include "scenes/default_view.hpp"
#include "scenes/diagnostics.hpp"
#include "scenes/nff_reader.hpp"
#include "scenes/obj_reader.hpp"

namespace raycell {

/// Reads an .nff or .obj file (by its extension, in any case) and returns a scene with a view. `view_file` is
/// an NFF file whose `b`, `v` and `l` lines replace the scene's own; without it an OBJ scene gets
/// add_default_view's. Warns of a scene without sources or without primitives. Throws InputError, also for an
/// NFF scene without `v` and without `view_file`.
Scene load_scene(const std::filesystem::path& path, const std::optional<std::filesystem::path>& view_file,
                 Diagnostics& diagnostics);

}  // namespace raycell
