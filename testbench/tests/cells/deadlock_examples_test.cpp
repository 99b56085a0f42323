// One small machine for each combination that, by cells/deadlock/deadlock.md, need not end, and beside it the
// one that does.
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {
namespace {

/// Runs machines with different settings on one scene, one after the other in one process.
class Variants {
  public:
    using Change = std::function<void(MachineSettings&)>;

    Variants(const CellScene& scene, const PictureSettings& settings, const ExteriorTracer* exterior,
             const std::vector<Change>& changes) {
        expect_first_elaboration();
        golden_ = image_hash(UntimedMachine(scene, settings, exterior).render());
        std::vector<Machine*> machines;  // never destroyed: SystemC destroys ports in quadratic time
        for (const Change& change : changes) {
            MachineSettings machine = estimated_machine();
            machine.costs.backoff = 4;  // short, since each livelock must be waited for
            change(machine);
            const std::string name = "machine_" + std::to_string(machines.size());
            machines.push_back(new Machine(name.c_str(), scene, settings, machine, exterior));
        }
        for (Machine* machine : machines) results_.push_back(machine->run());
    }

    const RunResult& operator[](std::size_t i) const { return results_[i]; }
    void expect_stuck(std::size_t i, Verdict verdict) const {
        EXPECT_EQ(name_of(results_[i].verdict), std::string(name_of(verdict))) << "machine " << i;
        EXPECT_FALSE(results_[i].report.empty());
    }
    void expect_picture(std::size_t i) const {
        EXPECT_EQ(name_of(results_[i].verdict), std::string("completed")) << "machine " << i;
        EXPECT_EQ(image_hash(results_[i].picture), golden_) << "machine " << i;
    }

  private:
    std::vector<RunResult> results_;
    std::uint64_t golden_ = 0;
};

Variants of_own_scene(const std::string& name, int cells, int max_depth,
                      const std::vector<Variants::Change>& changes,
                      double min_weight = PictureSettings().min_weight) {
    PictureSettings settings;
    settings.width = settings.height = cells;
    settings.max_depth = max_depth;
    settings.min_weight = min_weight;
    const auto placed = place_own_scene(name, settings);
    return Variants(placed->scene, settings, placed->exterior.get(), changes);
}

/// Two cells. The ray of pixel (0, 0) meets a mirror at 45 degrees, goes east, comes straight back from a
/// mirror in cell (1, 0) and meets the first mirror again. Its third hit needs a slot in the cell that holds
/// its first.
CellScene there_and_back() {
    CellScene scene = hand_made::cube(2, 1, 6);
    scene.frame.depth_levels = 60;
    const std::uint32_t mirror = hand_made::add_object(scene, hand_made::mirror(0.9));
    hand_made::add_rectangle(scene, mirror, {0.1, 0, 2.6}, {0, 1, 0}, {0.8, 0, 0.8});
    hand_made::add_rectangle(scene, mirror, {1.75, 0, 2}, {0, 1, 0}, {0, 0, 2});
    return scene;
}

bool names(const RunResult& result, const std::string& cell, const std::string& tree) {
    return std::any_of(result.report.begin(), result.report.end(), [&](const std::string& line) {
        return line.find("cell " + cell) != std::string::npos &&
               line.find("ray " + tree + "/") != std::string::npos;
    });
}

TEST(TimedDeadlockExamples, ATreeThatComesBackToItsOnlySlotPostponesItselfForEverAndIsNamed) {
    const CellScene scene = there_and_back();
    PictureSettings settings;
    settings.width = 2;
    settings.height = 1;
    settings.exterior = ExteriorMode::none;
    const Variants run(scene, settings, nullptr,
                       {[](MachineSettings& m) { m.ray_store = 1; },
                        [](MachineSettings& m) { m.ray_store = 1, m.recovery = Recovery::none; },
                        [](MachineSettings& m) { m.ray_store = 1, m.slots = Slots::free; },
                        [](MachineSettings& m) { m.ray_store = 2; },  // below the bound of 4, but it ends
                        [](MachineSettings& m) { m.ray_store = 4; },
                        [](MachineSettings& m) { m.ray_store = 2, m.recovery = Recovery::none; }});
    run.expect_stuck(0, Verdict::livelock);
    EXPECT_TRUE(names(run[0], "(0, 0)", "0"));
    EXPECT_TRUE(names(run[0], "(1, 0)", "0"));
    run.expect_stuck(1, Verdict::deadlock);
    EXPECT_TRUE(names(run[1], "(0, 0)", "0"));
    run.expect_stuck(2, Verdict::livelock);
    for (const std::size_t i : {3, 4, 5}) run.expect_picture(i);
    EXPECT_EQ(run[0].counters.pixels_done, 1u) << "the other pixel sees the background";
}

TEST(TimedDeadlockExamples, ARayThatWaitsForASlotAtTheHeadOfABufferLocksWherePostponingEnds) {
    // M is at the bound: one slot for each of three generations. For this scene, one more slot is enough.
    const Variants run =
        of_own_scene("still_life", 8, 2,
                     {[](MachineSettings& m) { m.ray_store = 3, m.recovery = Recovery::none; },
                      [](MachineSettings& m) { m.ray_store = 3; },
                      [](MachineSettings& m) { m.ray_store = 4, m.recovery = Recovery::none; }});
    run.expect_stuck(0, Verdict::deadlock);
    EXPECT_EQ(run[0].counters.rays_destroyed, 0u);
    run.expect_picture(1);
    EXPECT_GT(run[1].counters.rays_destroyed, 0u);
    run.expect_picture(2);
}

TEST(TimedDeadlockExamples, FreeSlotsAreALivelockWhereReservedAndNestedOnesEnd) {
    const Variants run = of_own_scene("still_life", 20, 3,
                                      {[](MachineSettings& m) { m.ray_store = 4, m.slots = Slots::free; },
                                       [](MachineSettings& m) { m.ray_store = 4; },
                                       [](MachineSettings& m) { m.ray_store = 4, m.slots = Slots::nested; }},
                                      0);
    run.expect_stuck(0, Verdict::livelock);
    run.expect_picture(1);
    run.expect_picture(2);
}

TEST(TimedDeadlockExamples, NoRayStoreIsLargeEnoughForSharedOrSplitBuffersOfOne) {
    const auto plenty = [](Networks networks) {
        return [=](MachineSettings& m) { m.ray_store = 1000, m.networks = networks; };
    };
    const Variants run = of_own_scene("still_life", 16, 4,
                                      {plenty(Networks::shared), plenty(Networks::split),
                                       plenty(Networks::half), plenty(Networks::quadrant)});
    run.expect_stuck(0, Verdict::deadlock);
    run.expect_stuck(1, Verdict::deadlock);
    run.expect_picture(2);
    run.expect_picture(3);
    for (const std::size_t i : {0, 1}) {
        EXPECT_EQ(run[i].counters.rays_destroyed, 0u) << "there was a slot for every ray";
        EXPECT_LT(run[i].ray_store_peak, 1000);
    }
}

TEST(TimedDeadlockExamples, TheSamePictureComesFromEveryRayStoreFromTheBoundOn) {
    std::vector<Variants::Change> changes;
    for (const Networks networks : {Networks::half, Networks::quadrant}) {
        for (const int m : {5, 6, 7, 8, 12, 16, 1000}) {
            changes.push_back(
                [=](MachineSettings& machine) { machine.ray_store = m, machine.networks = networks; });
        }
    }
    const Variants run = of_own_scene("still_life", 16, 4, changes);
    for (std::size_t i = 0; i < changes.size(); ++i) run.expect_picture(i);
    EXPECT_GT(run[0].counters.rays_destroyed, 0u) << "at the bound something was postponed";
}

}  // namespace
}  // namespace raycell
