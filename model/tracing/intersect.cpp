#include "model/tracing/intersect.hpp"

#include <algorithm>
#include <cmath>

namespace raycell {
namespace {

/// Distance at which the ray enters the depths [near, far]; nothing if it does not between 0 and t_end.
std::optional<double> enter_run(const Ray& ray, double t_end, double near, double far,
                                const Arithmetic& arithmetic) {
    const double z0 = ray.position.z;
    const double dz = ray.direction.z;
    const double z1 = depth_at(ray, t_end, arithmetic);
    if (std::max(z0, z1) < near || std::min(z0, z1) > far) return std::nullopt;
    if (z0 >= near && z0 <= far) return 0.0;
    const double t = arithmetic.product(arithmetic.formats().distance, (dz > 0 ? near : far) - z0,
                                        arithmetic.reciprocal(dz));
    return std::clamp(t, 0.0, t_end);
}

/// Place in the projection, z relative to the voxel's base.
dvec2 place_of(const Voxel& voxel, const dvec3& point) {
    return project({point.x, point.y, point.z - voxel.base}, voxel.drop);
}

bool inside_pieces(const CellStore& store, const Voxel& voxel, const dvec3& point,
                   const Arithmetic& arithmetic) {
    if (voxel.pieces == 0) return true;
    const dvec2 uv = place_of(voxel, point);
    const Format& word = arithmetic.formats().edge_offset;
    const double outside = -arithmetic.hair();
    const EdgeFunction* edge = store.edges.data() + voxel.first_edge;
    const EdgeFunction* const end = edge + voxel.edge_count;
    while (edge != end) {
        const std::uint32_t piece = edge->piece;
        bool inside = true;
        for (; edge != end && edge->piece == piece; ++edge) {
            inside = inside && arithmetic.mac(word, edge->c, edge->a, uv.x, edge->b, uv.y) >= outside;
        }
        if (inside) return true;
    }
    return false;
}

/// `room`: tolerance of the point, in cells.
bool inside_mask(const Voxel& voxel, const dvec3& point, double room, const Arithmetic& arithmetic) {
    const Format& word = arithmetic.formats().field;
    dvec3 scaled = point;
    dvec3 rooms(room);
    if (voxel.drop != 2) {
        const double per_run = arithmetic.reciprocal(voxel.far - voxel.near);
        scaled.z = arithmetic.product(word, point.z - voxel.near, per_run);
        rooms.z = arithmetic.product(word, room, per_run);
    }
    const dvec2 uv = project(scaled, voxel.drop) * double(window_steps);
    const dvec2 room_uv = project(rooms, voxel.drop) * double(window_steps);
    const dvec2 low{voxel.window[0], voxel.window[2]};
    const dvec2 high{voxel.window[1], voxel.window[3]};
    const dvec2 size = high - low;
    int bit[2] = {0, 0};
    for (int axis = 0; axis < 2; ++axis) {
        const double per_window = arithmetic.reciprocal(size[axis]);
        const double place = arithmetic.product(word, uv[axis] - low[axis], per_window);
        // Tolerance, so that neighbouring masks leave no crack.
        const double rounding =
            arithmetic.exact() ? 1e-6 : arithmetic.product(word, room_uv[axis], per_window);
        if (place < -rounding || place > 1 + rounding) return false;
        bit[axis] = std::clamp(int(place * 8), 0, 7);
    }
    return voxel.mask >> (8 * bit[1] + bit[0]) & 1;
}

/// Distance at which the ray meets the voxel's plane, and how it meets it.
struct Meeting {
    double t;
    double along;  ///< plane normal · direction
    double room;   ///< tolerance of t
};
std::optional<Meeting> meet_plane(const Voxel& voxel, const Ray& ray, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    const dvec3& n = voxel.plane.n;
    const dvec3& p = ray.position;
    const dvec3& d = ray.direction;
    // Unrounded, from the accumulator: the reciprocal normalises it.
    const double along = arithmetic.dot(formats.accumulator, n, d);
    if (std::abs(along) < 1e-12) return std::nullopt;  // in the plane: it meets the polygon's neighbours
    const double off =
        arithmetic.mac(formats.depth, voxel.plane.c, -n.x, p.x, -n.y, p.y, -n.z, p.z - voxel.base);
    const double inverse = arithmetic.reciprocal(along);
    // A word's error in `off` grows in t for grazing rays: with a fixed tolerance, they could slip through at
    // a cell's border.
    constexpr double most_growth = 1024;
    const double growth = arithmetic.exact() ? 1 : std::clamp(std::abs(inverse), 1.0, most_growth);
    return Meeting{arithmetic.product(formats.distance, off, inverse), along, arithmetic.hair() * growth};
}

}  // namespace

std::optional<double> hit_voxel(const CellStore& store, const Voxel& voxel, const Ray& ray, double t_end,
                                HitTest test, const Arithmetic& arithmetic) {
    if (test == HitTest::depth) {
        // Compares levels, not depths: a run that the ray only touches at its end is another level.
        const double nearest = std::min(ray.position.z, depth_at(ray, t_end, arithmetic));
        if (nearest >= voxel.far) return std::nullopt;
    }
    if (test == HitTest::depth || test == HitTest::interval)
        return enter_run(ray, t_end, voxel.near, voxel.far, arithmetic);

    const auto meeting = meet_plane(voxel, ray, arithmetic);
    if (!meeting) return std::nullopt;
    const double t = meeting->t;
    // Only a ray that leaves a surface has to skip that surface's neighbours.
    const bool leaves = ray.fresh && ray.leaves != no_polygon;
    const double t_least = leaves ? arithmetic.least_fresh_distance() : -meeting->room;
    if (!(t >= t_least && t <= t_end + meeting->room)) return std::nullopt;
    // Without edges a polygon's plane continues over its neighbours. In its first cell, a ray that leaves one
    // side of a surface first meets the same side of the next part; a hit on the other side is such an
    // overrun.
    const bool overruns = test == HitTest::plane || test == HitTest::mask;
    if (overruns && leaves && ray.leaves_front == (meeting->along > 0)) {
        return std::nullopt;
    }
    const dvec3 point = point_at(ray, t, arithmetic);
    if (point.z < voxel.near - meeting->room || point.z > voxel.far + meeting->room) return std::nullopt;
    if (test == HitTest::mask && !inside_mask(voxel, point, meeting->room, arithmetic)) return std::nullopt;
    if (test == HitTest::edge && !inside_pieces(store, voxel, point, arithmetic)) return std::nullopt;
    return std::max(t, 0.0);
}

namespace {

/// Whether a hit replaces the kept one: of two within a tie, that of the lower polygon id stays.
bool precedes(double t, std::uint32_t polygon, double kept_t, std::uint32_t kept_polygon, double tie) {
    return polygon < kept_polygon ? t <= kept_t + tie : t < kept_t - tie;
}

/// Goes through the index table in the ray's direction and gives the voxels whose runs meet the ray's, up to
/// the first that can't, nor any after it.
class DepthSearch {
  public:
    DepthSearch(const Ray& ray, double t_end, const IndexTable& table, const Arithmetic& arithmetic,
                Comparisons* comparisons)
        : table_(table),
          comparisons_(comparisons),
          inwards_(!(ray.direction.z < 0)),
          next_(inwards_ ? 0 : table.count) {
        const double z1 = depth_at(ray, t_end, arithmetic);
        low_ = std::min(ray.position.z, z1) - arithmetic.hair();
        high_ = std::max(ray.position.z, z1) + arithmetic.hair();
    }

    /// Null if there is none.
    const IndexEntry* next() {
        while (inwards_ ? next_ < table_.count : next_ > 0) {
            const IndexEntry& line = table_.first[inwards_ ? next_++ : --next_];
            if (comparisons_) ++comparisons_->runs;
            if (inwards_ ? line.near > high_ : line.most < low_) return nullptr;
            if (line.far >= low_ && line.near <= high_) return &line;
        }
        return nullptr;
    }

    /// The nearest hit so far is at depth z: nothing beyond it counts, but what ties with it.
    void end_at(double z, double tie) {
        if (inwards_) {
            high_ = std::min(high_, z + tie);
        } else {
            low_ = std::max(low_, z - tie);
        }
    }

  private:
    const IndexTable& table_;
    Comparisons* comparisons_;
    bool inwards_;
    std::uint32_t next_;
    double low_, high_;
};

}  // namespace

std::optional<CellHit> nearest_in_cell(const CellStore& store, const Ray& ray, double t_end, HitTest test,
                                       const Arithmetic& arithmetic, Comparisons* comparisons,
                                       const IndexTable& index) {
    std::optional<CellHit> best;
    const IndexTable own{store.index.data(), std::uint32_t(store.index.size())};
    const IndexTable& table = index.first ? index : own;
    if (table.count == 0) return best;
    DepthSearch search(ray, t_end, table, arithmetic, comparisons);
    while (const IndexEntry* line = search.next()) {
        const Voxel& voxel = store.voxels[line->voxel];
        if (voxel.polygon == ray.leaves) continue;
        if (comparisons) {
            ++comparisons->tests;
            comparisons->edges += voxel.edge_count;
        }
        const auto t = hit_voxel(store, voxel, ray, t_end, test, arithmetic);
        if (!t) continue;
        const bool tied = best && std::abs(*t - best->t) <= arithmetic.tie();
        if (!best ||
            precedes(*t, voxel.polygon, best->t, store.voxels[best->voxel].polygon, arithmetic.tie())) {
            best = CellHit{*t, line->voxel};
            search.end_at(depth_at(ray, *t, arithmetic), arithmetic.tie());
        }
        best->tied = best->tied || tied;
    }
    return best;
}

}  // namespace raycell
