// Cycles and rays that the scenarios share. They are written out on purpose, not taken from the model:
// docs/reference/cell.md has the costs (those estimated by hand), docs/reference/cell_tb.md the words.
#pragma once

#include "testbench/cell/script.hpp"

namespace raycell::scripted {

// Buffer classes of the network `half`.
constexpr int east_bound = 0;
constexpr int west_bound = 1;
constexpr int answers = 2;

// Link cycles of messages: links of 20 bits, 3x3 cells, M = 8, a cube 10 deep (4 + 20 bits of depth). An
// address has home 4, slot 4 and child 6 bits.
constexpr int ray_link = 13;       // 3 + 64 + 60 + 52 + 20 + 20 + 6 + 14 + 3 = 242 bits
constexpr int shadow_link = 12;    // without the generation: 236 bits
constexpr int intensity_link = 4;  // 3 + 60 + 14 = 77 bits
constexpr int verdict_link = 1;    // 3 + 14 = 17 bits

constexpr Cycle walk = 4;
constexpr Cycle reciprocal = 4;
constexpr Cycle root = 5;
constexpr Cycle compare_run = 2;
/// A voxel whose run meets the ray: the edge test, the point where the ray meets the plane, two edges.
constexpr Cycle compare = compare_run + 4 + reciprocal + 2 * 2;
constexpr Cycle return_route = 1;
constexpr Cycle set_up = 20 + 7 + root;  // point and interpolated normal
constexpr Cycle reflect = 6 + root + 2 * reciprocal;
constexpr Cycle shade = 6;
constexpr Cycle load_voxel = 12;
constexpr Cycle load_advance = 1;
constexpr Cycle load_forward = 1;
constexpr Cycle backoff = 64;

/// What a back-off lasts: the shortest, doubled with each attempt up to 64 times, and a jitter below that,
/// which is a hash of the seed (1), the ray's id and the attempt.
constexpr Cycle back_off(std::uint64_t ray, unsigned attempt) {
    const Cycle base = backoff << (attempt < 6 ? attempt : 6);
    std::uint64_t h = 0x9e3779b97f4a7c15 ^ ray * 0xbf58476d1ce4e5b9 ^ attempt * 0x94d049bb133111eb;
    h = (h ^ h >> 31U) * 0x7fb5d329728ea185;
    return base + (h ^ h >> 27U) % base;
}

inline const dvec3 black{0, 0, 0};

/// The id of all rays of the scripts.
constexpr std::uint64_t ray_of_script = std::uint64_t(3) << 32U | 7U;

/// A ray that cell (0, 1) sent, in the coordinates of cell (1, 1); the direction is rounded to words.
inline Ray ray_of(RayKind kind, const dvec3& position, const dvec3& direction) {
    Ray ray;
    ray.kind = kind;
    ray.position = position;
    const Arithmetic& arithmetic = script_arithmetic();
    set_direction(ray, arithmetic.hold(arithmetic.formats().unit, direction), arithmetic);
    ray.fresh = false;
    ray.home_x = 0;
    ray.home_y = 1;
    ray.slot = 2;
    ray.generation = 1;
    ray.id = ray_of_script;
    return ray;
}

inline Ray moved_to(Ray ray, const dvec3& position) {
    ray.position = position;
    return ray;
}

inline Answer answer_for(const Ray& ray, Answer::Kind kind, const dvec3& colour = dvec3(0)) {
    Answer answer = answer_to(ray, kind);
    answer.colour = colour;
    return answer;
}

/// A cell with nothing loaded; the trace begins in cycle 1. The own ray is tested from cycle 1 to 5 and
/// leaves through the back; nothing lies there, so its answer is home at once.
inline Script empty_cell(const std::string& name, const std::string& says) {
    Script script(name, says);
    script.trace(1).pixel(1 + walk, black);
    return script;
}

constexpr Cycle walled_trace = 2 + load_voxel + 6;
/// What the scripts send first: by then the own ray has left.
constexpr Cycle sent = walled_trace + 4 * (walk + compare) + 8;

/// A cell with a mirror at x = 0.75 that faces west, from z = 2 to 8; the own ray passes beside it. The
/// mirror is loaded from cycle 1 on, the trace begins in cycle walled_trace.
inline Script mirrored_cell(const std::string& name, const std::string& says) {
    Script script(name, says);
    Material mirror;
    mirror.diffuse = 0;
    mirror.specular = 1;
    mirror.shine = 1e9;
    script.setup().scene.objects.push_back(mirror);
    script.in(1, Side::west, 1, span_of(script.setup(), 0, {1.75, 0, 2}, {0, 3, 0}, {0, 0, 6}, 1, 1))
        .take(2 + load_advance, Side::west, 0)
        .trace(walled_trace)
        .pixel(walled_trace + walk + compare, black);
    return script;
}

}  // namespace raycell::scripted
