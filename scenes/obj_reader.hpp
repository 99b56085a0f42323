// Reads scenes in Wavefront's OBJ format: polygons and their materials. OBJ has neither view nor light.
//
// Of a `v` line x, y and z are read. A fourth number is a weight of rational curves, which polygons do not
// have: it is ignored, with a warning unless it is 1; colours behind the coordinates are ignored in silence.
// Texture coordinates are counted only. A face with a normal at each corner is handed over with normals, else
// flat. Faces may name vertices that come later. Groups are ignored; points, lines and free-form surfaces are
// left out with a warning. Without a material (or with an unknown one, then with a warning) a face gets the
// default Material. An error: unknown words, malformed or non-finite numbers, indices that name nothing,
// faces of less than 3 corners.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "model/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Reads a scene file and the material libraries in its folder. Scene::view and Scene::sources stay empty.
/// Throws InputError.
Scene read_obj(const std::filesystem::path& path, Diagnostics& diagnostics);

/// The same from memory; `name` stands for the file in messages, libraries are looked up in `folder`.
Scene read_obj_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                    Diagnostics& diagnostics);

/// Gives a scene a view that frames its bounding box, from the side of +z with y up, and one source at the
/// viewer; a note says so.
void add_default_view(Scene& scene, Diagnostics& diagnostics);

/// Takes background and view from `view_scene`, and its sources if it has any. Scene::view stays as it is if
/// `view_scene` has none.
void take_view(Scene& scene, const Scene& view_scene);

}  // namespace raycell
