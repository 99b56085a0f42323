#include "model/intersect.hpp"

#include <algorithm>
#include <cmath>

#include "model/arithmetic.hpp"

namespace raycell {
namespace {

/// A fresh ray that meets a neighbour of its polygon nearer than this met it at their shared edge.
constexpr double least_fresh_distance = 1e-9;

/// Where the ray enters the depths [near, far], or nothing if it doesn't between 0 and t_end.
std::optional<double> enter_run(const Ray& ray, double t_end, double near, double far) {
    const double z0 = ray.position.z;
    const double dz = ray.direction.z;
    const double z1 = z0 + t_end * dz;
    if (std::max(z0, z1) < near || std::min(z0, z1) > far) return std::nullopt;
    if (z0 >= near && z0 <= far) return 0.0;
    const double t = ((dz > 0 ? near : far) - z0) * arith::reciprocal(dz);
    return std::clamp(t, 0.0, t_end);
}

bool inside_pieces(const CellStore& store, const Voxel& voxel, const dvec2& uv) {
    if (voxel.pieces == 0) return true;
    const EdgeFunction* edge = store.edges.data() + voxel.first_edge;
    const EdgeFunction* const end = edge + voxel.edge_count;
    while (edge != end) {
        const std::uint32_t piece = edge->piece;
        bool inside = true;
        for (; edge != end && edge->piece == piece; ++edge) inside = inside && edge->at(uv) >= -hair;
        if (inside) return true;
    }
    return false;
}

bool inside_mask(const Voxel& voxel, const dvec3& point, double level) {
    const double near = voxel.near_level * level;
    const double height = (voxel.far_level - voxel.near_level) * level;
    const dvec3 scaled{point.x, point.y, (point.z - near) * arith::reciprocal(height)};
    const dvec2 uv = project(scaled, voxel.drop) * double(window_steps);
    const dvec2 low{voxel.window[0], voxel.window[2]};
    const dvec2 high{voxel.window[1], voxel.window[3]};
    const dvec2 size = high - low;
    const dvec2 place = (uv - low) * dvec2(arith::reciprocal(size.x), arith::reciprocal(size.y));
    constexpr double rounding = 1e-6;  // of the window: the neighbour's mask must not leave a crack
    if (glm::any(glm::lessThan(place, dvec2(-rounding))) ||
        glm::any(glm::greaterThan(place, dvec2(1 + rounding)))) {
        return false;
    }
    const int column = std::clamp(int(place.x * 8), 0, 7);
    const int row = std::clamp(int(place.y * 8), 0, 7);
    return voxel.mask >> (8 * row + column) & 1;
}

}  // namespace

std::optional<double> hit_voxel(const CellStore& store, const Voxel& voxel, const Ray& ray, double t_end,
                                HitTest test, double level) {
    const double near = voxel.near_level * level;
    const double far = voxel.far_level * level;
    if (test == HitTest::depth) {
        // Levels, not depths, are compared: a run touched from outside at its border is another level.
        const auto t = enter_run(ray, t_end, near, far);
        if (!t) return t;
        const double z1 = ray.position.z + t_end * ray.direction.z;
        const double low = std::floor(std::min(ray.position.z, z1) / level);
        const double high = std::floor(std::max(ray.position.z, z1) / level);
        if (voxel.near_level < low || voxel.near_level > high) return std::nullopt;
        return t;
    }
    if (test == HitTest::interval) return enter_run(ray, t_end, near, far);

    const double along = arith::dot(voxel.plane.n, ray.direction);
    if (std::abs(along) < 1e-12) return std::nullopt;  // in the plane: it meets the polygon's neighbours
    const double t = (voxel.plane.c - arith::dot(voxel.plane.n, ray.position)) * arith::reciprocal(along);
    const double t_least = ray.fresh ? least_fresh_distance : -hair;
    if (!(t >= t_least && t <= t_end + hair)) return std::nullopt;
    // Without edges a polygon's plane runs on over its neighbours. A ray that leaves one side of a surface
    // first meets that same side of its next part: in its first cell, the other side is such an overrun.
    const bool overruns = test == HitTest::plane || test == HitTest::mask;
    if (overruns && ray.fresh && ray.leaves != no_polygon && ray.leaves_front == (along > 0)) {
        return std::nullopt;
    }
    const dvec3 point = ray.position + t * ray.direction;
    if (point.z < near - hair || point.z > far + hair) return std::nullopt;
    if (test == HitTest::mask && !inside_mask(voxel, point, level)) return std::nullopt;
    if (test == HitTest::edge && !inside_pieces(store, voxel, project(point, voxel.drop)))
        return std::nullopt;
    return std::max(t, 0.0);
}

std::optional<CellHit> nearest_in_cell(const CellStore& store, const Ray& ray, double t_end, HitTest test,
                                       double level, Comparisons* comparisons) {
    std::optional<CellHit> best;
    const double z1 = ray.position.z + t_end * ray.direction.z;
    const double z_low = std::min(ray.position.z, z1) - hair;
    const double z_high = std::max(ray.position.z, z1) + hair;
    if (comparisons) comparisons->runs += std::uint32_t(store.voxels.size());
    for (std::uint32_t i = 0; i < store.voxels.size(); ++i) {
        const Voxel& voxel = store.voxels[i];
        if (voxel.near_level * level > z_high || voxel.far_level * level < z_low) continue;
        if (voxel.polygon == ray.leaves) continue;
        if (comparisons) {
            ++comparisons->tests;
            comparisons->edges += voxel.edge_count;
        }
        const auto t = hit_voxel(store, voxel, ray, t_end, test, level);
        if (!t) continue;
        if (!best || *t < best->t || (*t == best->t && voxel.polygon < store.voxels[best->voxel].polygon)) {
            best = CellHit{*t, i};
        }
    }
    return best;
}

}  // namespace raycell
