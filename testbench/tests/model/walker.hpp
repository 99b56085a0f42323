// Sends one ray through a loaded array as the untimed machine does.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "model/loading/loading.hpp"
#include "model/tracing/tracing.hpp"
#include "shapes.hpp"

namespace raycell::walker {

struct Found {
    double t = 0;  ///< from the ray's origin
    std::uint32_t polygon = no_polygon;
    std::uint32_t voxel = 0;
    int x = 0;  ///< the cell
    int y = 0;
    Ray ray;  ///< as it was in that cell
    CellHit hit;
};

/// A ray from a point inside the cube, in array coordinates; sets `x` and `y` to its cell. In fixed
/// arithmetic, place and direction are rounded to words.
inline Ray ray_at(const Context& context, const dvec3& origin, const dvec3& direction, int& x, int& y) {
    const Arithmetic& arithmetic = context.arithmetic;
    x = std::min(std::max(int(std::floor(origin.x)), 0), context.scene.frame.width - 1);
    y = std::min(std::max(int(std::floor(origin.y)), 0), context.scene.frame.height - 1);
    Ray ray;
    ray.position = {arithmetic.hold(arithmetic.formats().unit, origin.x - x),
                    arithmetic.hold(arithmetic.formats().unit, origin.y - y),
                    arithmetic.hold(arithmetic.formats().depth, origin.z)};
    ray.fresh = false;
    set_direction(ray, arithmetic.exact() ? direction : arithmetic.normalise(direction), arithmetic);
    return ray;
}

/// A ray of any direction from any point inside the cube; sets `x` and `y` to its cell.
inline Ray any_ray(const Context& context, property::Random& random, int& x, int& y) {
    const dvec3 share{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    return ray_at(context, share * context.scene.frame.cube().high, shapes::sloped_direction(random), x, y);
}

/// The first hit, or nothing if the ray leaves the cube. Throws std::logic_error if it never leaves the
/// array.
inline std::optional<Found> walk(const std::vector<CellStore>& cells, const Context& context, Ray ray, int x,
                                 int y) {
    const Frame& frame = context.scene.frame;
    double travelled = 0;
    for (int hops = 0; hops <= 2 * (frame.width + frame.height) + 4; ++hops) {
        const CellStore& store = cells[std::size_t(y) * std::size_t(frame.width) + std::size_t(x)];
        const Visit visit = visit_cell(store, ray, context);
        if (visit.event == Visit::Event::hit) {
            return Found{travelled + visit.hit.t,
                         store.voxels[visit.hit.voxel].polygon,
                         visit.hit.voxel,
                         x,
                         y,
                         ray,
                         visit.hit};
        }
        if (visit.event != Visit::Event::forward) return std::nullopt;
        travelled += visit.crossing.t;
        x += step_x(visit.crossing.side);
        y += step_y(visit.crossing.side);
        if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) return std::nullopt;
        cross(ray, visit.crossing, context.arithmetic);
    }
    throw std::logic_error("a ray never leaves the array");
}

/// Distance along a direction from a point inside the cube to its border.
inline double way_out(const CellScene& scene, const dvec3& origin, const dvec3& direction) {
    const Box cube = scene.frame.cube();
    double t = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] > 0) t = std::min(t, (cube.high[axis] - origin[axis]) / direction[axis]);
        if (direction[axis] < 0) t = std::min(t, (cube.low[axis] - origin[axis]) / direction[axis]);
    }
    return t;
}

}  // namespace raycell::walker
