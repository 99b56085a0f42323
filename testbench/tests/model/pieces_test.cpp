// A polygon with many convex pieces in one cell.
#include <gtest/gtest.h>

#include <cmath>

#include "model/loading/loading.hpp"
#include "model/tracing/tracing.hpp"
#include "testbench/tests/property.hpp"

namespace raycell {
namespace {

/// Even-odd rule by counting crossings, independent of the model's code.
bool inside(const std::vector<dvec3>& outline, double x, double y) {
    bool in = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const dvec3& a = outline[i];
        const dvec3& b = outline[j];
        if ((a.y > y) != (b.y > y) && x < a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)) in = !in;
    }
    return in;
}

TEST(Pieces, MoreThanAByteCountsInOneCellStillBoundThePolygon) {
    CellScene scene;
    scene.frame.width = scene.frame.height = 1;
    scene.frame.depth = 4;
    scene.frame.depth_levels = 16;
    scene.objects.emplace_back();
    std::vector<dvec3> star;
    constexpr int corners = 900;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::acos(-1.0) * i / corners;
        const double radius = 0.4 + 0.05 * std::sin(7 * angle) + (i % 2 ? 0.02 : -0.02);
        star.emplace_back(0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle), 2);
    }
    scene.polygons.push_back(make_polygon(0, 0, star));
    PictureSettings settings;
    settings.width = settings.height = 1;
    settings.depth_levels = 16;
    settings.numbers.arithmetic = Numbers::exact;
    const Context context(scene, settings);
    const std::vector<CellStore> cells = load_array(scene, settings, context.arithmetic);
    ASSERT_EQ(cells[0].voxels.size(), 1u);
    EXPECT_GT(cells[0].voxels[0].pieces, 255u);
    for (const std::uint64_t seed : property::seeds(90, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        int hits = 0;
        for (int i = 0; i < 5000; ++i) {
            Ray ray;
            ray.position = {random.uniform(0, 1), random.uniform(0, 1), 0};
            ray.fresh = false;
            set_direction(ray, {0, 0, 1}, context.arithmetic);
            const bool hit = visit_cell(cells[0], ray, context).event == Visit::Event::hit;
            ASSERT_EQ(hit, inside(star, ray.position.x, ray.position.y))
                << ray.position.x << ", " << ray.position.y;
            hits += hit;
        }
        EXPECT_GT(hits, 1500);
        EXPECT_LT(hits, 4000);
    }
}

}  // namespace
}  // namespace raycell
