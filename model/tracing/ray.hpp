// A ray on its way from cell to cell, and the incremental walk (Amanatides & Woo 1987), re-based at every
// hop.
#pragma once

#include <cstdint>
#include <limits>

#include "model/geometry/polygon.hpp"
#include "model/numbers/arithmetic.hpp"
#include "model/tracing/ray_id.hpp"

namespace raycell {

enum class Side : std::uint8_t { east, south, west, north };
constexpr int side_count = 4;
constexpr const char* name_of(Side side) {
    constexpr const char* names[] = {"east", "south", "west", "north"};
    return names[int(side)];
}
constexpr Side opposite(Side side) { return Side((int(side) + 2) % 4); }
constexpr int step_x(Side side) { return side == Side::east ? 1 : side == Side::west ? -1 : 0; }
constexpr int step_y(Side side) { return side == Side::south ? 1 : side == Side::north ? -1 : 0; }

enum class RayKind : std::uint8_t {
    primary,
    reflected,
    refracted,
    shadow,   ///< verdict for one slot (per-hit)
    memo,     ///< verdict for a voxel, both verdicts returned
    precast,  ///< verdict for a voxel, only "blocked" returned
};
constexpr bool is_shadow(RayKind kind) { return kind >= RayKind::shadow; }

struct Ray {
    dvec3 position{0, 0, 0};  ///< fractions within the cell in x and y, z absolute; cell widths
    dvec3 direction{0, 0, 1};
    double inverse_x = 0;  ///< 1/direction.x, carried so that a hop needs no division; 0 if direction.x = 0
    double inverse_y = 0;
    double weight = 1;  ///< largest share of the pixel that its intensity can contribute
    double reach = std::numeric_limits<double>::infinity();  ///< distance left to the source (shadow rays)
    std::uint64_t id = 0;
    std::uint32_t leaves = no_polygon;  ///< polygon that it starts from and can't hit
    std::uint32_t slot = 0;    ///< where its answer belongs: the parent's slot, or the voxel (memo, precast)
    std::uint16_t home_x = 0;  ///< cell that sent it
    std::uint16_t home_y = 0;
    RayKind kind = RayKind::primary;
    std::uint8_t child = 0;       ///< which child of the slot; the source for shadow rays
    std::uint8_t generation = 0;  ///< 0: primary
    bool fresh = true;            ///< still in the cell that sent it
    bool leaves_front = false;    ///< it goes to the side of `leaves` that the plane's normal points to
    bool outside = false;         ///< left through the front or the back, on its way to the border
};

/// Sets direction and the reciprocals that go with it.
void set_direction(Ray& ray, const dvec3& direction, const Arithmetic& arithmetic);

/// Where the ray leaves the cell's column in x or y; t is infinite for an axial ray.
struct Crossing {
    double t = std::numeric_limits<double>::infinity();
    Side side = Side::east;
};
Crossing next_crossing(const Ray& ray, const Arithmetic& arithmetic);

/// Moves the ray over a crossing into the neighbouring cell's coordinates.
void cross(Ray& ray, const Crossing& crossing, const Arithmetic& arithmetic);

/// Moves the ray on by t, within its cell.
void move_along(Ray& ray, double t, const Arithmetic& arithmetic);

/// The distance at which a ray leaves the cube through the depth `bound`, its front or its back. A ray from a
/// polygon on the cube's face may start slightly outside: it leaves at once, not at a negative distance.
double way_out(const Ray& ray, double bound, const Arithmetic& arithmetic);

/// The point at distance t, x and y relative to the cell.
dvec3 point_at(const Ray& ray, double t, const Arithmetic& arithmetic);

/// The depth at distance t.
inline double depth_at(const Ray& ray, double t, const Arithmetic& arithmetic) {
    return arithmetic.mac(arithmetic.formats().depth, ray.position.z, t, ray.direction.z);
}

/// The next crossing of a ray that left through the front or the back: straight on; an axial ray goes east.
Crossing border_crossing(const Ray& ray, const Arithmetic& arithmetic);

}  // namespace raycell
