// Reads scenes in Wavefront's OBJ format: polygons and their materials. OBJ has neither view nor light.
//
// A fault that changes the geometry is an error, any other a warning; docs/use/scenes.md lists them. Of a `v`
// line x, y and z are read. Texture coordinates are only counted. A face with a normal at each corner keeps
// its normals; another one in a smoothing group gets those of the group; all others are flat. Faces may name
// vertices that come later. A face without a material, or with an unknown one (with a warning), gets the
// default Material. Errors: a vertex without three finite numbers, a vertex index that is malformed or names
// no vertex, a file without any OBJ statement.
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

/// Reads a scene from memory; `name` stands for the file in messages, and libraries are looked up in
/// `folder`.
Scene read_obj_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                    Diagnostics& diagnostics);

}  // namespace raycell
