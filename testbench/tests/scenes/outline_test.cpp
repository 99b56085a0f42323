#include "scenes/outline.hpp"

#include "model/geometry/polygon.hpp"
#include "scene_checks.hpp"

namespace raycell {
namespace {

struct Added {
    Scene scene;
    Diagnostics diagnostics;
};

Added add(std::vector<dvec3> vertices, std::vector<dvec3> normals = {}) {
    Added out;
    out.scene.materials.emplace_back();
    const std::string file = "t";
    add_outline(out.scene, 0, std::move(vertices), std::move(normals), {file, 7}, out.diagnostics);
    expect_sound(out.scene);
    return out;
}

dvec3 area_of(const Scene& scene) {
    dvec3 sum{0, 0, 0};
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
        const auto& v = polygon(scene, i).vertices;
        for (std::size_t k = 1; k + 1 < v.size(); ++k) sum += glm::cross(v[k] - v[0], v[k + 1] - v[0]);
    }
    return sum;
}

const std::vector<dvec3> triangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};

TEST(Outline, KeepsASoundPolygonAsItIs) {
    const Added a = add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(all_messages(a.diagnostics), "");
    EXPECT_EQ(polygon(a.scene, 0).vertices.size(), 4u);
}

TEST(Outline, KeepsVerticesOnAStraightEdgeInSilence) {
    const Added a = add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 1, 0}});
    EXPECT_EQ(all_messages(a.diagnostics), "");
    EXPECT_EQ(polygon(a.scene, 0).vertices.size(), 5u);
}

TEST(Outline, DropsPolygonsWithoutArea) {
    const dvec3 p{1, 2, 3};
    for (const std::vector<dvec3>& flat :
         {std::vector<dvec3>{p, p, p}, std::vector<dvec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
          std::vector<dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
          std::vector<dvec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
          std::vector<dvec3>{{0, 0, 0}, {1e-320, 0, 0}, {0, 1e-320, 0}},
          std::vector<dvec3>{{1e20, 0, 0}, {1e20, 1, 0}, {1e20, 0, 1}}}) {
        const Added a = add(flat);
        EXPECT_TRUE(a.scene.primitives.empty());
        EXPECT_EQ(a.diagnostics.count_of("polygon without area"), 1u) << all_messages(a.diagnostics);
    }
}

TEST(Outline, StandsTheLargestCoordinates) {
    std::vector<dvec3> huge = triangle;
    for (dvec3& v : huge) v *= 1e30;
    EXPECT_EQ(add(huge, {{1e30, 0, 1e30}, {0, 0, 1e-300}, {0, 0, 1}}).scene.primitives.size(), 1u);
    std::vector<dvec3> tiny = triangle;
    for (dvec3& v : tiny) v *= 1e-30;
    EXPECT_EQ(add(tiny).scene.primitives.size(), 1u);
}

TEST(Outline, RemovesRepeatedVerticesAndTheirNormals) {
    const dvec3 n{0, 0, 1};
    const Added a =
        add({{-1, -1, 0}, {1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {-1, -1, 0}, {-1, -1, 0}}, {n, n, n, n, n, n});
    EXPECT_EQ(a.diagnostics.count_of("repeated vertex"), 1u);
    EXPECT_EQ(polygon(a.scene, 0).vertices, triangle);
    EXPECT_EQ(polygon(a.scene, 0).normals.size(), 3u);
}

TEST(Outline, KeepsAConcavePolygonWithItsFront) {
    const Added a = add({{1, 1, 0}, {0, -0.5, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}});
    EXPECT_EQ(a.diagnostics.count_of("reflex first corner"), 1u) << all_messages(a.diagnostics);
    EXPECT_EQ(polygon(a.scene, 0).vertices.size(), 5u);
    EXPECT_NEAR(area_of(a.scene).z, 5, 1e-12) << "counter-clockwise seen from +z";
}

TEST(Outline, CutsANonPlanarPolygonIntoTrianglesWithoutCracks) {
    const std::vector<dvec3> outline{{-1, -1, 0}, {1, -1, 0.6}, {1, 1, 0}, {-1, 1, 0.6}};
    const Added a = add(outline);
    EXPECT_EQ(a.diagnostics.count_of("non-planar polygon"), 1u);
    ASSERT_EQ(a.scene.primitives.size(), 2u);
    // Edges of the outline appear once, in its direction; all other edges twice, once in each direction.
    std::map<std::pair<std::size_t, std::size_t>, int> edges;
    const auto index = [&](const dvec3& v) {
        return static_cast<std::size_t>(std::find(outline.begin(), outline.end(), v) - outline.begin());
    };
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& v = polygon(a.scene, i).vertices;
        ASSERT_EQ(v.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) ++edges[{index(v[k]), index(v[(k + 1) % 3])}];
    }
    for (std::size_t i = 0; i < outline.size(); ++i) EXPECT_EQ((edges[{i, (i + 1) % outline.size()}]), 1);
    std::size_t inner = 0;
    for (const auto& [edge, uses] : edges) {
        EXPECT_LE(uses, 1);
        if ((edge.first + 1) % outline.size() != edge.second && uses == 1) ++inner;
    }
    EXPECT_EQ(inner, 2u);
}

TEST(Outline, CutsAConcaveNonPlanarPolygonWithinItsOutline) {
    const double bend = 0.3;
    std::vector<dvec3> star;
    for (int i = 0; i < 20; ++i) {
        const double angle = i * 3.14159265358979323846 / 10, r = i % 2 ? 0.4 : 1.0;
        star.emplace_back(r * std::cos(angle), r * std::sin(angle), i % 3 ? 0 : bend);
    }
    const Added a = add(star);
    EXPECT_EQ(a.scene.primitives.size(), 18u);
    double absolute = 0;
    for (std::size_t i = 0; i < a.scene.primitives.size(); ++i) {
        const auto& v = polygon(a.scene, i).vertices;
        const double z = glm::cross(v[1] - v[0], v[2] - v[0]).z;
        EXPECT_GT(z, 0) << "a triangle is turned over";
        absolute += z;
    }
    EXPECT_NEAR(absolute, area_of(a.scene).z, 1e-12);
    EXPECT_NEAR(absolute, 20 * 0.4 * std::sin(3.14159265358979323846 / 10), 1e-9);
}

TEST(Outline, HandsTheNormalsOnToTheTriangles) {
    const dvec3 n{0, 0, 2};
    const Added a = add({{-1, -1, 0}, {1, -1, 0.6}, {1, 1, 0}, {-1, 1, 0.6}}, {n, n, n, n});
    ASSERT_EQ(a.scene.primitives.size(), 2u);
    EXPECT_EQ(polygon(a.scene, 1).normals, std::vector<dvec3>(3, dvec3(0, 0, 1)));
}

TEST(Outline, TakesSixPrintedDigitsForPlanar) {
    const auto six = [](double x) { return std::stod((std::ostringstream() << x).str()); };
    for (const double offset : {0.0, 10.0, 300.0}) {
        std::vector<dvec3> circle;
        for (int i = 0; i < 40; ++i) {
            const double a = i * 3.14159265358979323846 / 20;
            circle.emplace_back(six(offset + std::cos(a)), six(offset + std::sin(a)),
                                six(offset + 0.5 * std::cos(a) + 0.3 * std::sin(a)));
        }
        const Added a = add(circle);
        EXPECT_EQ(all_messages(a.diagnostics), "") << offset;
    }
}

TEST(Outline, NeverTakesABentPolygonForPlanarFarFromTheOrigin) {
    const double far = 1e6;
    const Added a = add({{far, 0, 0}, {far + 1, 0, 0.2}, {far + 1, 1, 0}, {far, 1, 0.2}});
    EXPECT_EQ(a.diagnostics.count_of("non-planar polygon"), 1u);
}

TEST(Outline, RejectsAHugeNonPlanarPolygonInsteadOfTakingMinutes) {
    std::vector<dvec3> wave;
    for (int i = 0; i < 2000; ++i) {
        const double a = i * 3.14159265358979323846 / 1000;
        wave.emplace_back(std::cos(a), std::sin(a), 0.2 * std::cos(2 * a));
    }
    EXPECT_THROW(add(wave), InputError);
}

TEST(Outline, FlipsNormalsThatOpposeTheWindingAndSaysSoOnce) {
    Scene scene;
    scene.materials.emplace_back();
    Diagnostics diagnostics;
    const std::string file = "t";
    for (std::size_t line = 1; line <= 100; ++line) {
        add_outline(scene, 0, triangle, {{0, 0, -1}, {0.5, 0, -1}, {0, 0, -3}}, {file, line}, diagnostics);
    }
    EXPECT_EQ(polygon(scene, 0).normals[0], dvec3(0, 0, 1));
    EXPECT_EQ(diagnostics.messages().size(), 1u);
    EXPECT_NE(all_messages(diagnostics).find("and 99 more"), std::string::npos);
}

TEST(Outline, FlipsASingleNormalOnlyIfItPointsStraightBack) {
    const Added back = add(triangle, {{0, 0, 1}, {0, 0, 1}, {0, 0.1, -1}});
    EXPECT_EQ(back.diagnostics.count_of("opposed normals"), 1u);
    EXPECT_GT(polygon(back.scene, 0).normals[2].z, 0);
    const Added leaning = add(triangle, {{0, 0, 1}, {0, 0, 1}, {0, 1, -0.5}});
    EXPECT_EQ(all_messages(leaning.diagnostics), "");
    EXPECT_LT(polygon(leaning.scene, 0).normals[2].z, 0);
}

TEST(Outline, ReplacesNormalsWithoutLength) {
    const Added a = add(triangle, {{0, 0, 0}, {0, 0, 1}, {1e-310, 0, 1e-310}});
    EXPECT_EQ(a.diagnostics.count_of("zero normal"), 1u) << all_messages(a.diagnostics);
    EXPECT_EQ(polygon(a.scene, 0).normals[0], dvec3(0, 0, 1));
}

TEST(Outline, WarnsOfAnOutlineThatCrossesItself) {
    const Added a = add({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {1, -1, 0}});
    EXPECT_EQ(a.diagnostics.count_of("crossing outline"), 1u);
    EXPECT_EQ(a.scene.primitives.size(), 1u);
}

}  // namespace
}  // namespace raycell
