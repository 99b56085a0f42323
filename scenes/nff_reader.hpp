// Reads scenes in the Neutral File Format (Haines 1988, version 3.9).
//
// Legal oddities, each with a warning:
// - colours above 1 are kept, negative ones become 0; Kd, Ks and T are clamped to 0..1, a negative shine
//   becomes 0; an index of refraction below 0.01 becomes 1 (without a warning if T = 0);
// - primitives before any `f` get the default Material;
// - spheres and cones without extent are dropped; outlines are repaired (outline.hpp);
// - a second `b` or `v` replaces the first; `b`, `v` and `l` may come after objects;
// - the lines of `v` may come in any order, but each must come exactly once.
// A negative radius makes an inward surface; surfaces stay two-sided.
// Errors: unknown words, wrong counts of numbers, numbers that are not finite or beyond 1e30, colours beyond
// 1e6, an unusable view, more than max_sources sources, cones with radii of opposite signs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "model/geometry/scene.hpp"
#include "scenes/diagnostics.hpp"

namespace raycell {

/// Largest resolution that a view may ask for, in each direction.
constexpr int max_resolution = 65536;

/// Why a view can't be used.
struct ViewFault {
    std::string what;
    std::string expected;
};
std::optional<ViewFault> fault_of(const View& view);

/// Reads a scene file. Scene::view is empty if the file has none; Scene::name is the file's name without
/// folder. Time is linear in the file's size, memory in the scene's. Throws InputError.
Scene read_nff(const std::filesystem::path& path, Diagnostics& diagnostics);

/// Reads a scene from memory; `name` stands for the file in messages.
Scene read_nff_text(std::string_view text, const std::string& name, Diagnostics& diagnostics);

/// Reads background, view and sources only; primitives are checked but not kept. Throws InputError, also if
/// there is no `v`.
Scene read_view_file(const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace raycell
