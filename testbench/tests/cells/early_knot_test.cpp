// Knots in machines that still run: what is locked in one cycle stays locked, whatever else moves.
#include "elaboration.hpp"
#include "estimates.hpp"
#include "knot_check.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {
namespace {

struct Drawn {
    TrafficSettings traffic;
    PictureSettings picture;
    MachineSettings machine = estimated_machine();  // slower ones lock less
    std::unique_ptr<SyntheticTraffic> drawn;
    CellScene scene;
    std::string text;
};

/// Small machines that mostly end in a deadlock or livelock.
std::unique_ptr<Drawn> draw(std::uint64_t seed) {
    property::Random random(seed);
    auto drawn = std::make_unique<Drawn>();
    TrafficSettings& t = drawn->traffic;
    t.hit_probability = random.uniform(0.05, 0.6);
    t.reflected = random.chance(0.5) ? 1 : random.uniform(0.3, 1);
    t.refracted = random.chance(0.5) ? 0 : random.uniform(0, 0.5);
    t.sources = random.chance(0.6) ? 0 : random.whole(1, 2);
    t.directions = Directions(random.whole(0, 3));
    t.turn_back = random.uniform(0, 1);
    t.seed = seed;
    drawn->picture = traffic_picture(random.whole(2, 10), random.whole(2, 10), random.whole(1, 4));
    MachineSettings& m = drawn->machine;
    m.seed = seed;
    m.buffer_depth = random.chance(0.7) ? 1 : random.whole(2, 3);
    m.link_bits = random.chance(0.3) ? random.whole(1, 8) : random.whole(9, 300);
    m.networks = random.chance(0.6)   ? Networks::shared
                 : random.chance(0.7) ? Networks::split
                                      : Networks::half;
    m.slots = Slots(random.whole(0, 2));
    m.recovery = random.chance(0.8) ? Recovery::postpone : Recovery::none;
    m.ray_store = random.whole(1, 4);
    m.costs.backoff = std::uint32_t(random.whole(1, 32));
    drawn->drawn = std::make_unique<SyntheticTraffic>(t);
    drawn->scene = traffic_scene(drawn->picture, t);
    drawn->text = std::to_string(drawn->picture.width) + "x" + std::to_string(drawn->picture.height) +
                  ", M " + std::to_string(m.ray_store) + ", buffers " + std::to_string(m.buffer_depth) +
                  ", networks " + std::to_string(int(m.networks)) + ", slots " +
                  std::to_string(int(m.slots)) + ", recovery " + std::to_string(int(m.recovery));
    return drawn;
}

/// A place and the message that waits there, without the messages behind it.
using Held = std::tuple<int, int, int, std::string, std::string>;

std::set<Held> locked(const WaitGraph& graph) {
    std::set<Held> all;
    for (const WaitGraph::Node& n : graph.nodes()) {
        if (n.state == WaitGraph::State::live) continue;
        all.emplace(int(n.kind), n.x, n.y, n.what, n.holds.substr(0, n.holds.find(", ")));
    }
    return all;
}

void expect_knots(const WaitGraph& graph) {
    std::vector<knot_check::Node> nodes;
    for (const WaitGraph::Node& n : graph.nodes())
        nodes.push_back({n.moves, n.all, {n.waits_for.begin(), n.waits_for.end()}});
    for (const auto& knot : graph.knots())
        EXPECT_EQ(knot_check::objection(nodes, {knot.begin(), knot.end()}), "");
}

/// Expects everything locked in `before` to be locked in `after`, a later cycle of the same machine.
void expect_still_locked(const WaitGraph& before, const WaitGraph& after) {
    const std::set<Held> now = locked(after);
    for (const Held& each : locked(before)) {
        EXPECT_TRUE(now.count(each)) << "(" << std::get<1>(each) << ", " << std::get<2>(each) << ") "
                                     << std::get<3>(each) << ": " << std::get<4>(each) << " has moved";
    }
}

/// Makes a machine with a unique name. Never destroyed: SystemC destroys ports in quadratic time.
Machine& machine_of(const Drawn& drawn, const MachineSettings& settings) {
    static int number = 0;
    const std::string name = "machine_" + std::to_string(number++);
    return *new Machine(name.c_str(), drawn.scene, drawn.picture, settings, nullptr, drawn.drawn.get());
}

class EarlyKnot : public ::testing::TestWithParam<int> {};
constexpr int machines_per_case = 40;

TEST_P(EarlyKnot, OfAMachineStoppedInAnyCycleIsStillThereLongAfter) {
    expect_first_elaboration();
    const auto seeds = property::seeds(std::uint64_t(GetParam() * machines_per_case), machines_per_case);
    std::vector<std::unique_ptr<Drawn>> drawn;
    std::vector<std::pair<Machine*, Machine*>> machines;
    for (const std::uint64_t seed : seeds) {
        drawn.push_back(draw(seed));
        property::Random random(~seed);
        MachineSettings early = drawn.back()->machine;
        early.max_cycles = random.whole(100, 3000);
        MachineSettings late = early;
        late.max_cycles += 30000;
        machines.emplace_back(&machine_of(*drawn.back(), early), &machine_of(*drawn.back(), late));
        for (Machine* machine : {machines.back().first, machines.back().second})
            machine->look_for_knots_after(never);
    }
    int knots = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        SCOPED_TRACE(drawn[i]->text + "; " + property::rerun(seeds[i]));
        const RunResult early = machines[i].first->run();
        const RunResult late = machines[i].second->run();
        expect_knots(early.waits);
        expect_still_locked(early.waits, late.waits);
        knots += early.waits.deadlocked();
    }
    EXPECT_TRUE(knots > 0 || seeds.size() == 1) << "else this tests nothing";
}

TEST_P(EarlyKnot, ThatEndsARunWhichOnlyPostponesStandsInOneThatGoesOn) {
    expect_first_elaboration();
    const auto seeds = property::seeds(std::uint64_t(GetParam() * machines_per_case), machines_per_case);
    std::vector<std::unique_ptr<Drawn>> drawn;
    std::vector<Machine*> machines;
    for (const std::uint64_t seed : seeds) {
        drawn.push_back(draw(seed));
        drawn.back()->machine.recovery = Recovery::postpone;
        drawn.back()->machine.max_cycles = 50000;
        machines.push_back(&machine_of(*drawn.back(), drawn.back()->machine));
        machines.back()->look_for_knots_after(100);
        machines.push_back(&machine_of(*drawn.back(), drawn.back()->machine));
        machines.back()->look_for_knots_after(never);
    }
    int sooner = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        SCOPED_TRACE(drawn[i]->text + "; " + property::rerun(seeds[i]));
        const RunResult early = machines[2 * i]->run();
        const RunResult late = machines[2 * i + 1]->run();
        EXPECT_EQ(name_of(early.verdict), std::string(name_of(late.verdict)));
        EXPECT_LE(early.ended, late.ended);
        expect_still_locked(early.waits, late.waits);
        if (early.verdict != Verdict::deadlock) {
            EXPECT_EQ(early.schedule_hash, late.schedule_hash) << "looking for knots changes nothing";
        }
        sooner += early.ended < late.ended;
        if (late.waits.deadlocked()) {
            EXPECT_LT(early.ended, late.knot_formed + 10000) << "looked for again and again";
        }
    }
    EXPECT_TRUE(sooner > 0 || seeds.size() == 1) << "else this tests nothing";
}

INSTANTIATE_TEST_SUITE_P(Case, EarlyKnot, ::testing::Range(56, 61));

}  // namespace
}  // namespace raycell
