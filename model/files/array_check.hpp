// Checks loaded arrays that come from outside, so that tracing can rely on every field.
#pragma once

#include <string>

#include "model/files/array_file.hpp"

namespace raycell {

/// Checks every field of an array that was loaded from this scene with these settings (same loading_key()).
/// Indices, counts and levels must lie in their ranges; numbers must be finite and, in fixed arithmetic,
/// words. A checksum is not enough, because anyone can write one.
/// Throws std::runtime_error "NAME: is damaged: cell 7, voxel 0: object 9; expected less than 3".
void check_array(const LoadedArray& array, const CellScene& scene, const PictureSettings& picture,
                 const std::string& name);

}  // namespace raycell
