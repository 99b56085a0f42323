// The index table: the voxels of a cell in order of depth, and the search through it.
#include <algorithm>

#include "shapes.hpp"
#include "walker.hpp"

namespace raycell {
namespace {

using property::Random;

struct Depths {
    double near;
    double far;
};

/// A line for each run, by `near` and then by number; `most` is the largest `far` so far.
void expect_in_order(const std::vector<IndexEntry>& table, const std::vector<Depths>& runs) {
    ASSERT_EQ(table.size(), runs.size());
    double most = -1;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const IndexEntry& line = table[i];
        const Depths& run = runs[line.voxel];
        most = std::max(most, run.far);
        ASSERT_EQ(std::tie(line.near, line.far, line.most), std::tie(run.near, run.far, most))
            << "line " << i;
        if (i > 0) {
            ASSERT_LT(std::tie(table[i - 1].near, table[i - 1].voxel), std::tie(line.near, line.voxel));
        }
    }
}

TEST(IndexTable, IsInOrderAfterEveryVoxelAndEveryPieceThatJoinsTheLastOne) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        std::vector<IndexEntry> table;
        std::vector<Depths> runs;
        for (int i = random.whole(1, 40); i > 0; --i) {
            const double near = random.whole(0, 12);
            const double far = near + random.whole(1, 8);
            if (!runs.empty() && random.chance(0.3)) {
                runs.back() = {std::min(near, runs.back().near), std::max(far, runs.back().far)};
            } else {
                runs.push_back({near, far});
            }
            const auto number = std::uint32_t(runs.size() - 1);
            const std::uint32_t read = put_in_order(table, number, runs.back().near, runs.back().far);
            ASSERT_NO_FATAL_FAILURE(expect_in_order(table, runs));
            ASSERT_EQ(table[table.size() - read].voxel, number) << "every line from its place on was read";
        }
    }
}

TEST(IndexTable, IsTheSameMadeAtOnceFromTheVoxelsAsVoxelByVoxel) {
    for (const std::uint64_t seed : property::seeds(1, 6)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const CellScene scene = shapes::random_polygons(random, 30);
        for (const HitTest rung : shapes::every_rung) {
            const PictureSettings settings = shapes::settings_for(scene, rung, Numbers::fixed);
            const Context context(scene, settings);
            for (CellStore& cell : load_array(scene, settings, context.arithmetic)) {
                const std::vector<IndexEntry> table = cell.index;
                std::vector<Depths> runs;
                for (const Voxel& voxel : cell.voxels) runs.push_back({voxel.near, voxel.far});
                ASSERT_NO_FATAL_FAILURE(expect_in_order(table, runs));
                make_index(cell);
                ASSERT_NO_FATAL_FAILURE(expect_in_order(cell.index, runs));
            }
        }
    }
}

/// The nearest hit of all voxels whose runs meet the ray's, each of them tested.
std::optional<CellHit> search_all(const CellStore& store, const Ray& ray, double t_end, HitTest rung,
                                  const Arithmetic& arithmetic, Comparisons& made) {
    std::optional<CellHit> best;
    const double z1 = depth_at(ray, t_end, arithmetic);
    for (std::uint32_t i = 0; i < store.voxels.size(); ++i) {
        const Voxel& voxel = store.voxels[i];
        ++made.runs;
        if (voxel.near > std::max(ray.position.z, z1) + arithmetic.hair()) continue;
        if (voxel.far < std::min(ray.position.z, z1) - arithmetic.hair()) continue;
        ++made.tests;
        const auto t = hit_voxel(store, voxel, ray, t_end, rung, arithmetic);
        if (t && (!best || *t < best->t)) best = CellHit{*t, i};
    }
    return best;
}

TEST(IndexTable, ASearchThroughItFindsTheNearestOfAllVoxelsWithFewerTests) {
    Comparisons all;
    Comparisons fewer;
    int hits = 0;
    for (const std::uint64_t seed : property::seeds(1, 8)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const CellScene scene = shapes::random_polygons(random, 30);
        for (const Numbers numbers : shapes::both_arithmetics) {
            for (const HitTest rung : shapes::every_rung) {
                SCOPED_TRACE("rung " + std::to_string(int(rung)));
                const PictureSettings settings = shapes::settings_for(scene, rung, numbers);
                const Context context(scene, settings);
                const Arithmetic& arithmetic = context.arithmetic;
                const auto cells = load_array(scene, settings, arithmetic);
                for (int i = 0; i < 300; ++i) {
                    const dvec3 share{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
                    int x = 0;
                    int y = 0;
                    const Ray ray = walker::ray_at(context, share * scene.frame.cube().high,
                                                   shapes::sloped_direction(random), x, y);
                    const CellStore& store = cells[std::size_t(y * scene.frame.width + x)];
                    const double t_end = next_crossing(ray, arithmetic).t;
                    const auto wanted = search_all(store, ray, t_end, rung, arithmetic, all);
                    const auto found = nearest_in_cell(store, ray, t_end, rung, arithmetic, &fewer);
                    ASSERT_EQ(found.has_value(), wanted.has_value());
                    if (!found) continue;
                    ++hits;
                    if (std::abs(found->t - wanted->t) <= arithmetic.tie()) continue;
                    // Only a hit that its voxel's tolerance let stand outside its run may be passed over.
                    const Voxel& passed = store.voxels[wanted->voxel];
                    const double z = depth_at(ray, wanted->t, arithmetic);
                    ASSERT_TRUE(z < passed.near || z > passed.far)
                        << "found " << found->t << ", nearest " << wanted->t;
                }
            }
        }
    }
    EXPECT_GT(hits, 1000);
    EXPECT_LT(fewer.runs, all.runs);
    EXPECT_LT(fewer.tests, all.tests);
}

}  // namespace
}  // namespace raycell
