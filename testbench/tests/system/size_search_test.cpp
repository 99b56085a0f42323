// The search of `raycell size` on made-up machines, compared with trying all of them.
#include "testbench/raycell/size_search.hpp"

#include <atomic>
#include <cmath>
#include <set>

#include "testbench/tests/property.hpp"

namespace raycell {
namespace {

const std::vector<HitTest> rungs = {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask,
                                    HitTest::edge};
const std::vector<int> all_levels = {1000, 512, 256, 128, 64, 32, 16, 8, 4, 2, 1};

/// Machines whose accuracy grows with the word length and, at rungs with a plane, with the depth levels. The
/// noise depends only on the setting and is smaller than what the search allows for.
class MadeUpModel : public SizeModel {
  public:
    explicit MadeUpModel(std::uint64_t seed, double noise_db = 0.45) : seed_(seed), noise_db_(noise_db) {
        property::Random random(seed);
        double best = random.uniform(12, 20);
        for (double& limit : limit_) limit = best += random.uniform(0, 12);
        voxel_loss_ = random.uniform(0, 4);
        precast_loss_ = random.uniform(0, 4);
        offset_ = random.uniform(15, 35);
        level_loss_ = random.uniform(0, 1.5);
        for (auto& row : box_loss_) {
            for (double& loss : row) loss = random.uniform(0, 8);
        }
        for (int i = 0; i < 5; ++i) cells_.push_back({random.whole(1, 30), random.whole(0, 60)});
        edge_growth_ = random.uniform(0, 0.5);
        hair_ = random.chance(0.5) ? random.uniform(0, 1) : 0;
    }

    StorageCounts storage(const SizeSetting& s) const override {
        PictureSettings picture;
        picture.hit = s.hit;
        picture.normals = s.normals;
        picture.shadows = s.shadows;
        picture.depth_levels = s.depth_levels;
        const VoxelBits each = voxel_bits(picture, Formats(s.word_bits, Rounding::nearest, {}), 2);
        StorageCounts counts;
        for (const auto& [voxels, edges] : cells_) {
            const int few = s.hit == HitTest::depth ? (voxels + 1) / 2 : voxels;
            CellStore cell;
            // Short words store more voxels, as their tolerances are wider.
            cell.voxels.resize(std::size_t(few * (1 + hair_ * std::exp2(8 - s.word_bits))));
            const double growth = 1 + edge_growth_ * double(coarseness(s));
            if (s.hit == HitTest::edge) cell.edges.resize(std::size_t(edges * growth));
            counts.add(cell, each);
        }
        return counts;
    }

    SizeTrial run(const SizeSetting& s) const override {
        ++runs;
        SizeTrial trial;
        trial.setting = s;
        trial.storage = storage(s);
        const double noise = this->noise(s);
        trial.accuracy.psnr_db = std::min(200.0, smooth(s) + noise_db_ * noise);
        trial.accuracy.wrong_hit_percent = 100 * std::pow(10, -smooth(s) / 20) * (1 + 0.1 * noise);
        return trial;
    }

    mutable std::atomic<int> runs{0};

  private:
    static std::size_t coarseness(const SizeSetting& s) {
        std::size_t index = 0;
        while (all_levels[index] != s.depth_levels) ++index;
        return index;
    }

    /// PSNR in dB without noise.
    double smooth(const SizeSetting& s) const {
        const bool box = s.hit == HitTest::depth || s.hit == HitTest::interval;
        double limit = limit_[std::size_t(s.hit)];
        limit -= box ? box_loss_[std::size_t(s.hit)][coarseness(s)] : level_loss_ * double(coarseness(s));
        if (s.normals == Normals::voxel) limit -= voxel_loss_;
        if (s.shadows == Shadows::precast) limit -= precast_loss_;
        const double words = 6.02 * s.word_bits - offset_;
        return -10 * std::log10(std::pow(10, -limit / 10) + std::pow(10, -words / 10));
    }

    /// Noise from -1 to 1.
    double noise(const SizeSetting& s) const {
        std::uint64_t key = seed_;
        for (const int part : {int(s.hit), int(s.normals), int(s.shadows), s.depth_levels, s.word_bits}) {
            key = key * 65599 + std::uint64_t(part) + 1;
        }
        return property::Random(key).uniform(-1, 1);
    }

    std::uint64_t seed_;
    double noise_db_;
    double limit_[5];
    double box_loss_[2][11];
    double voxel_loss_;
    double precast_loss_;
    double level_loss_;
    double offset_;
    double edge_growth_;
    double hair_;
    std::vector<std::pair<int, int>> cells_;
};

/// The least cost, found by trying every setting.
std::optional<SizeCost> least_cost(const MadeUpModel& model, const SizeGoal& goal) {
    std::optional<SizeCost> least;
    for (const HitTest hit : rungs) {
        for (const Normals normals : {Normals::voxel, Normals::linear}) {
            for (const Shadows shadows : {Shadows::per_hit, Shadows::precast, Shadows::memo}) {
                for (const int levels : all_levels) {
                    for (int words = least_word_bits; words <= most_word_bits; ++words) {
                        SizeTrial trial = model.run({hit, normals, shadows, levels, words});
                        // precast and memo give the same picture.
                        if (shadows == Shadows::memo) {
                            trial.accuracy =
                                model.run({hit, normals, Shadows::precast, levels, words}).accuracy;
                        }
                        if (!goal.met_by(trial.accuracy)) continue;
                        const SizeCost cost = cost_of(trial.storage);
                        if (!least || cost < *least) least = cost;
                    }
                }
            }
        }
    }
    return least;
}

void expect_least(std::uint64_t seed, const SizeGoal& goal) {
    SCOPED_TRACE(property::rerun(seed));
    const MadeUpModel model(seed);
    SizeSearch search(model, goal, all_levels);
    const auto found = search.find();
    EXPECT_EQ(std::size_t(model.runs), search.tried().size()) << "every run is listed";
    EXPECT_LT(model.runs, 400) << "of 5500 settings";
    std::set<SizeSetting> settings;
    for (const SizeTrial& trial : search.tried()) {
        EXPECT_TRUE(settings.insert(trial.setting).second) << "nothing is run twice";
        EXPECT_EQ(trial.meets, goal.met_by(trial.accuracy));
    }
    const auto least = least_cost(model, goal);
    ASSERT_EQ(found.has_value(), least.has_value());
    if (!found) {
        EXPECT_FALSE(search.nearest().meets);
        return;
    }
    EXPECT_TRUE(goal.met_by(found->accuracy));
    EXPECT_EQ(cost_of(found->storage), *least);
}

TEST(SizeSearch, FindsTheSmallestOfAllMachinesThatReachAPsnr) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        expect_least(seed, {property::Random(seed).uniform(10, 60), 100});
    }
}

TEST(SizeSearch, FindsTheSmallestOfAllMachinesWithFewEnoughWrongHits) {
    for (const std::uint64_t seed : property::seeds(101, 30)) {
        expect_least(seed, {0, std::pow(10, property::Random(seed).uniform(-1, 1.5))});
    }
}

TEST(SizeSearch, FindsTheSmallestOfAllMachinesThatReachBoth) {
    for (const std::uint64_t seed : property::seeds(201, 30)) {
        property::Random random(seed);
        expect_least(seed, {random.uniform(10, 50), std::pow(10, random.uniform(-1, 1.5))});
    }
}

TEST(SizeSearch, WhereItsAssumptionsFailStillNothingOneStepSmallerMeetsTheGoal) {
    for (const std::uint64_t seed : property::seeds(301, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        const MadeUpModel model(seed, 6);
        const SizeGoal goal{property::Random(seed).uniform(10, 60), 100};
        SizeSearch search(model, goal, all_levels);
        const auto found = search.find();
        if (!found) continue;
        const auto expect_not = [&](const SizeSetting& step) {
            if (!(cost_of(model.storage(step)) < cost_of(found->storage))) return;
            EXPECT_FALSE(goal.met_by(model.run(step).accuracy));
        };
        const auto [hit, normals, shadows, levels, words] = found->setting;
        if (words > least_word_bits) expect_not({hit, normals, shadows, levels, words - 1});
        if (levels > 1) expect_not({hit, normals, shadows, levels == 1000 ? 512 : levels / 2, words});
        if (hit != HitTest::depth) expect_not({HitTest(int(hit) - 1), normals, shadows, levels, words});
        expect_not({hit, Normals::voxel, shadows, levels, words});
        expect_not({hit, normals, Shadows::per_hit, levels, words});
    }
}

/// Machines whose accuracy is random and independent of their size.
class RandomModel : public MadeUpModel {
  public:
    RandomModel(std::uint64_t seed, double most_db) : MadeUpModel(seed), seed_(seed), most_db_(most_db) {}

    SizeTrial run(const SizeSetting& s) const override {
        SizeTrial trial = MadeUpModel::run(s);
        property::Random random(seed_ * 7919 + std::uint64_t(trial.accuracy.wrong_hit_percent * 1e9));
        trial.accuracy.psnr_db = random.uniform(0, most_db_);
        trial.accuracy.wrong_hit_percent = random.uniform(0, 40);
        return trial;
    }

  private:
    std::uint64_t seed_;
    double most_db_;
};

TEST(SizeSearch, WhateverTheTableSaysTheFoundIsTheSmallestRowThatMeetsAndNoneIsSaidWhereNoneDoes) {
    int in_vain = 0;
    for (const std::uint64_t seed : property::seeds(401, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const RandomModel model(seed, 100);
        const SizeGoal goal{random.uniform(60, 101), random.chance(0.5) ? 100 : random.uniform(1, 40)};
        SizeSearch search(model, goal, all_levels);
        const auto found = search.find();
        const SizeTrial* smallest = nullptr;
        for (const SizeTrial& trial : search.tried()) {
            EXPECT_EQ(trial.meets, goal.met_by(trial.accuracy));
            if (!trial.meets) continue;
            if (!smallest || cost_of(trial.storage) < cost_of(smallest->storage)) smallest = &trial;
        }
        ASSERT_EQ(found.has_value(), smallest != nullptr);
        if (found) {
            EXPECT_TRUE(found->meets);
            EXPECT_EQ(cost_of(found->storage), cost_of(smallest->storage));
        } else {
            ++in_vain;
            EXPECT_FALSE(search.nearest().meets);
        }
    }
    EXPECT_TRUE(in_vain > 0 && in_vain < 200) << "else this tests nothing: " << in_vain;
}

/// The longest words miss the goal by far; shorter words of the same setting are lucky.
TEST(SizeSearch, FindsShorterWordsThatAreLuckyBeforeItSaysNone) {
    class LuckyModel : public MadeUpModel {
      public:
        LuckyModel() : MadeUpModel(5) {}
        SizeTrial run(const SizeSetting& s) const override {
            SizeTrial trial = MadeUpModel::run(s);
            trial.accuracy.psnr_db = s.word_bits == 19 ? 40 : 30;
            return trial;
        }
    };
    const LuckyModel model;
    SizeSearch search(model, {35, 100}, all_levels);
    const auto found = search.find();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->setting.word_bits, 19);
    EXPECT_TRUE(found->meets);
}

TEST(SizeSearch, TriesTheSameInTheSameOrderEveryTime) {
    const MadeUpModel model(7);
    SizeSearch first(model, {28, 100}, all_levels);
    SizeSearch second(model, {28, 100}, all_levels);
    first.find();
    second.find();
    ASSERT_EQ(first.tried().size(), second.tried().size());
    for (std::size_t i = 0; i < first.tried().size(); ++i) {
        EXPECT_FALSE(first.tried()[i].setting < second.tried()[i].setting);
        EXPECT_FALSE(second.tried()[i].setting < first.tried()[i].setting);
    }
}

TEST(SizeSearch, AGoalThatEverythingReachesTakesTheSmallestMachineOfAll) { expect_least(3, {0, 100}); }

}  // namespace
}  // namespace raycell
