// The search of `raycell size --frame-cycles` on made-up machines, compared with trying all of them.
#include "testbench/raycell/size_frame_search.hpp"

#include <cmath>

#include "testbench/tests/property.hpp"

namespace raycell {
namespace {

std::vector<FrameAxis> small_axes() {
    return {{"tessellate-for", {"30", "33", "40"}, true}, {"hit", {"depth", "plane", "edge"}, true},
            {"normals", {"voxel", "linear"}, true},       {"shadows", {"per-hit", "precast"}, true},
            {"word-bits", {"10", "14", "20"}, true},      {"ray-store", {"6", "8"}, false},
            {"buffer", {"1", "2", "4"}, false},           {"traversal-units", {"1", "2", "4"}, false}};
}

/// Every value of a picture's axes brings dB and bits, every value of the others takes cycles and costs bits.
class MadeUpFrames : public FrameModel {
  public:
    explicit MadeUpFrames(std::uint64_t seed) : axes_(small_axes()) {
        property::Random random(seed);
        for (const FrameAxis& axis : axes_) {
            for (std::size_t i = 0; i < axis.values.size(); ++i) {
                gains_.push_back(random.uniform(0, 8));
                bits_.push_back(std::uint64_t(random.whole(0, 2000)));
                cycles_.push_back(random.uniform(0.5, 0.95));
            }
        }
    }

    std::vector<FrameTrial> run(const std::vector<FramePoint>& points, bool timed) const override {
        std::vector<FrameTrial> trials;
        for (const FramePoint& point : points) trials.push_back(one(point, timed));
        runs += points.size();
        return trials;
    }
    std::uint64_t loading_floor(const FramePoint&, std::uint64_t voxels) const override { return voxels; }

    /// The smallest machine in time with a picture's hit test, normals, shadows and chord error of those
    /// given.
    std::optional<FrameTrial> smallest(const FrameGoal& goal) const {
        std::optional<FrameTrial> best;
        for_all([&](const FramePoint& point) {
            const FrameTrial t = one(point, true);
            if (goal.met_by(t) && (!best || t.bits < best->bits)) best = t;
        });
        return best;
    }
    template <typename See>
    void for_all(const See& see) const {
        FramePoint point(axes_.size(), 0);
        for (bool more = true; more;) {
            see(point);
            more = false;
            for (std::size_t i = 0; i < axes_.size() && !more; ++i) {
                more = ++point[i] < axes_[i].values.size();
                if (!more) point[i] = 0;
            }
        }
    }

    mutable std::size_t runs = 0;

  private:
    FrameTrial one(const FramePoint& point, bool timed) const {
        FrameTrial t;
        t.point = point;
        t.bits = 5000;
        t.most_voxels = 10;
        t.accuracy.psnr_db = 15;
        double cycles = 4e5;
        std::size_t at = 0;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            for (std::size_t v = 0; v < axes_[i].values.size(); ++v, ++at) {
                if (v > point[i] || v == 0) continue;
                t.bits += bits_[at];
                if (axes_[i].picture && axes_[i].option != "shadows") t.accuracy.psnr_db += gains_[at];
                if (!axes_[i].picture) cycles *= cycles_[at];
            }
        }
        t.voxel_bits = t.bits;
        if (timed) {
            t.verdict = "completed";
            t.load = std::uint64_t(cycles / 4);
            t.trace = std::uint64_t(cycles) - t.load;
        }
        return t;
    }

    const std::vector<FrameAxis> axes_;
    std::vector<double> gains_;
    std::vector<std::uint64_t> bits_;
    std::vector<double> cycles_;
};

FramePoint best_picture() { return {2, 2, 1, 0, 2, 0, 0, 0}; }

FrameGoal goal_of(double psnr, std::uint64_t cycles) {
    FrameGoal goal;
    goal.accuracy.psnr_db = psnr;
    goal.cycles = cycles;
    return goal;
}

TEST(FrameSearch, FindsAMachineThatMeetsTheGoalsWhereOneDoesAndNoneOneStepSmaller) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed + 1000);
        const MadeUpFrames model(seed);
        const FrameGoal goal = goal_of(random.uniform(15, 45), std::uint64_t(random.uniform(5e4, 4e5)));
        FrameSearch search(model, goal, small_axes(), best_picture());
        const std::optional<FrameTrial> found = search.find();
        const std::optional<FrameTrial> smallest = model.smallest(goal);
        ASSERT_EQ(found.has_value(), smallest.has_value());
        if (!found) continue;
        EXPECT_TRUE(found->meets && goal.met_by(*found));
        EXPECT_GE(found->bits, smallest->bits);
        for (const std::size_t axis : {4U, 5U, 6U, 7U}) {
            FramePoint less = found->point;
            if (less[axis] == 0) continue;
            --less[axis];
            const FrameTrial t = model.run({less}, true).front();
            EXPECT_FALSE(goal.met_by(t) && t.bits < found->bits) << "axis " << axis;
        }
    }
}

TEST(FrameSearch, TriesFarFewerMachinesThanThereAre) {
    const MadeUpFrames model(3);
    FrameSearch search(model, goal_of(30, 200000), small_axes(), best_picture());
    search.find();
    std::size_t all = 0;
    model.for_all([&](const FramePoint&) { ++all; });
    EXPECT_LT(model.runs * 10, all);
}

TEST(FrameSearch, NamesTheNearestWhereNoMachineIsAccurateEnoughOrInTime) {
    const MadeUpFrames model(5);
    FrameSearch accuracy(model, goal_of(100, 400000), small_axes(), best_picture());
    EXPECT_FALSE(accuracy.find());
    for (const FrameTrial& t : accuracy.tried())
        EXPECT_LE(t.accuracy.psnr_db, accuracy.nearest().accuracy.psnr_db);
    FrameSearch time(model, goal_of(20, 1000), small_axes(), best_picture());
    EXPECT_FALSE(time.find());
    EXPECT_TRUE(time.nearest().ended());
    EXPECT_GE(time.nearest().accuracy.psnr_db, 20);
    for (const FrameTrial& t : time.tried()) {
        if (t.ended()) EXPECT_GE(t.cycles(), time.nearest().cycles());
    }
}

TEST(FrameSearch, PutsOnTheParetoFrontWhatNoOtherMachineBeats) {
    const MadeUpFrames model(7);
    std::vector<FrameTrial> trials;
    std::size_t number = 0;
    model.for_all([&](const FramePoint& point) {
        if (++number % 7 == 0) trials.push_back(model.run({point}, number % 21 != 0).front());
    });
    const std::vector<bool> front = pareto_front(trials);
    ASSERT_EQ(front.size(), trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
        bool beaten = !trials[i].ended();
        for (const FrameTrial& other : trials) {
            const bool no_worse = other.ended() && other.bits <= trials[i].bits &&
                                  other.cycles() <= trials[i].cycles() &&
                                  other.accuracy.psnr_db >= trials[i].accuracy.psnr_db;
            beaten =
                beaten || (no_worse && (other.bits < trials[i].bits || other.cycles() < trials[i].cycles() ||
                                        other.accuracy.psnr_db > trials[i].accuracy.psnr_db));
        }
        EXPECT_EQ(front[i], !beaten) << i;
    }
}

}  // namespace
}  // namespace raycell
