#include "model/loading/part.hpp"

#include <algorithm>

#include "model/loading/loading_words.hpp"

namespace raycell {
namespace {

/// Four corners of a rectangle, and one more for each line that cuts it; room for a second one, since a part
/// whose corners were cut off may be slightly concave.
constexpr int most_corners = 4 + 2 * (4 + 2);

template <typename Ops>
class Clipper {
  public:
    using N = typename Ops::Number;
    Clipper(const PartBounds& bounds, const Arithmetic& arithmetic)
        : ops_(arithmetic), bounds_(bounds), axes_(projection(bounds.drop)) {}

    Part run(const Box& box) {
        set_rectangle(box);
        for (int i = 0; i < bounds_.edge_count; ++i) {
            const EdgeFunction& edge = bounds_.edges[i];
            cut({ops_.number(edge.a), ops_.number(edge.b), ops_.number(edge.c) + ops_.room()});
        }
        const int drop = bounds_.drop;
        const Line<N> height = ops_.height(bounds_.plane, drop);
        // z has no bounds of its own where it is dropped: polygons are clipped to the cube.
        if (drop != 2) {
            cut({height.a, height.b, height.c - ops_.number(box.low[drop])});
            cut({-height.a, -height.b, ops_.number(box.high[drop]) - height.c});
        }
        return count_ < 3 ? Part() : part(height);
    }

  private:
    void set_rectangle(const Box& box) {
        const N u0 = ops_.number(box.low[axes_.u]);
        const N v0 = ops_.number(box.low[axes_.v]);
        const N u1 = ops_.number(box.high[axes_.u]);
        const N v1 = ops_.number(box.high[axes_.v]);
        corners_[0] = {u0, v0};
        corners_[1] = {u1, v0};
        corners_[2] = {u1, v1};
        corners_[3] = {u0, v1};
        count_ = 4;
    }

    /// Keeps what lies inside a line (Sutherland & Hodgman 1974). Sides are cut from their inner to their
    /// outer end.
    void cut(const Line<N>& line) {
        std::array<N, most_corners> at;
        bool inside = true;
        for (int i = 0; i < count_; ++i) {
            at[std::size_t(i)] = ops_.value(line, corners_[std::size_t(i)]);
            inside = inside && at[std::size_t(i)] >= 0;
        }
        if (inside) return;
        std::array<Corner<N>, most_corners> kept;
        int count = 0;
        for (int i = 0; i < count_; ++i) {
            const int j = i + 1 < count_ ? i + 1 : 0;
            const Corner<N>& p = corners_[std::size_t(i)];
            const Corner<N>& q = corners_[std::size_t(j)];
            const N dp = at[std::size_t(i)];
            const N dq = at[std::size_t(j)];
            if (dp >= 0) kept[std::size_t(count++)] = p;
            if ((dp >= 0) == (dq >= 0)) continue;
            if (dp > 0) kept[std::size_t(count++)] = between(p, q, dp, dq);
            if (dq > 0) kept[std::size_t(count++)] = between(q, p, dq, dp);
        }
        corners_ = kept;
        count_ = count < 3 ? 0 : count;
    }

    Corner<N> between(const Corner<N>& from, const Corner<N>& to, N d_from, N d_to) const {
        return {ops_.between(from.u, to.u, d_from, d_to), ops_.between(from.v, to.v, d_from, d_to)};
    }

    Part part(const Line<N>& height) const {
        Part part;
        part.corners = count_;
        const int drop = bounds_.drop;
        const Corner<N>& first = corners_[0];
        Corner<N> low = first;
        Corner<N> high = first;
        Corner<N> sum{0, 0};
        N least = ops_.value(height, first);
        N most = least;
        N twice_area = 0;
        for (int i = 0; i < count_; ++i) {
            const Corner<N>& p = corners_[std::size_t(i)];
            const Corner<N>& q = corners_[std::size_t(i + 1 < count_ ? i + 1 : 0)];
            low = {std::min(low.u, p.u), std::min(low.v, p.v)};
            high = {std::max(high.u, p.u), std::max(high.v, p.v)};
            sum = {sum.u + p.u, sum.v + p.v};
            const N at = ops_.value(height, p);
            least = std::min(least, at);
            most = std::max(most, at);
            twice_area +=
                ops_.product(p.u - first.u, q.v - first.v) - ops_.product(p.v - first.v, q.u - first.u);
        }
        const Corner<N> middle{ops_.share(sum.u, count_), ops_.share(sum.v, count_)};
        const auto set = [&](dvec3& point, const Corner<N>& uv, N third) {
            point[axes_.u] = ops_.back(uv.u);
            point[axes_.v] = ops_.back(uv.v);
            point[drop] = ops_.back(third);
        };
        set(part.low, low, least);
        set(part.high, high, most);
        set(part.middle, middle, ops_.value(height, middle));
        part.area = 0.5 * ops_.back(twice_area);
        return part;
    }

    Ops ops_;
    const PartBounds bounds_;
    Projection axes_;
    std::array<Corner<N>, most_corners> corners_;
    int count_ = 0;
};

}  // namespace

Part part_in(const PartBounds& bounds, const Box& box, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return Clipper<Doubles>(bounds, arithmetic).run(box);
    return Clipper<LoadingWords>(bounds, arithmetic).run(box);
}

}  // namespace raycell
