// Spans and voxels: every point of a polygon lies in the voxel of its cell.
#include "model/loading/voxel.hpp"

#include "model/loading/loading.hpp"
#include "model/tracing/intersect.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

constexpr int width = 20;
constexpr int height = 18;
const Arithmetic& exact = exact_arithmetic();

CellScene cube(Random& random) { return shapes::empty_cube(width, height, 24, random.whole(12, 2048)); }

/// Adds a random polygon that lies inside the cube, at least 0.5 from its faces.
void add_random_polygon(CellScene& scene, Random& random, int corners) {
    const shapes::Axes axes = shapes::attitude(random, random.whole(0, 5));
    const double size = std::pow(10, random.uniform(-1.5, 0.9));
    const dvec3 centre{random.uniform(9, 11), random.uniform(8.5, 9.5), random.uniform(10, 14)};
    hand_made::add_polygon(scene, 0, shapes::lift(shapes::star(random, corners, size), axes, centre));
}

PictureSettings settings_of(const CellScene& scene, HitTest rung) {
    return shapes::settings_for(scene, rung, Numbers::exact);
}

/// A random point of the polygon, drawn until one lies inside. Returns false after 50 tries.
bool point_of(const Polygon& polygon, Random& random, dvec3& point) {
    const auto outline = shapes::projected(polygon.vertices, polygon.drop);
    dvec2 low(1e300), high(-1e300);
    for (const dvec2& p : outline) low = glm::min(low, p), high = glm::max(high, p);
    for (int tries = 0; tries < 50; ++tries) {
        const dvec2 uv{random.uniform(low.x, high.x), random.uniform(low.y, high.y)};
        if (!shapes::place_of(outline, uv).inside) continue;
        const Projection axes = projection(polygon.drop);
        const dvec3& n = polygon.plane.n;
        point[axes.u] = uv.x;
        point[axes.v] = uv.y;
        point[polygon.drop] = (polygon.plane.c - n[axes.u] * uv.x - n[axes.v] * uv.y) / n[polygon.drop];
        return true;
    }
    return false;
}

TEST(Voxels, EveryPointOfAPolygonIsHitInItsCellAtEveryRungButDepth) {
    for (const std::uint64_t seed : property::seeds(1, 250)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        add_random_polygon(scene, random, random.whole(3, 30));
        const Polygon& polygon = scene.polygons[0];
        for (const HitTest rung : {HitTest::interval, HitTest::plane, HitTest::mask, HitTest::edge}) {
            const auto cells = load_array(scene, settings_of(scene, rung), exact);
            for (int i = 0; i < 60; ++i) {
                dvec3 p;
                if (!point_of(polygon, random, p)) break;
                const int x = int(p.x);
                const int y = int(p.y);
                const CellStore& store = cells[std::size_t(y * width + x)];
                const double level = scene.frame.level();
                bool held = false;
                const dvec3 local = p - dvec3(x, y, 0);
                for (const Voxel& voxel : store.voxels) {
                    EXPECT_NEAR(glm::dot(voxel.plane.n, local), voxel.plane.c, 1e-9);
                    const bool in_run =
                        voxel.near_level * level <= p.z + 1e-7 && voxel.far_level * level >= p.z - 1e-7;
                    // A short ray through the point, at right angles to the plane, must hit.
                    constexpr double reach = 1e-3;
                    Ray ray;
                    ray.position = local - reach * voxel.plane.n;
                    ray.direction = voxel.plane.n;
                    const bool hit = hit_voxel(store, voxel, ray, 2 * reach, rung, exact).has_value();
                    held = held || (in_run && hit);
                }
                ASSERT_TRUE(held) << "rung " << int(rung) << ", point (" << p.x << ", " << p.y << ", " << p.z
                                  << ")";
            }
        }
    }
}

TEST(Voxels, AtDepthAreMadeOnlyWhereThePixelCentreIsCovered) {
    int stored = 0;
    for (const std::uint64_t seed : property::seeds(400, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        const shapes::Axes axes = shapes::attitude(random, random.chance(0.5) ? 0 : 5);
        hand_made::add_polygon(
            scene, 0,
            shapes::lift(shapes::star(random, random.whole(3, 30), random.uniform(1, 8)), axes, {10, 9, 12}));
        const Polygon& polygon = scene.polygons[0];
        if (std::abs(polygon.plane.n.z) < 1e-3) continue;
        const auto outline = shapes::projected(polygon.vertices, 2);
        const auto cells = load_array(scene, settings_of(scene, HitTest::depth), exact);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const shapes::Place place = shapes::place_of(outline, {x + 0.5, y + 0.5});
                if (place.distance < 1e-5) continue;
                const auto& voxels = cells[std::size_t(y * width + x)].voxels;
                EXPECT_EQ(!voxels.empty(), place.inside) << x << ", " << y;
                if (voxels.empty()) continue;
                ++stored;
                const double z =
                    (polygon.plane.c - polygon.plane.n.x * (x + 0.5) - polygon.plane.n.y * (y + 0.5)) /
                    polygon.plane.n.z;
                EXPECT_EQ(voxels[0].near_level, int(z / scene.frame.level()));
                EXPECT_EQ(voxels[0].far_level, voxels[0].near_level + 1);
            }
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(stored, 1000);
    }
}

TEST(Spans, AdvancedToACellAgreeWithOneCutFromThere) {
    for (const std::uint64_t seed : property::seeds(700, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        add_random_polygon(scene, random, random.whole(3, 12));
        for (const Trapeze& trapeze : precompute(scene.polygons[0], exact, width, height)) {
            for (int row = 0; row < height; ++row) {
                auto span = cut_span(trapeze, row, scene.frame.depth, HitTest::edge, exact);
                if (!span) continue;
                ASSERT_GE(row, trapeze.rows.first);
                EXPECT_LE(0, span->x);
                EXPECT_LE(span->x, span->last);
                EXPECT_LT(span->last, width);
                for (;; advance(*span, exact)) {
                    const dvec3& n = trapeze.plane.n;
                    EXPECT_NEAR(span->plane.c, trapeze.plane.c - n.x * span->x - n.y * row, 1e-10);
                    const dvec2 shift = project({double(span->x), double(row), 0}, span->drop);
                    const dvec2 probe{0.3, 0.7};
                    EXPECT_LT(glm::length(span->normal.at(probe) - trapeze.normal.at(probe + shift)), 1e-9);
                    // Each of the span's edges is one of the trapeze's.
                    for (int i = 0, j = 0; i < span->edge_count; ++i, ++j) {
                        const EdgeFunction& edge = span->edges[std::size_t(i)];
                        while (j < trapeze.edge_count && (trapeze.edges[std::size_t(j)].a != edge.a ||
                                                          trapeze.edges[std::size_t(j)].b != edge.b))
                            ++j;
                        ASSERT_LT(j, trapeze.edge_count);
                        EXPECT_NEAR(edge.at(probe), trapeze.edges[std::size_t(j)].at(probe + shift), 1e-9);
                    }
                    if (span->x == span->last) break;
                }
            }
        }
    }
}

TEST(Voxels, PiecesOfOnePolygonShareOneVoxelPerCell) {
    for (const std::uint64_t seed : property::seeds(1000, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        add_random_polygon(scene, random, 40);
        add_random_polygon(scene, random, 40);
        for (const HitTest rung : {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::edge}) {
            for (const CellStore& store : load_array(scene, settings_of(scene, rung), exact)) {
                ASSERT_LE(store.voxels.size(), 2u) << "rung " << int(rung);
                for (const Voxel& voxel : store.voxels) {
                    EXPECT_LE(std::size_t(voxel.first_edge) + voxel.edge_count, store.edges.size());
                    EXPECT_LT(voxel.near_level, voxel.far_level);
                    EXPECT_GE(voxel.near_level, 0);
                    EXPECT_LE(voxel.far_level, scene.frame.depth_levels);
                    if (rung == HitTest::depth) continue;
                    EXPECT_GE(voxel.point.x, 0);
                    EXPECT_LE(voxel.point.x, 1);
                    EXPECT_GE(voxel.point.y, 0);
                    EXPECT_LE(voxel.point.y, 1);
                    EXPECT_NEAR(glm::dot(voxel.plane.n, voxel.point), voxel.plane.c, 1e-8)
                        << "its point is on the plane";
                }
            }
        }
    }
}

TEST(Voxels, AreasOfTheCellsAddUpToThatOfThePolygon) {
    for (const std::uint64_t seed : property::seeds(1200, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        add_random_polygon(scene, random, random.whole(3, 40));
        double sum = 0;
        // Voxels with masks are not merged: one for each piece.
        for (const CellStore& store : load_array(scene, settings_of(scene, HitTest::mask), exact)) {
            for (const Voxel& voxel : store.voxels) sum += voxel.area;
        }
        // Areas are those of the projection. Neighbouring cells and pieces overlap by their tolerances.
        const Polygon& polygon = scene.polygons[0];
        const double area = shapes::area_of(polygon.vertices) * std::abs(polygon.plane.n[polygon.drop]);
        EXPECT_NEAR(sum, area, 1e-5 * std::max(1.0, sum));
    }
}

TEST(Voxels, ThatDoNotFitAreCountedOnceEach) {
    for (const std::uint64_t seed : property::seeds(1500, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = cube(random);
        for (int i = 0; i < 6; ++i) add_random_polygon(scene, random, random.whole(3, 20));
        PictureSettings settings = settings_of(scene, HitTest::edge);
        LoadCounts all;
        const auto unlimited = load_array(scene, settings, exact, &all);
        EXPECT_EQ(all.overflowed, 0u);
        settings.voxel_capacity = random.whole(1, 3);
        LoadCounts limited;
        const auto cells = load_array(scene, settings, exact, &limited);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const std::size_t fits =
                std::min(unlimited[i].voxels.size(), std::size_t(settings.voxel_capacity));
            EXPECT_EQ(cells[i].voxels.size(), fits);
            EXPECT_EQ(cells[i].overflowed, unlimited[i].voxels.size() - fits) << "cell " << i;
        }
        EXPECT_EQ(limited.voxels + limited.overflowed, all.voxels);
    }
}

TEST(Voxels, BitsGrowFromRungToRungAndWithTheWord) {
    PictureSettings settings;
    // In a cube of 256 cells, depths have 8 bits before the point.
    const Formats formats(20, Rounding::nearest, {128, 128, 256, 0.25});
    const auto bits = [&](HitTest rung) {
        settings.hit = rung;
        return voxel_bits(settings, formats, 2);
    };
    settings.normals = Normals::voxel;
    // Id; features: six of 12 bits, Shine 12, index of refraction 16, mirror flag; a level of 1024; a normal;
    // two slopes, two bits for the axis, one for the sign; its line of the index table, a number and a level.
    EXPECT_EQ(feature_bits(formats), 6 * 12 + 12 + 16 + 1);
    EXPECT_EQ(bits(HitTest::depth).base, 20 + 101 + 10 + 60 + 2 * 20 + 3 + 10 + 10);
    EXPECT_EQ(bits(HitTest::interval).base, bits(HitTest::depth).base + 10);
    EXPECT_EQ(bits(HitTest::plane).base, bits(HitTest::interval).base + 20) << "the offset of its plane";
    // 64 sub-cells; four borders of the window in 32nds. Each needs five bits: 0 to 31, or 1 to 32.
    EXPECT_EQ(bits(HitTest::mask).base, bits(HitTest::plane).base + 64 + 4 * 5);
    EXPECT_EQ(bits(HitTest::edge).base, bits(HitTest::plane).base + 8);
    EXPECT_EQ(bits(HitTest::edge).per_edge, 2 * 20 + (8 + 20) + 2);
    EXPECT_EQ(bits(HitTest::mask).per_edge, 0);
    // The paper's voxel has 40 bytes; the rung of the paper must not need more.
    EXPECT_LE(bits(HitTest::depth).base, 40 * 8);
    const int bare = bits(HitTest::plane).base;
    settings.shadows = Shadows::precast;
    const int precast = bits(HitTest::plane).base;
    EXPECT_EQ(precast, bare + 2 + 2 * 20 + (8 + 20));  // a bit for each source, and the voxel's own point
    settings.shadows = Shadows::memo;
    EXPECT_EQ(bits(HitTest::plane).base, precast + 2);
    settings.normals = Normals::linear;
    EXPECT_EQ(bits(HitTest::plane).base, precast + 2 + 120);
    const Formats narrower(16, Rounding::nearest, {128, 128, 256, 0.25});
    // Three words of the plane, nine of the normals, three of the point.
    EXPECT_EQ(voxel_bits(settings, narrower, 2).base, voxel_bits(settings, formats, 2).base - 4 * 15);
    const Formats least(8, Rounding::nearest, {128, 128, 256, 0.25});
    EXPECT_EQ(feature_bits(least), 6 * 8 + 12 + 8 + 1) << "words shorter than 12 bits shorten features too";
}

}  // namespace
}  // namespace raycell
