// Planes, edges and normals in fixed-point words: what is rounded together stays consistent along a row and
// within a voxel.
#include "model/loading/loading.hpp"
#include "model/tracing/intersect.hpp"
#include "model/tracing/tracing.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

/// A unit normal whose largest component is along `drop`.
dvec3 normal_towards(int drop, Random& random) {
    dvec3 n{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    n[drop] = random.chance(0.5) ? 1 : -1;
    return glm::normalize(n);
}

/// Distance of a fixed-point plane from a point of the true plane, along the dropped axis.
double off(const Plane& held, int drop, const dvec3& point) {
    return std::abs((held.c - glm::dot(held.n, point)) / held.n[drop]);
}

TEST(HeldPlanes, PassThroughTheirAnchorWhereASeparateRoundingWouldMissItByManyBits) {
    double worst_apart = 0;
    for (const std::uint64_t seed : property::seeds(1, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int bits = random.whole(8, 32);
        const Format slope(2, bits - 2);
        const Format offset(13, bits - 2);
        const int drop = random.whole(0, 2);
        const dvec3 anchor{random.uniform(200, 1000), random.uniform(200, 1000), random.uniform(200, 1000)};
        Plane plane;
        plane.n = normal_towards(drop, random);
        plane.c = glm::dot(plane.n, anchor);
        const Plane held = hold_plane(plane, drop, anchor, slope, offset);
        EXPECT_EQ(std::abs(held.n[drop]), 1);
        for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(held.n[axis], slope.hold(held.n[axis]));
        EXPECT_EQ(held.c, offset.hold(held.c));
        // Only the offset's own rounding is left.
        EXPECT_LE(off(held, drop, anchor), 0.51 * offset.step() + 1e-9);
        // One cell away, the error is the slopes' rounding times one cell.
        dvec3 beside = anchor + dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        beside[drop] += (plane.c - glm::dot(plane.n, beside)) / plane.n[drop];
        EXPECT_LE(off(held, drop, beside), 1.6 * offset.step() + 1e-9);
        // For comparison, each number rounded separately: the error of the slope, times the distance to the
        // origin.
        const double scale = 1 / std::abs(plane.n[drop]);
        Plane apart;
        for (int axis = 0; axis < 3; ++axis) apart.n[axis] = slope.hold(plane.n[axis] * scale);
        apart.c = offset.hold(plane.c * scale);
        worst_apart = std::max(worst_apart, off(apart, drop, anchor) / offset.step());
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(worst_apart, 100) << "last bits; otherwise this test could not see the difference";
    }
}

TEST(HeldPlanes, TakeTheAnchorsPlaceOnThePlaneWhereItLiesALittleOff) {
    for (const std::uint64_t seed : property::seeds(500, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Format word(13, 23);
        const int drop = random.whole(0, 2);
        Plane plane;
        plane.n = normal_towards(drop, random);
        plane.c = random.uniform(-100, 100);
        dvec3 on{random.uniform(0, 100), random.uniform(0, 100), random.uniform(0, 100)};
        on[drop] += (plane.c - glm::dot(plane.n, on)) / plane.n[drop];
        dvec3 beside = on;
        beside[drop] += random.uniform(-0.01, 0.01);
        const Plane a = hold_plane(plane, drop, on, word, word);
        const Plane b = hold_plane(plane, drop, beside, word, word);
        EXPECT_EQ(a.n, b.n);
        EXPECT_NEAR(a.c, b.c, word.step());
    }
}

TEST(HeldEdges, StayOnTheirLineWhereASeparateRoundingWouldNot) {
    double worst_apart = 0;
    for (const std::uint64_t seed : property::seeds(1000, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int bits = random.whole(8, 32);
        const Format slope(2, bits - 2);
        const Format offset(13, bits - 2);
        const double turn = random.uniform(0, 2 * hand_made::pi);
        EdgeFunction edge{std::cos(turn), std::sin(turn), 0, 3};
        const dvec2 on{random.uniform(200, 1000), random.uniform(200, 1000)};
        edge.c = -(edge.a * on.x + edge.b * on.y);
        const dvec2 anchor = on + random.uniform(-1, 1) * dvec2(edge.a, edge.b);  // near the edge
        const EdgeFunction held = hold_edge(edge, anchor, slope, offset);
        EXPECT_EQ(held.piece, 3u);
        EXPECT_EQ(held.a, slope.hold(edge.a));
        EXPECT_EQ(held.b, slope.hold(edge.b));
        EXPECT_EQ(held.c, offset.hold(held.c));
        EXPECT_LE(std::abs(held.at(on)), 0.51 * offset.step() + 1e-9);
        const EdgeFunction apart{slope.hold(edge.a), slope.hold(edge.b), offset.hold(edge.c), 3};
        worst_apart = std::max(worst_apart, std::abs(apart.at(on)) / offset.step());
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(worst_apart, 100) << "last bits";
    }
}

TEST(HeldFields, AreRightAtTheirAnchorWhereASeparateRoundingWouldNot) {
    double worst_apart = 0;
    for (const std::uint64_t seed : property::seeds(1500, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const int bits = random.whole(8, 32);
        const Format word(10, bits - 4);
        NormalField field;
        field.du = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
        field.dv = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
        const dvec2 anchor{random.uniform(200, 1000), random.uniform(200, 1000)};
        const dvec3 there = hand_made::random_direction(random.engine());
        field.base = there - anchor.x * field.du - anchor.y * field.dv;
        const NormalField held = hold_field(field, anchor, word, word);
        const dvec3 wrong = held.at(anchor) - there;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(std::abs(wrong[axis]), 0.51 * word.step() + 1e-9);
            const double apart = word.hold(field.base[axis]) + anchor.x * word.hold(field.du[axis]) +
                                 anchor.y * word.hold(field.dv[axis]);
            worst_apart = std::max(worst_apart, std::abs(apart - there[axis]) / word.step());
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(worst_apart, 100) << "last bits";
    }
}

/// A wide triangle over a row of cells, with a random word length.
struct WideRow {
    explicit WideRow(std::uint64_t seed, int width)
        : random(seed), scene(shapes::empty_cube(width, 4, 64, 256)) {
        settings = shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
        settings.numbers.word_bits = random.whole(8, 32);
        const auto corner = [&](double x) {
            return dvec3(x, random.uniform(0.3, 3.7), random.uniform(2, 60));
        };
        Polygon triangle = make_triangle(
            0, 0, {corner(0.2), corner(width - 0.3), corner(random.uniform(10, width - 10.0))},
            {hand_made::random_direction(random.engine()), hand_made::random_direction(random.engine()),
             hand_made::random_direction(random.engine())});
        scene.polygons.push_back(triangle);
    }
    Random random;
    CellScene scene;
    PictureSettings settings;
};

TEST(HeldSpans, AfterAThousandCellsAreTheSpanCutThereBitForBit) {
    int compared = 0;
    for (const std::uint64_t seed : property::seeds(2000, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        constexpr int width = 1040;
        WideRow row(seed, width);
        const Context context(row.scene, row.settings);
        const Arithmetic& arithmetic = context.arithmetic;
        Polygon polygon = row.scene.polygons[0];
        if (!clip_to_cube(polygon, row.scene.frame.cube(), arithmetic)) continue;
        for (const Trapeze& trapeze : precompute(polygon, arithmetic, width)) {
            for (int y = 0; y < 4; ++y) {
                auto span = cut_span(trapeze, y, row.scene.frame.depth, HitTest::edge, arithmetic);
                if (!span) continue;
                const int first = span->x;
                while (span->x < span->last) advance(*span, arithmetic);
                if (span->x - first < 1000) continue;
                ++compared;
                // The same functions at the last cell's corner, evaluated directly in extended precision.
                const long double x = span->x;
                const auto& n = trapeze.plane.n;
                const double offset =
                    double(static_cast<long double>(trapeze.plane.c) - static_cast<long double>(n.x) * x -
                           static_cast<long double>(n.y) * y);
                EXPECT_EQ(span->plane.c, offset);
                EXPECT_EQ(span->plane.n, n);
                const dvec2 shift = project({double(span->x), double(y), 0}, span->drop);
                for (int i = 0, j = 0; i < span->edge_count; ++i, ++j) {
                    while (trapeze.edges[std::size_t(j)].a != span->edges[std::size_t(i)].a ||
                           trapeze.edges[std::size_t(j)].b != span->edges[std::size_t(i)].b)
                        ASSERT_LT(++j, trapeze.edge_count);
                    const EdgeFunction& edge = trapeze.edges[std::size_t(j)];
                    const long double there = static_cast<long double>(edge.a) * shift.x +
                                              static_cast<long double>(edge.b) * shift.y + edge.c;
                    EXPECT_EQ(span->edges[std::size_t(i)].c, double(there)) << "edge " << i;
                }
                for (int axis = 0; axis < 3; ++axis) {
                    const NormalField& field = trapeze.normal;
                    const long double there = static_cast<long double>(field.du[axis]) * shift.x +
                                              static_cast<long double>(field.dv[axis]) * shift.y +
                                              field.base[axis];
                    EXPECT_EQ(span->normal.base[axis], double(there));
                }
            }
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(compared, 10);
    }
}

/// Every point of a polygon lies inside the voxel's edges, whichever of its pieces came first.
TEST(HeldVoxels, KeepTheirEdgesWhereMergedPiecesBeginNearer) {
    int merged = 0;
    for (const std::uint64_t seed : property::seeds(3000, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = shapes::empty_cube(6, 6, 24, random.whole(200, 2000));
        // Walls, so that their edges have z coordinates; concave, so that cells get pieces at several depths.
        const shapes::Axes axes = shapes::attitude(random, random.whole(1, 4));
        const auto outline =
            shapes::lift(shapes::star(random, random.whole(12, 40), random.uniform(0.8, 2.5)), axes,
                         {random.uniform(2.6, 3.4), random.uniform(2.6, 3.4), 12});
        hand_made::add_polygon(scene, 0, outline);
        PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
        const Context context(scene, settings);
        const Arithmetic& arithmetic = context.arithmetic;
        const auto cells = load_array(scene, settings, arithmetic);
        const Polygon& polygon = scene.polygons[0];
        const auto flat = shapes::projected(polygon.vertices, polygon.drop);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            for (const Voxel& voxel : cells[i].voxels) {
                EXPECT_EQ(voxel.base, voxel.near);
                EXPECT_LT(voxel.near, voxel.far);
                if (voxel.pieces < 2 || voxel.drop == 2) continue;
                ++merged;
                for (int k = 0; k < 30; ++k) {
                    dvec3 p{int(i % 6) + random.uniform(0, 1), int(i / 6) + random.uniform(0, 1),
                            random.uniform(voxel.near, voxel.far)};
                    const dvec3& n = polygon.plane.n;
                    p[voxel.drop] += (polygon.plane.c - glm::dot(n, p)) / n[voxel.drop];
                    const dvec3 local = p - dvec3(int(i % 6), int(i / 6), 0);
                    if (local.x < 0.01 || local.x > 0.99 || local.y < 0.01 || local.y > 0.99) continue;
                    const auto place = shapes::place_of(flat, project(p, voxel.drop));
                    if (place.distance < 1e-3) continue;
                    // A short ray through the plane.
                    Ray ray;
                    ray.fresh = false;
                    const Formats& f = arithmetic.formats();
                    const dvec3 start = local - 0.005 * n;
                    ray.position = {f.unit.hold(start.x), f.unit.hold(start.y), f.depth.hold(start.z)};
                    set_direction(ray, arithmetic.normalise(n), arithmetic);
                    EXPECT_EQ(hit_voxel(cells[i], voxel, ray, 0.01, HitTest::edge, arithmetic).has_value(),
                              place.inside)
                        << "cell " << i << ", (" << p.x << ", " << p.y << ", " << p.z << "), "
                        << place.distance << " from the outline";
                }
            }
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(merged, 50) << "voxels of several pieces with z among their edges' coordinates";
    }
}

/// A scene with one triangle, `width` cells wide, over which the normal turns by a right angle.
CellScene turning(double width) {
    CellScene scene = shapes::empty_cube(4, 4, 8, 64);
    const dvec3 at(1.53, 1.47, 4.2);
    scene.polygons.push_back(make_triangle(0, 0, {at, at + dvec3(width, 0, 0), at + dvec3(0, width, 0)},
                                           {dvec3(0, 0, -1), dvec3(1, 0, 0), dvec3(0, 1, 0)}));
    return scene;
}

/// The largest error of the voxel's normal at the triangle's corners; `field` gets the voxel's field of
/// normals. Returns 1e300 if the cell does not have exactly one voxel.
double turning_error(const CellScene& scene, int word_bits, NormalField& field) {
    PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::fixed);
    settings.numbers.word_bits = word_bits;
    const Context context(scene, settings);
    const auto cells = load_array(scene, settings, context.arithmetic);
    if (cells[1 * 4 + 1].voxels.size() != 1) return 1e300;
    field = cells[1 * 4 + 1].voxels[0].normal;
    const Polygon& polygon = scene.polygons[0];
    double error = 0;
    for (const dvec3& corner : polygon.vertices) {
        const dvec3 exact = polygon.normal.at(project(corner, polygon.drop));
        const dvec3 held = field.at(project(corner - dvec3(1, 1, 0), polygon.drop));
        error = std::max(error, glm::length(glm::normalize(held) - glm::normalize(exact)));
    }
    return error;
}

TEST(HeldVoxels, OfPolygonsMuchSmallerThanACellKeepTheirNormalsAsNearAsTheirPlace) {
    for (const double width : {0.3141, 0.0577, 0.01234, 0.00123}) {
        const CellScene scene = turning(width);
        NormalField field;
        for (const int bits : {20, 24, 28, 32}) {
            const double error = turning_error(scene, bits, field);
            // The triangle's place is rounded to words, and the normal turns with every last bit of that
            // place.
            EXPECT_LT(error, 16 * std::ldexp(1, 2 - bits) / width) << width << ", " << bits << " bits";
            EXPECT_NE(field.du, dvec3(0));
        }
    }
}

TEST(HeldVoxels, OfPolygonsThatWordsCantTellFromAPointHaveOneNormal) {
    for (const int bits : {8, 16, 20, 32}) {
        const CellScene scene = turning(std::ldexp(1, -bits - 1));
        NormalField field;
        turning_error(scene, bits, field);
        EXPECT_EQ(field.du, dvec3(0)) << bits;
        EXPECT_EQ(field.dv, dvec3(0)) << bits;
        const dvec3 middle = glm::normalize(dvec3(1, 1, -1));
        EXPECT_GT(glm::dot(glm::normalize(field.base), middle), 0.9) << bits;
    }
}

TEST(HeldVoxels, FillTheirWordsWithTheNormalField) {
    for (const double width : {0.4, 0.02}) {
        const CellScene scene = turning(width);
        NormalField field;
        turning_error(scene, 20, field);
        double largest = 0;
        for (const dvec3& v : {field.base, field.du, field.dv}) {
            largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        }
        EXPECT_GE(largest, 4 - 1e-3);
        EXPECT_LT(largest, 8);
    }
}

TEST(HeldVoxels, HaveARunEvenWhereLevelsAreFinerThanTheLastBit) {
    CellScene scene = shapes::empty_cube(2, 2, 1, 65536);
    hand_made::add_rectangle(scene, 0, {0, 0, 0.3}, {2, 0, 0.2}, {0, 2, 0});
    for (const HitTest rung : shapes::every_rung) {
        PictureSettings settings = shapes::settings_for(scene, rung, Numbers::fixed);
        settings.numbers.word_bits = 8;
        const Context context(scene, settings);
        for (const CellStore& store : load_array(scene, settings, context.arithmetic)) {
            ASSERT_EQ(store.voxels.size(), 1u);
            EXPECT_LT(store.voxels[0].near, store.voxels[0].far) << "rung " << int(rung);
        }
    }
}

}  // namespace
}  // namespace raycell
