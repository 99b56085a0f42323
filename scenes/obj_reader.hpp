// Reads scenes in Wavefront's OBJ format: polygons and their materials. OBJ has neither view nor light.
//
// What leaves the geometry whole is a warning, what does not is an error; docs/use/scenes.md has the list.
// Of a `v` line x, y and z are read. Texture coordinates are counted only. A face with a normal at each
// corner is handed over with normals, one in a smoothing group with those of the group, any other flat. Faces
// may name vertices that come later. Without a material (or with an unknown one, then with a warning) a face
// gets the default Material. An error: a vertex without three finite numbers, a face with a vertex index that
// is malformed or names nothing, a file without any statement of OBJ.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Reads a scene file and the material libraries in its folder. Scene::view and Scene::sources stay empty.
/// Throws InputError.
Scene read_obj(const std::filesystem::path& path, Diagnostics& diagnostics);

/// The same from memory; `name` stands for the file in messages, libraries are looked up in `folder`.
Scene read_obj_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                    Diagnostics& diagnostics);

}  // namespace raycell
