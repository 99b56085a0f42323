// Lists of frames: a moving viewer, moving objects. One frame a line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "model/geometry/scene.hpp"

namespace raycell {

/// A frame: what differs from the scene that a run names, and from that scene's view.
struct FrameLine {
    std::size_t line = 0;         ///< in its file, from 1
    std::filesystem::path scene;  ///< empty: the run's own
    std::optional<dvec3> from;
    std::optional<dvec3> at;
    std::optional<dvec3> up;
    std::optional<double> angle;  ///< degrees
};

constexpr std::size_t max_frames = 9999;  ///< files of frames are numbered with four digits

/// Reads a list: a frame a line, from words of NFF's `v` with their numbers, each at most once, and `scene
/// FILE` as the last, which takes the rest of the line; a path is relative to the list's folder. `#` begins a
/// comment, a line without words is no frame. Throws InputError naming file and line; there must be 1 to
/// max_frames frames.
std::vector<FrameLine> read_frame_list(const std::filesystem::path& path);

/// The view of a frame. Throws InputError naming the list's line if it can't be used.
View view_of(const FrameLine& frame, View view, const std::filesystem::path& list);

}  // namespace raycell
