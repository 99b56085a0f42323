// A cell only runs when something may have changed. A cell that runs in every cycle, as hardware does, must
// do the same in the same cycles: nothing may depend on how often a cell is woken.
#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {
namespace {

struct Case {
    const char* scene;
    Networks networks;
    Shadows shadows;
    int ray_store;
    int link_bits;
    double stall;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.scene << " networks " << int(c.networks) << " shadows " << int(c.shadows) << " M "
               << c.ray_store << " links " << c.link_bits << " stall " << c.stall;
}

class EveryCycle : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        expect_first_elaboration();
        settings_.width = settings_.height = 12;
        settings_.shadows = GetParam().shadows;
        machine_.networks = GetParam().networks;
        machine_.ray_store = GetParam().ray_store;
        machine_.link_bits = GetParam().link_bits;
        machine_.stall = GetParam().stall;
        placed_ = place_own_scene(GetParam().scene, settings_);
    }
    std::unique_ptr<Machine> machine(const char* name) {
        return std::make_unique<Machine>(name, placed_->scene, settings_, machine_, placed_->exterior.get());
    }
    PictureSettings settings_;
    MachineSettings machine_ = estimated_machine();  // quick: every cycle of loading is run
    std::unique_ptr<PlacedScene> placed_;
};

using LastCycles = std::array<Cycle, 3>;  ///< of each phase

/// Records the last cycle that is run in each phase.
void watch_phases(Machine& machine, LastCycles& last) {
    machine.environment().scheduler.set_sampler(
        [&machine, &last](Cycle now) { last[std::size_t(machine.environment().phase)] = now; });
}

/// Wakes every cell in every cycle of a phase, up to the last cycle recorded. A phase begins one cycle after
/// the end of the one before.
void run_in_every_cycle(Machine& machine, const LastCycles& last) {
    Scheduler& scheduler = machine.environment().scheduler;
    scheduler.set_sampler([&machine, &scheduler, &last](Cycle) {
        if (scheduler.next() == never) return;
        const Cycle next = scheduler.next() + 1;
        if (next > last[std::size_t(machine.environment().phase)]) return;
        for (Cell& cell : machine.array().cells()) scheduler.wake(cell, next);
    });
}

TEST_P(EveryCycle, ACellThatRunsInEveryCycleDoesTheSameInTheSameCycles) {
    const auto woken = machine("woken");
    const auto clocked = machine("clocked");
    LastCycles last{};
    watch_phases(*woken, last);
    const RunResult a = woken->run();
    run_in_every_cycle(*clocked, last);
    const RunResult b = clocked->run();
    EXPECT_EQ(a.verdict, Verdict::completed);
    EXPECT_EQ(b.verdict, Verdict::completed);
    EXPECT_GT(clocked->environment().scheduler.activations(),
              3 * woken->environment().scheduler.activations());
    EXPECT_EQ(a.load_cycles, b.load_cycles);
    EXPECT_EQ(a.trace_cycles, b.trace_cycles);
    EXPECT_EQ(a.schedule_hash, b.schedule_hash);
    EXPECT_EQ(image_hash(a.picture), image_hash(b.picture));
}

INSTANTIATE_TEST_SUITE_P(Machines, EveryCycle,
                         ::testing::Values(Case{"cornell", Networks::half, Shadows::per_hit, 8, 20, 0},
                                           Case{"cornell", Networks::quadrant, Shadows::per_hit, 5, 3, 0},
                                           Case{"cornell", Networks::half, Shadows::per_hit, 5, 1000, 0},
                                           Case{"still_life", Networks::half, Shadows::memo, 6, 40, 0.3},
                                           Case{"still_life", Networks::half, Shadows::precast, 6, 7, 0},
                                           Case{"cornell", Networks::split, Shadows::per_hit, 64, 20, 0},
                                           Case{"facing_mirrors", Networks::quadrant, Shadows::per_hit, 6, 20,
                                                0.2}));

}  // namespace
}  // namespace raycell
