// Trapezes tile the polygon that they were cut from.
#include "model/loading/trapeze.hpp"

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

bool inside(const Trapeze& t, const dvec2& uv) {
    for (int i = 0; i < t.edge_count; ++i) {
        if (t.edges[std::size_t(i)].at(uv) < 0) return false;
    }
    return true;
}

/// A place outside the array counts as its border.
void expect_within(double place, const Stretch& cells) {
    EXPECT_GE(std::clamp(place, 0.0, double(most_cells)), cells.first - 1e-6);
    EXPECT_LE(std::clamp(place, 0.0, double(most_cells)), cells.last + 1 + 1e-6);
}

/// Every point of the polygon's plane lies in a trapeze exactly if it lies in the polygon, and the areas add
/// up.
void expect_tiled(const Polygon& polygon, Random& random) {
    const std::vector<Trapeze> trapezes = precompute(polygon, exact_arithmetic());
    double area = 0;
    dvec2 low(1e300), high(-1e300);
    const auto outline = shapes::projected(polygon.vertices, polygon.drop);
    for (const dvec2& p : outline) low = glm::min(low, p), high = glm::max(high, p);
    for (const Trapeze& t : trapezes) {
        ASSERT_GE(t.corner_count, 3);
        ASSERT_LE(t.corner_count, 4);
        EXPECT_EQ(t.polygon, polygon.id);
        EXPECT_EQ(t.object, polygon.object);
        EXPECT_EQ(t.drop, polygon.drop);
        EXPECT_LE(t.rows.first, t.rows.last);
        EXPECT_LE(t.rows.last, t.last_row);
        EXPECT_LE(t.columns.first, t.columns.last);
        std::vector<dvec3> corners(t.corners.begin(), t.corners.begin() + t.corner_count);
        area += shapes::area_of(corners);
        for (const dvec3& p : corners) {
            EXPECT_NEAR(glm::dot(t.plane.n, p), t.plane.c, 1e-9);
            expect_within(p.y, t.rows);
            expect_within(p.x, t.columns);
            // Every corner lies on or inside every edge.
            for (int i = 0; i < t.edge_count; ++i)
                EXPECT_GT(t.edges[std::size_t(i)].at(project(p, t.drop)), -1e-8);
        }
    }
    EXPECT_NEAR(area, shapes::area_of(polygon.vertices),
                1e-7 * std::max(1.0, shapes::area_of(polygon.vertices)));
    for (int i = 0; i < 200; ++i) {
        const dvec2 margin = 0.1 * (high - low);
        const dvec2 p{random.uniform(low.x - margin.x, high.x + margin.x),
                      random.uniform(low.y - margin.y, high.y + margin.y)};
        const shapes::Place place = shapes::place_of(outline, p);
        if (place.distance < 1e-6) continue;
        int holders = 0;
        for (const Trapeze& t : trapezes) holders += inside(t, p);
        // At most two trapezes share a point: on the cut between them.
        if (place.inside) {
            EXPECT_GE(holders, 1) << "inside at " << p.x << ", " << p.y;
            EXPECT_LE(holders, 2);
        } else {
            EXPECT_EQ(holders, 0) << "outside at " << p.x << ", " << p.y;
        }
    }
}

TEST(Trapezes, TileAnyPolygonInAnyAttitude) {
    for (const std::uint64_t seed : property::seeds(1, 600)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes = shapes::attitude(random, int(seed % 6));
        const int corners = random.chance(0.2) ? 150 : random.whole(3, 40);
        const auto outline = shapes::star(random, corners, std::pow(10, random.uniform(-1, 1.3)));
        expect_tiled(make_polygon(3, 4, shapes::lift(outline, axes, {20, 20, 25})), random);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(Trapezes, TileCombsWhoseCornersLineUpInRows) {
    for (const std::uint64_t seed : property::seeds(2000, 120)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        shapes::Axes axes = shapes::attitude(random, int(seed % 6));
        if (random.chance(0.5)) {  // along the axes exactly
            const dvec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            const int first = random.whole(0, 2);
            const int second = (first + random.whole(1, 2)) % 3;
            axes = {unit[first], (random.chance(0.5) ? 1.0 : -1.0) * unit[second],
                    glm::cross(unit[first], unit[second])};
        }
        expect_tiled(
            make_polygon(3, 4, shapes::lift(shapes::comb(random.whole(2, 30), 7.5), axes, {16, 16, 16})),
            random);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(Trapezes, OfAPolygonWithItsVerticesTurnedRoundCoverTheSame) {
    for (const std::uint64_t seed : property::seeds(3000, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        auto outline = shapes::lift(shapes::star(random, 12, 8), shapes::turned(random), dvec3(10));
        const std::size_t count = precompute(make_polygon(0, 0, outline), exact_arithmetic()).size();
        std::rotate(outline.begin(), outline.begin() + random.whole(1, 11), outline.end());
        EXPECT_EQ(precompute(make_polygon(0, 0, outline), exact_arithmetic()).size(), count);
    }
}

TEST(Trapezes, ARectangleIsOneAndATriangleAtMostTwo) {
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 1, 5}, {4, 3, 6}, {1, 3, 6}}), exact_arithmetic())
                  .size(),
              1u);
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 2, 5}, {2, 4, 6}}), exact_arithmetic()).size(),
              2u);
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {4, 1, 5}, {2, 4, 6}}), exact_arithmetic()).size(),
              1u);
    // Corners on straight sides cost cuts but no area.
    EXPECT_EQ(precompute(make_polygon(0, 0, {{1, 1, 5}, {2, 1, 5}, {4, 1, 5}, {4, 3, 5}, {1, 3, 5}}),
                         exact_arithmetic())
                  .size(),
              1u);
}

/// A plain cutter that returns only corners: for every slab between two vertices it tests all sides.
class PlainCutter {
  public:
    using Corners = std::vector<dvec3>;
    static std::vector<Corners> cut(const Polygon& polygon) {
        PlainCutter cutter(polygon.vertices, sweep_axis(polygon.vertices));
        cutter.along_ =
            glm::cross(polygon.plane.n, dvec3(cutter.axis_ == 0, cutter.axis_ == 1, cutter.axis_ == 2));
        cutter.run();
        return cutter.trapezes_;
    }

  private:
    struct Side {
        dvec3 a;
        dvec3 b;
        bool operator==(const Side& o) const { return a == o.a && b == o.b; }
    };
    struct Open {
        Side left;
        Side right;
        double s0;
        double s1;
    };
    PlainCutter(const std::vector<dvec3>& outline, int axis) : v_(outline), axis_(axis) {}

    static int sweep_axis(const std::vector<dvec3>& outline) {
        dvec3 low = outline.front();
        dvec3 high = outline.front();
        for (const dvec3& p : outline) low = glm::min(low, p), high = glm::max(high, p);
        const dvec3 extent = high - low;
        if (extent.y >= 1.0 / 64) return 1;
        if (extent.z >= extent.y && extent.z >= extent.x) return 2;
        return extent.y >= extent.x ? 1 : 0;
    }
    dvec3 point_at(const Side& side, double s) const {
        const bool forward = side.a[axis_] < side.b[axis_];
        const dvec3& from = forward ? side.a : side.b;
        const dvec3& to = forward ? side.b : side.a;
        if (s == from[axis_]) return from;
        if (s == to[axis_]) return to;
        dvec3 p = from + (to - from) * ((s - from[axis_]) / (to[axis_] - from[axis_]));
        p[axis_] = s;
        return p;
    }
    void run() {
        std::vector<double> levels;
        for (const dvec3& p : v_) levels.push_back(p[axis_]);
        std::sort(levels.begin(), levels.end());
        double s0 = levels.front();
        for (const double s1 : levels) {
            if (s1 - s0 < 1e-10) continue;
            slab(s0, s1);
            s0 = s1;
        }
        for (const Open& open : open_) close(open);
    }
    void slab(double s0, double s1) {
        std::vector<std::pair<double, Side>> crossings;
        const double middle = 0.5 * (s0 + s1);
        for (std::size_t i = 0; i < v_.size(); ++i) {
            const Side side{v_[i], v_[(i + 1) % v_.size()]};
            if ((side.a[axis_] <= middle) == (side.b[axis_] <= middle)) continue;
            crossings.emplace_back(glm::dot(along_, point_at(side, middle)), side);
        }
        std::stable_sort(crossings.begin(), crossings.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<Open> next;
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
            if (!(crossings[i + 1].first > crossings[i].first)) continue;
            Open open{crossings[i].second, crossings[i + 1].second, s0, s1};
            const auto before = std::find_if(open_.begin(), open_.end(), [&](const Open& o) {
                return o.left == open.left && o.right == open.right;
            });
            if (before != open_.end()) {
                open.s0 = before->s0;
                open_.erase(before);
            }
            next.push_back(open);
        }
        for (const Open& open : open_) close(open);
        open_ = next;
    }
    void close(const Open& open) {
        Corners corners;
        for (const dvec3& p : {point_at(open.left, open.s0), point_at(open.right, open.s0),
                               point_at(open.right, open.s1), point_at(open.left, open.s1)}) {
            if (corners.empty() || p != corners.back()) corners.push_back(p);
        }
        if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
        if (corners.size() >= 3) trapezes_.push_back(corners);
    }

    const std::vector<dvec3>& v_;
    int axis_;
    dvec3 along_{0, 0, 0};
    std::vector<Open> open_;
    std::vector<Corners> trapezes_;
};

/// Stars, combs, and outlines that cross, touch or repeat themselves.
std::vector<dvec2> any_outline(Random& random) {
    switch (random.whole(0, 3)) {
        case 0:
            return shapes::star(random, random.whole(3, 150), std::pow(10, random.uniform(-1, 1.3)));
        case 1:
            return shapes::comb(random.whole(2, 30), 7.5);
        default: {
            const bool grid = random.chance(0.5);
            std::vector<dvec2> outline(std::size_t(random.whole(3, 60)));
            for (dvec2& p : outline) {
                p = {random.uniform(-5, 5), random.uniform(-5, 5)};
                if (grid) p = glm::round(p);
            }
            return outline;
        }
    }
}

TEST(Trapezes, AreThoseOfThePlainSweepBitForBitAndInItsOrder) {
    for (const std::uint64_t seed : property::seeds(5000, 1500)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const shapes::Axes axes =
            random.chance(0.2) ? shapes::Axes() : shapes::attitude(random, int(seed % 6));
        auto outline = shapes::lift(any_outline(random), axes, {20, 20, 25});
        if (random.chance(0.4)) {  // clipping leaves bridges between parts
            const double right = random.uniform(18, 26);
            outline = clip_to_box(outline, {{16, 17, 22}, {right, random.uniform(18, 26), 28}});
        }
        if (outline.size() < 3 || !(glm::length(newell(outline)) > 0)) continue;
        const Polygon polygon = make_polygon(1, 2, outline);
        const auto plain = PlainCutter::cut(polygon);
        const auto trapezes = precompute(polygon, exact_arithmetic());
        ASSERT_EQ(trapezes.size(), plain.size());
        for (std::size_t i = 0; i < plain.size(); ++i) {
            ASSERT_EQ(std::size_t(trapezes[i].corner_count), plain[i].size());
            for (std::size_t k = 0; k < plain[i].size(); ++k) ASSERT_EQ(trapezes[i].corners[k], plain[i][k]);
        }
    }
}

}  // namespace
}  // namespace raycell
