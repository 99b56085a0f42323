// The messages on the links, and how many bits each kind takes.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/geometry/sources.hpp"
#include "model/settings/settings.hpp"
#include "model/tracing/ray.hpp"

namespace raycell {

/// A message on the way back: an intensity, a verdict on a source, or a postponed notice, which says that a
/// ray was destroyed and must be sent again.
struct Answer {
    enum class Kind : std::uint8_t { intensity, lit, blocked, postponed };
    dvec3 colour{0, 0, 0};
    std::uint64_t id = 0;      ///< of the ray that it answers
    std::uint32_t slot = 0;    ///< as in the ray
    std::uint16_t home_x = 0;  ///< destination
    std::uint16_t home_y = 0;
    std::uint8_t child = 0;
    RayKind ray_kind = RayKind::primary;
    Kind kind = Kind::intensity;
};
Answer answer_to(const Ray& ray, Answer::Kind kind);

/// Bits of the messages, for an array of width x height cells and M slots; docs/reference/cell.md has the
/// table.
struct MessageBits {
    int ray = 0;
    int shadow_ray = 0;  ///< a ray with its distance to the source
    int intensity = 0;
    int verdict = 0;     ///< also the postponed notice
    int span = 0;        ///< without its edges
    int trapeze = 0;     ///< without its edges
    int edge = 0;        ///< of a span or a trapeze
    int span_edges = 4;  ///< at most: rung `depth` needs none
    int surface = 0;
    int polygon = 0;  ///< without its vertices
    int vertex = 0;
    int features = 0;
    int end_of_scene = 0;
    int longest_span() const { return span + span_edges * edge; }
    int longest_trapeze() const { return trapeze + 4 * edge; }
    /// Viewer and sources; if not all of these are points, each begins with its kind.
    int setup(const SourceCounts& sources) const;
    int viewer = 0;
    std::array<int, std::size_t(source_kinds)> source{};  ///< by kind
};
/// Primary rays of a cell that may be under way at once.
inline int own_rays_of(const PictureSettings& picture, const MachineSettings& machine) {
    return std::min(machine.own_rays, picture.own_samples());
}
/// Bits of the slot, the own ray or the voxel that an answer is for.
int slot_address_bits(const PictureSettings& picture, const MachineSettings& machine);
/// Bits of a ray's depth. Outside the cube, on the way to the border, a ray is before it or behind it: so
/// there are more of them than for a depth in a voxel.
inline int wire_depth_bits(const Formats& formats) { return formats.depth.bits(); }
MessageBits message_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats);

/// Cycles that a message of `bits` takes over a link of `link_bits` per cycle.
constexpr int link_cycles(int bits, int link_bits) { return (bits + link_bits - 1) / link_bits; }

/// Buffer classes of a link: which messages share a buffer (design, section 5).
struct BufferClasses {
    int count = 2;   ///< number of classes; their indices start at 0
    int answer = 1;  ///< class of answers
    int ray(const Ray& r) const;
    bool holds_answers(int index) const { return index == answer; }
    bool holds_rays(int index) const { return index != answer || count == 1; }
    bool used(int index, bool horizontal,
              Side side) const;  ///< whether a link in this direction has the buffer
    /// Bit set of the classes used on a link that leaves its source over this side.
    std::uint32_t used_over(Side side) const;
    Networks networks = Networks::split;
};
BufferClasses buffer_classes(Networks networks);
/// Name of a buffer class as statistics and reports print it: "ray_east", "answer".
const char* class_name(Networks networks, int index);

}  // namespace raycell
