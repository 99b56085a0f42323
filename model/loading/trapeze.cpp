#include "model/loading/trapeze.hpp"

#include <algorithm>
#include <cmath>

#include "model/numbers/tolerance.hpp"

namespace raycell {
namespace {

/// Below this height in y (cells) a polygon is cut along another axis.
constexpr double least_sweep_height = 1.0 / 64;
/// Thinner slabs are skipped: the tolerance of the edges covers them.
constexpr double least_slab = 1e-10;

int sweep_axis(const std::vector<dvec3>& outline) {
    dvec3 low = outline.front();
    dvec3 high = outline.front();
    for (const dvec3& p : outline) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const dvec3 extent = high - low;
    if (extent.y >= least_sweep_height) return 1;
    if (extent.z >= extent.y && extent.z >= extent.x) return 2;
    return extent.y >= extent.x ? 1 : 0;
}

struct Side {
    dvec3 a;
    dvec3 b;
};

dvec3 point_at(const Side& side, int axis, double s) {
    // Always from the same end, so that both neighbours of a side get the same point.
    const bool forward = side.a[axis] < side.b[axis];
    const dvec3& from = forward ? side.a : side.b;
    const dvec3& to = forward ? side.b : side.a;
    if (s == from[axis]) return from;
    if (s == to[axis]) return to;
    dvec3 p = from + (to - from) * ((s - from[axis]) / (to[axis] - from[axis]));
    p[axis] = s;
    return p;
}

/// Cuts a polygon into trapezes by a sweep that looks only at the sides that cross the current slab.
class Cutter {
  public:
    /// `shared`: distance from a cell's border, in cells, within which a point belongs to both cells.
    Cutter(const Polygon& polygon, double shared)
        : polygon_(polygon), shared_(shared), axis_(sweep_axis(polygon.vertices)) {
        dvec3 unit{0, 0, 0};
        unit[axis_] = 1;
        along_ = glm::cross(polygon.plane.n, unit);
    }

    std::vector<Trapeze> run() {
        const auto& v = polygon_.vertices;
        std::vector<double> levels;
        std::vector<std::uint32_t> starts;  // sides, sorted by their beginnings
        for (std::uint32_t i = 0; i < v.size(); ++i) {
            levels.push_back(v[i][axis_]);
            starts.push_back(i);
            runs_.push_back(run_of(side(i)));
        }
        std::sort(levels.begin(), levels.end());
        std::sort(starts.begin(), starts.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return runs_[a].begin < runs_[b].begin; });
        opened_by_.assign(v.size(), 0);
        auto start = starts.cbegin();
        double s0 = levels.front();
        for (const double s1 : levels) {
            if (s1 - s0 < least_slab) continue;
            const double middle = 0.5 * (s0 + s1);
            const auto ended = [&](const Crossing& c) { return runs_[c.side].end <= middle; };
            crossings_.erase(std::remove_if(crossings_.begin(), crossings_.end(), ended), crossings_.end());
            const auto running = std::ptrdiff_t(crossings_.size());
            for (; start != starts.cend() && runs_[*start].begin <= middle; ++start) {
                if (runs_[*start].end > middle) crossings_.push_back({0, *start});
            }
            order_crossings(running, middle);
            slab(s0);
            s0 = s1;
        }
        for (const Open& open : open_) close(open, s0);
        return std::move(trapezes_);
    }

  private:
    struct Crossing {  // of a side and the middle of a slab
        double place;
        std::uint32_t side;  ///< index of its first vertex
        bool operator<(const Crossing& o) const {
            return place < o.place || (place == o.place && side < o.side);
        }
    };
    struct Run {  // of a side along the sweep
        double begin;
        double end;
        double u;   ///< place at the beginning
        double du;  ///< change from the beginning to the end
        double v;
        double dv;
    };
    struct Open {  // a trapeze whose two sides may continue in the next slab
        std::uint32_t left;
        std::uint32_t right;
        double s0;
        bool runs_on = false;
    };

    Side side(std::uint32_t i) const {
        const auto& v = polygon_.vertices;
        return {v[i], v[i + 1 < v.size() ? i + 1 : 0]};
    }
    /// The values that point_at needs of a side, in the two axes other than the sweep's.
    Run run_of(const Side& side) const {
        const bool forward = side.a[axis_] < side.b[axis_];
        const dvec3& from = forward ? side.a : side.b;
        const dvec3& to = forward ? side.b : side.a;
        const int u = axis_ == 0 ? 1 : 0;
        const int v = axis_ == 2 ? 1 : 2;
        return {from[axis_], to[axis_], from[u], to[u] - from[u], from[v], to[v] - from[v]};
    }

    /// Sorts the crossings. The first `running` ones are still in the order of the previous slab, which is
    /// right unless sides cross.
    void order_crossings(std::ptrdiff_t running, double middle) {
        const double along_u = axis_ == 0 ? along_.y : along_.x;
        const double along_v = axis_ == 2 ? along_.y : along_.z;
        for (Crossing& c : crossings_) {
            const Run& run = runs_[c.side];
            const double share = (middle - run.begin) / (run.end - run.begin);
            c.place = along_u * (run.u + run.du * share) + along_v * (run.v + run.dv * share);
        }
        const auto fresh = crossings_.begin() + running;
        if (!std::is_sorted(crossings_.begin(), fresh)) std::sort(crossings_.begin(), fresh);
        std::sort(fresh, crossings_.end());
        std::inplace_merge(crossings_.begin(), fresh, crossings_.end());
    }

    /// Makes the trapezes of the slab that begins at s0. A trapeze with the same two sides as one of the
    /// previous slab continues it.
    void slab(double s0) {
        next_.clear();
        for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2) {
            const Crossing& left = crossings_[i];
            const Crossing& right = crossings_[i + 1];
            if (!(right.place > left.place)) continue;  // a bridge left by clipping
            Open open{left.side, right.side, s0};
            const std::size_t before = opened_by_[left.side];
            if (before < open_.size() && open_[before].left == left.side &&
                open_[before].right == right.side) {
                open.s0 = open_[before].s0;
                open_[before].runs_on = true;
            }
            opened_by_[left.side] = next_.size();
            next_.push_back(open);
        }
        for (const Open& open : open_) {
            if (!open.runs_on) close(open, s0);
        }
        open_.swap(next_);
    }

    void close(const Open& open, double s1) {
        const Side left = side(open.left);
        const Side right = side(open.right);
        Trapeze t;
        t.polygon = polygon_.id;
        t.object = polygon_.object;
        t.plane = polygon_.plane;
        t.drop = polygon_.drop;
        t.normal = polygon_.normal;
        t.slack = dvec3(shared_);
        t.slack[t.drop] += polygon_.slack;
        const dvec3 ring[] = {point_at(left, axis_, open.s0), point_at(right, axis_, open.s0),
                              point_at(right, axis_, s1), point_at(left, axis_, s1)};
        dvec3 centre{0, 0, 0};
        for (const dvec3& p : ring) centre += 0.25 * p;
        for (const dvec3& p : ring) {
            if (t.corner_count == 0 || p != t.corners[std::size_t(t.corner_count - 1)]) {
                t.corners[std::size_t(t.corner_count++)] = p;
            }
        }
        if (t.corner_count > 1 && t.corners[0] == t.corners[std::size_t(t.corner_count - 1)])
            --t.corner_count;
        if (t.corner_count < 3) return;
        const dvec2 inside = project(centre, t.drop);
        side_edge(t, left, inside);
        side_edge(t, right, inside);
        cut_edge(t, open.s0, 1);
        cut_edge(t, s1, -1);
        // Hit points lie on the plane. The outline may lie a little off it, and the neighbour's plane may be
        // off the other way: twice the slack.
        for (int i = 0; i < t.edge_count; ++i) t.edges[std::size_t(i)].c += 2 * polygon_.slack;
        trapezes_.push_back(t);
    }

    static void side_edge(Trapeze& t, const Side& side, const dvec2& inside) {
        const dvec2 a = project(side.a, t.drop);
        const dvec2 along = project(side.b, t.drop) - a;
        const double length = glm::length(along);
        if (!(length > 0)) return;
        EdgeFunction edge{-along.y / length, along.x / length, 0, 0};
        edge.c = -(edge.a * a.x + edge.b * a.y);
        if (edge.at(inside) < 0) edge = {-edge.a, -edge.b, -edge.c, 0};
        t.edges[std::size_t(t.edge_count++)] = edge;
    }

    /// Adds the edge at sweep position s as a function of (u, v): inside where sign·(p[axis] − s) >= 0.
    void cut_edge(Trapeze& t, double s, double sign) const {
        const Projection axes = projection(t.drop);
        EdgeFunction edge;
        if (axis_ == axes.u) {
            edge = {sign, 0, -sign * s, 0};
        } else if (axis_ == axes.v) {
            edge = {0, sign, -sign * s, 0};
        } else {  // the sweep's axis is dropped: on the plane it is a function of (u, v)
            const dvec3& n = t.plane.n;
            const double slope = std::hypot(n[axes.u], n[axes.v]);
            if (!(slope > 0)) return;
            const double facing = sign * (n[t.drop] > 0 ? 1 : -1) / slope;
            edge = {-facing * n[axes.u], -facing * n[axes.v], facing * (t.plane.c - n[t.drop] * s), 0};
        }
        t.edges[std::size_t(t.edge_count++)] = edge;
    }

    const Polygon& polygon_;
    double shared_;
    int axis_;
    dvec3 along_;
    std::vector<Run> runs_;            ///< per side
    std::vector<Crossing> crossings_;  ///< of the current slab, from left to right
    std::vector<Open> open_;
    std::vector<Open> next_;
    std::vector<std::size_t> opened_by_;  ///< per side: index in `open_` of the trapeze whose left side it is
    std::vector<Trapeze> trapezes_;
};

/// Sets the rows and columns that the trapezes touch.
void set_cells(std::vector<Trapeze>& trapezes, int width, int height) {
    int last_row = 0;
    for (Trapeze& t : trapezes) {
        dvec3 low = t.corners[0];
        dvec3 high = t.corners[0];
        for (int i = 1; i < t.corner_count; ++i) {
            low = glm::min(low, t.corners[std::size_t(i)]);
            high = glm::max(high, t.corners[std::size_t(i)]);
        }
        low -= t.slack;
        high += t.slack;
        t.rows.first = std::clamp(int(std::floor(low.y)), 0, height - 1);
        t.rows.last = std::clamp(int(std::ceil(high.y)) - 1, t.rows.first, height - 1);
        t.columns.first = std::clamp(int(std::floor(low.x)), 0, width - 1);
        t.columns.last = std::clamp(int(std::floor(high.x)), t.columns.first, width - 1);
        last_row = std::max(last_row, t.rows.last);
    }
    for (Trapeze& t : trapezes) t.last_row = last_row;
}

}  // namespace

EdgeFunction hold_edge(const EdgeFunction& edge, const dvec2& anchor, const Format& slope,
                       const Format& offset) {
    const dvec2 on_edge = anchor - edge.at(anchor) * dvec2(edge.a, edge.b);
    EdgeFunction held{slope.hold(edge.a), slope.hold(edge.b), 0, edge.piece};
    held.c = offset.hold(-(held.a * on_edge.x + held.b * on_edge.y));
    return held;
}

std::vector<Trapeze> precompute(const Polygon& polygon, const Arithmetic& arithmetic, int width, int height) {
    // Both cells at a border get what lies near it, so that one cell, whichever it is, compares all surfaces
    // that a ray meets at the same distance on the border.
    std::vector<Trapeze> trapezes = Cutter(polygon, arithmetic.exact() ? 2 * exact_hair : 0).run();
    if (arithmetic.exact()) {
        set_cells(trapezes, width, height);
        return trapezes;
    }
    const Format& word = arithmetic.formats().loading;
    for (Trapeze& t : trapezes) {
        dvec3 centre{0, 0, 0};
        for (int i = 0; i < t.corner_count; ++i) {
            dvec3& corner = t.corners[std::size_t(i)];
            corner = arithmetic.hold(word, corner);
            centre += corner / double(t.corner_count);
        }
        for (int i = 0; i < t.edge_count; ++i) {
            EdgeFunction& edge = t.edges[std::size_t(i)];
            edge = hold_edge(edge, project(centre, t.drop), word, word);
        }
    }
    set_cells(trapezes, width, height);
    return trapezes;
}

}  // namespace raycell
