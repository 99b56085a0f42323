// The top rung of the ladder is exact: `edge` finds what a search through all polygons finds.
#include <algorithm>
#include <set>

#include "shapes.hpp"
#include "walker.hpp"

namespace raycell {
namespace {

using property::Random;

struct Exact {
    double t = 1e300;
    std::uint32_t polygon = no_polygon;
    bool doubtful =
        false;  ///< passes an edge too closely, or runs along a plane, for two computations to agree
};

Exact search(const CellScene& scene, const dvec3& origin, const dvec3& direction) {
    Exact exact;
    double second = 1e300;
    for (const Polygon& polygon : scene.polygons) {
        const dvec3& n = polygon.plane.n;
        const double along = glm::dot(n, direction);
        if (std::abs(along) < 1e-7) {
            exact.doubtful = exact.doubtful || std::abs(glm::dot(n, origin) - polygon.plane.c) < 1e-5;
            continue;
        }
        const double t = (polygon.plane.c - glm::dot(n, origin)) / along;
        if (t < -1e-6) continue;
        const auto place = shapes::place_of(shapes::projected(polygon.vertices, polygon.drop),
                                            project(origin + t * direction, polygon.drop));
        if (place.distance < 1e-5 || std::abs(t) < 1e-5) exact.doubtful = true;
        if (!place.inside) continue;
        if (t < exact.t) {
            second = exact.t;
            exact.t = t;
            exact.polygon = polygon.id;
        } else {
            second = std::min(second, t);
        }
    }
    if (exact.polygon != no_polygon && second - exact.t < 1e-6) exact.doubtful = true;
    return exact;
}

void expect_exact(const CellScene& scene, Random& random, int rays) {
    const PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::exact);
    const Context context(scene, settings);
    const auto cells = load_array(scene, settings, context.arithmetic);
    int doubtful = 0;
    for (int i = 0; i < rays; ++i) {
        const dvec3 share{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
        const dvec3 origin = share * scene.frame.cube().high;
        const dvec3 direction = shapes::sloped_direction(random);
        const Exact exact = search(scene, origin, direction);
        if (exact.doubtful) {
            ++doubtful;
            continue;
        }
        int x = 0;
        int y = 0;
        const Ray ray = walker::ray_at(context, origin, direction, x, y);
        const auto found = walker::walk(cells, context, ray, x, y);
        std::ostringstream text;
        text.precision(17);
        text << "ray from (" << origin.x << ", " << origin.y << ", " << origin.z << ") along (" << direction.x
             << ", " << direction.y << ", " << direction.z << ")";
        ASSERT_EQ(found.has_value(), exact.polygon != no_polygon)
            << text.str() << "; found " << (found ? found->polygon : no_polygon) << ", exact "
            << exact.polygon;
        if (!found) continue;
        ASSERT_EQ(found->polygon, exact.polygon) << text.str();
        ASSERT_NEAR(found->t, exact.t, 1e-6) << text.str();
    }
    EXPECT_LT(doubtful, rays / 10);
}

TEST(Ladder, EdgeFindsWhatASearchThroughAllPolygonsFinds) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = shapes::empty_cube(random.whole(1, 24), random.whole(1, 24), random.uniform(5, 30),
                                             random.whole(1, 1500));
        const dvec3 size = scene.frame.cube().high;
        for (int i = 0; i < 25; ++i) {
            const shapes::Axes axes = shapes::attitude(random, random.whole(0, 5));
            const dvec3 centre =
                size * dvec3(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9), random.uniform(0.1, 0.9));
            auto outline =
                shapes::lift(shapes::star(random, random.whole(3, 40), random.uniform(0.1, 7)), axes, centre);
            // Clipped to the cube: the rest belongs to the exterior.
            outline = clip_to_box(outline, scene.frame.cube());
            if (outline.empty() || shapes::area_of(outline) < 1e-6) continue;
            hand_made::add_polygon(scene, 0, outline);
        }
        expect_exact(scene, random, 300);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(Ladder, EdgeIsExactOnConcavePolygonsAlongTheCellBorders) {
    for (const std::uint64_t seed : property::seeds(100, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int depth = random.whole(16, 24);
        CellScene scene = shapes::empty_cube(16, 16, depth, depth * random.whole(1, 3));
        const dvec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int i = 0; i < 8; ++i) {
            const int first = random.whole(0, 2);
            const int second = (first + random.whole(1, 2)) % 3;
            const int teeth = random.whole(2, 4);
            const shapes::Axes axes{unit[first], unit[second], glm::cross(unit[first], unit[second])};
            const double size = (2 * teeth - 1) / 2.0;  // teeth and gaps one cell wide
            dvec3 centre{8, 8, 8};
            centre += 0.5 * (unit[first] + unit[second]);
            centre[3 - first - second] = random.whole(1, 15) + (random.chance(0.5) ? 0.0 : 0.25);
            hand_made::add_polygon(scene, 0, shapes::lift(shapes::comb(teeth, size), axes, centre));
        }
        // Two polygons in one plane do not make a surface.
        std::set<std::pair<int, double>> planes;
        std::vector<Polygon> kept;
        for (Polygon& polygon : scene.polygons) {
            if (!planes
                     .insert({dominant_axis(polygon.plane.n),
                              polygon.vertices[0][dominant_axis(polygon.plane.n)]})
                     .second)
                continue;
            polygon.id = std::uint32_t(kept.size());
            kept.push_back(polygon);
        }
        scene.polygons = kept;
        expect_exact(scene, random, 300);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

/// Calls `check` for every rung in both arithmetics.
void at_every_rung(const CellScene& scene,
                   const std::function<void(const Context&, const std::vector<CellStore>&)>& check) {
    for (const Numbers numbers : shapes::both_arithmetics) {
        for (const HitTest rung : shapes::every_rung) {
            const PictureSettings settings = shapes::settings_for(scene, rung, numbers);
            const Context context(scene, settings);
            SCOPED_TRACE(std::string(context.arithmetic.exact() ? "exact" : "fixed") + ", rung " +
                         std::to_string(int(rung)));
            check(context, load_array(scene, settings, context.arithmetic));
        }
    }
}

TEST(Ladder, AVisitIsTheSameByAnIndexTableThatStandsApartFromTheVoxels) {
    for (const std::uint64_t seed : property::seeds(200, 6)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const CellScene scene = shapes::random_polygons(random, 12);
        int hits = 0;
        at_every_rung(scene, [&](const Context& context, const std::vector<CellStore>& cells) {
            for (int i = 0; i < 300; ++i) {
                const dvec3 share{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
                int x = 0;
                int y = 0;
                const Ray ray = walker::ray_at(context, share * scene.frame.cube().high,
                                               shapes::sloped_direction(random), x, y);
                const CellStore& store = cells[std::size_t(y * scene.frame.width + x)];
                std::vector<IndexEntry> lines(1);  // kept if a store has none: null means the store's own
                lines.insert(lines.end(), store.index.begin(), store.index.end());
                const Visit a = visit_cell(store, ray, context);
                const Visit b =
                    visit_cell(store, ray, context, {lines.data() + 1, std::uint32_t(store.index.size())});
                ASSERT_EQ(a.event, b.event);
                ASSERT_EQ(std::tie(a.hit.t, a.hit.voxel, a.crossing.t, a.crossing.side),
                          std::tie(b.hit.t, b.hit.voxel, b.crossing.t, b.crossing.side));
                ASSERT_EQ(std::tie(a.comparisons.runs, a.comparisons.tests, a.comparisons.edges),
                          std::tie(b.comparisons.runs, b.comparisons.tests, b.comparisons.edges));
                hits += a.event == Visit::Event::hit;
            }
        });
        EXPECT_GT(hits, 0);
    }
}

TEST(Ladder, ARayCannotHitThePolygonThatItLeaves) {
    CellScene scene = shapes::empty_cube(4, 4, 8, 64);
    hand_made::add_rectangle(scene, 0, {0, 0, 3}, {4, 0, 0}, {0, 4, 0});
    hand_made::add_rectangle(scene, 0, {0, 0, 5}, {4, 0, 0}, {0, 4, 0});
    at_every_rung(scene, [](const Context& context, const std::vector<CellStore>& cells) {
        int x = 0;
        int y = 0;
        Ray ray = walker::ray_at(context, {1.3, 1.4, 3}, glm::normalize(dvec3(0.1, 0.2, 1)), x, y);
        ray.fresh = true;
        ray.leaves = 0;
        const auto found = walker::walk(cells, context, ray, x, y);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->polygon, 1u);
    });
}

TEST(Ladder, EqualDistancesGoToTheLowerId) {
    CellScene scene = shapes::empty_cube(4, 4, 8, 64);
    hand_made::add_rectangle(scene, 0, {0, 0, 3}, {4, 0, 0}, {0, 4, 0});
    hand_made::add_rectangle(scene, 0, {0, 0, 3}, {4, 0, 0}, {0, 4, 0});
    std::swap(scene.polygons[0], scene.polygons[1]);  // stored the other way round
    at_every_rung(scene, [](const Context& context, const std::vector<CellStore>& cells) {
        int x = 0;
        int y = 0;
        const Ray ray = walker::ray_at(context, {1.5, 1.5, 0}, {0, 0, 1}, x, y);
        const auto found = walker::walk(cells, context, ray, x, y);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->polygon, 0u);
    });
}

TEST(Ladder, AShadowRayIsBlockedBeforeItsSourceOnly) {
    CellScene scene = shapes::empty_cube(4, 4, 8, 64);
    hand_made::add_rectangle(scene, 0, {0, 0, 3}, {4, 0, 0}, {0, 4, 0});
    for (const Numbers numbers : shapes::both_arithmetics) {
        const PictureSettings settings = shapes::settings_for(scene, HitTest::edge, numbers);
        const Context context(scene, settings);
        const auto cells = load_array(scene, settings, context.arithmetic);
        for (const double reach : {2.9, 3.0, 3.1}) {
            int x = 0;
            int y = 0;
            Ray ray = walker::ray_at(context, {1.5, 1.5, 0}, {0, 0, 1}, x, y);
            ray.kind = RayKind::shadow;
            ray.reach = context.arithmetic.hold_reach(reach);
            const Visit visit = visit_cell(cells[5], ray, context);
            EXPECT_EQ(visit.event, reach > 3 ? Visit::Event::hit : Visit::Event::reaches_source) << reach;
        }
    }
}

}  // namespace
}  // namespace raycell
