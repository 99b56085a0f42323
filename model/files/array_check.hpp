// Loaded arrays that come from outside: is every field one that tracing can rely on?
#pragma once

#include <string>

#include "model/files/array_file.hpp"

namespace raycell {

/// Checks an array that was loaded from this scene with these settings (by its loading_key()), field by
/// field: what is an index, count or level lies in its range, what is a number is finite and, in fixed
/// arithmetic, a word. A checksum can't say that, as anyone can write one.
/// Throws std::runtime_error "NAME: is damaged: cell 7, voxel 0: object 9; expected less than 3".
void check_array(const LoadedArray& array, const CellScene& scene, const PictureSettings& picture,
                 const std::string& name);

}  // namespace raycell
