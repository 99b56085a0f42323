// Wherever a run is stopped, every message sent has been delivered or is still there; a machine that
// miscounts ends in an error.
#include <map>

#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {
namespace {

/// Equal machines, to be stopped at different cycles, one after the other.
class Machines {
  public:
    explicit Machines(std::size_t count, Shadows shadows = Shadows::precast) {
        expect_first_elaboration();
        settings_.width = settings_.height = 8;
        settings_.shadows = shadows;
        placed_ = place_own_scene("facing_mirrors", settings_);
        MachineSettings machine = estimated_machine();
        machine.buffer_depth = 2;
        machine.ray_store = waiting_generations(Context(placed_->scene, settings_));  // fewest that end
        machine.exterior_processors = 3;  // few and slow: rays wait in them
        machine.exterior_latency = 500;
        for (std::size_t i = 0; i < count; ++i) {
            // Never destroyed: SystemC destroys ports in quadratic time.
            machines_.push_back(new Machine(("machine_" + std::to_string(i)).c_str(), placed_->scene,
                                            settings_, machine, placed_->exterior.get()));
        }
    }
    Machine& operator[](std::size_t i) { return *machines_[i]; }
    RunResult run_until(std::size_t i, Cycle limit) {
        machines_[i]->environment().scheduler.set_limit(limit);
        return machines_[i]->run();
    }

  private:
    PictureSettings settings_;
    std::unique_ptr<PlacedScene> placed_;
    std::vector<Machine*> machines_;
};

/// The sums that a run checks at its end, recomputed from its result.
void expect_sums(const RunResult& result) {
    const Counters& c = result.counters;
    EXPECT_EQ(c.rays_sent, c.rays_answered + c.rays_silent + c.rays_destroyed + result.in_flight.rays);
    EXPECT_EQ(c.answers_sent, c.answers_delivered + result.in_flight.answers);
    EXPECT_EQ(c.loads_sent, c.loads_delivered + result.in_flight.loads);
}

constexpr std::size_t stops = 200;

TEST(TimedConservation, HoldsWhereverTheLoadingIsStopped) {
    Machines machines(stops + 1);
    const Cycle loaded = machines[0].run().load_cycles;
    InFlight most;
    for (std::size_t i = 1; i <= stops; ++i) {
        const RunResult result = machines.run_until(i, i * loaded / (stops + 1));
        EXPECT_EQ(name_of(result.verdict), std::string("cycle_limit"));
        EXPECT_EQ(result.counters.rays_sent, 0u);
        expect_sums(result);
        most.loads = std::max(most.loads, result.in_flight.loads);
        most.upstream = std::max(most.upstream, result.in_flight.upstream);
    }
    EXPECT_GT(most.loads, 8u);
    EXPECT_GT(most.upstream, 8u);
}

TEST(TimedConservation, HoldsWhereverRaysAndAnswersAreStopped) {
    Machines machines(stops + 1);
    const RunResult whole = machines[0].run();
    ASSERT_EQ(name_of(whole.verdict), std::string("completed"));
    EXPECT_GT(whole.counters.rays_silent, 0u);
    EXPECT_GT(whole.counters.rays_destroyed, 0u);
    EXPECT_EQ(whole.in_flight.rays + whole.in_flight.answers, 0u);
    InFlight most;
    std::uint64_t most_in_processors = 0;
    std::size_t while_tracing = 0;
    for (std::size_t i = 1; i <= stops; ++i) {
        const Cycle limit = whole.load_cycles + i * (whole.ended - whole.load_cycles) / (stops + 1);
        const RunResult result = machines.run_until(i, limit);
        EXPECT_EQ(name_of(result.verdict), std::string("cycle_limit"));
        expect_sums(result);
        most.rays = std::max(most.rays, result.in_flight.rays);
        most.answers = std::max(most.answers, result.in_flight.answers);
        most_in_processors = std::max(most_in_processors,
                                      result.in_flight.rays - machines[i].environment().pools.rays.in_use());
        while_tracing += result.trace_cycles > 0 ? 1 : 0;
    }
    EXPECT_GT(most.rays, 64u);
    EXPECT_GT(most.answers, 0u);
    EXPECT_EQ(most_in_processors, 3u) << "all of them were at work";
    EXPECT_GT(while_tracing, 0u);
    EXPECT_LT(while_tracing, stops) << "some were stopped while casting in advance";
}

using Counter = std::uint64_t Counters::*;
const std::map<std::string, Counter> counters{
    {"rays sent", &Counters::rays_sent},           {"rays answered", &Counters::rays_answered},
    {"rays silent", &Counters::rays_silent},       {"rays destroyed", &Counters::rays_destroyed},
    {"answers sent", &Counters::answers_sent},     {"answers delivered", &Counters::answers_delivered},
    {"load messages sent", &Counters::loads_sent}, {"load messages delivered", &Counters::loads_delivered}};

/// Stops machines in the middle of loading or tracing, each with one counter off by one; expects an error.
void expect_miscounting_is_seen(bool while_loading) {
    // The precast phase ends by these counters, so shadows are per hit here.
    Machines machines(counters.size() + 1, Shadows::per_hit);
    const RunResult whole = machines[0].run();
    const Cycle limit = while_loading ? whole.load_cycles / 2 : whole.ended - whole.trace_cycles / 2;
    std::size_t i = 0;
    for (const auto& [name, counter] : counters) {
        SCOPED_TRACE(name);
        ++(machines[++i].environment().meters.counters.*counter);
        try {
            machines.run_until(i, limit);
            ADD_FAILURE() << "nothing was noticed";
        } catch (const std::logic_error& error) {
            EXPECT_NE(std::string(error.what()).find("messages are not conserved"), std::string::npos)
                << error.what();
        }
    }
}

TEST(TimedConservation, AMachineStoppedWhileLoadingThatMiscountsByOneEndsInAnError) {
    expect_miscounting_is_seen(true);
}

TEST(TimedConservation, AMachineStoppedWhileTracingThatMiscountsByOneEndsInAnError) {
    expect_miscounting_is_seen(false);
}

TEST(TimedConservation, AMessageThatIsLostFromACompletedRunEndsInAnErrorWithItsCounts) {
    Machines machines(1);
    machines[0].environment().pools.answers.take();
    try {
        machines[0].run();
        ADD_FAILURE() << "nothing was noticed";
    } catch (const std::logic_error& error) {
        EXPECT_NE(std::string(error.what()).find(" delivered, 1 in flight; load messages "),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace raycell
