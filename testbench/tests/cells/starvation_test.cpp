// A cell alone under an endless stream of passing answers: everything else that wants the same output still
// gets its turn. The argument in cells/deadlock/deadlock.md relies on this.
#include "estimates.hpp"
#include "lone_cell.hpp"

namespace raycell {
namespace {

struct Passed {
    int answers = 0;  ///< answers of the stream
    int replies = 0;  ///< answers to the rays
    int rays = 0;
};

/// A wall across the cell at z = 5: a ray that comes in at z < 5 and moves in +z hits it.
CellScene walled() {
    CellScene scene = LoneCell::empty(10);
    const std::uint32_t wall = hand_made::add_object(scene, hand_made::glowing(dvec3(0.5)));
    hand_made::add_rectangle(scene, wall, {1, 1, 5}, {0, 1, 0}, {1, 0, 0});
    return scene;
}

/// Answers for (2, 1) keep coming in from the west, as fast as the link allows, and `ray` again and again
/// from the south. Messages that leave to the east are read at once.
Passed beside_a_stream(const MachineSettings& machine, const Ray& ray, Cycle cycles) {
    LoneCell lone(machine, walled());
    const Environment& env = *lone.environment;
    Answer streaming;
    streaming.home_x = 2;
    streaming.home_y = 1;
    streaming.kind = Answer::Kind::postponed;
    streaming.child = 1;  // marks the stream
    Link& west = lone.from(Side::west);
    Link& south = lone.from(Side::south);
    Link& east = lone.towards(Side::east);
    Passed passed;
    lone.run(cycles, [&](Cycle) {
        Cycle retry = never;
        if (west.can_send(env.classes.answer, retry))
            lone.send(west, streaming, env.cycles_for(env.bits.verdict));
        if (south.can_send(env.classes.ray(ray), retry)) lone.send(south, ray);
        for (int index = 0; index < env.classes.count; ++index) {
            const Message front = east.front(index);
            if (front.kind == Message::Kind::none) continue;
            const bool is_ray = front.kind == Message::Kind::ray;
            ++(is_ray ? passed.rays : front.answer->child == 1 ? passed.answers : passed.replies);
            lone.drop(east, index);
        }
    });
    return passed;
}

Ray ray_from_south(const dvec3& position, const dvec3& direction) {
    Ray ray = lone_ray(position, direction);
    ray.home_x = 2;
    ray.home_y = 1;
    ray.fresh = false;
    return ray;
}

/// Parameters: width of the links in bits, from one bit per cycle to a whole verdict, and depth of the
/// buffers.
class TimedStarvation : public ::testing::TestWithParam<std::tuple<int, int>> {
  protected:
    MachineSettings machine() const {
        MachineSettings m = estimated_machine();
        m.link_bits = std::get<0>(GetParam());
        m.buffer_depth = std::get<1>(GetParam());
        return m;
    }
    static constexpr Cycle cycles = 600000;
    /// At least this many turns: half of cycles / AgingArbiter::patience (65536 cycles), since no message is
    /// passed over for much longer than that.
    static constexpr int turns = 4;
};

TEST_P(TimedStarvation, AnswersToHitsGetTheirTurn) {
    const Passed passed =
        beside_a_stream(machine(), ray_from_south({0.5, 1, 4.9}, glm::normalize(dvec3(0, -0.1, 1))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.replies, turns);
}

TEST_P(TimedStarvation, AnswersToRaysThatEndGetTheirTurn) {
    const Passed passed =
        beside_a_stream(machine(), ray_from_south({0.5, 1, 9.9}, glm::normalize(dvec3(0, -0.1, 1))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.replies, turns);
}

TEST_P(TimedStarvation, RaysThatPassGetTheirTurn) {
    const Passed passed =
        beside_a_stream(machine(), ray_from_south({0.9, 1, 7}, glm::normalize(dvec3(1, -0.1, 0))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.rays, turns);
}

/// The cycle in which a ray, or the answer that it ends in, starts over an output that a stream of answers
/// uses in every cycle. The ray is tested in cycle `decided`. `older`, if given, is tested in cycle 100 and
/// waits for the same output.
Cycle wins_in(const Ray& ray, Cycle decided, const Ray* older = nullptr) {
    MachineSettings machine = estimated_machine();
    machine.link_bits = 64;  // a verdict takes one cycle
    machine.buffer_depth = 4;
    LoneCell lone(machine, LoneCell::empty(10));
    const Environment& env = *lone.environment;
    Answer streaming;
    streaming.home_x = 2;
    streaming.home_y = 1;
    streaming.kind = Answer::Kind::postponed;
    streaming.child = 1;
    Link& west = lone.from(Side::west);
    Link& east = lone.towards(Side::east);
    const Cycle sent = decided - 1 - machine.costs.walk_step;  // a cycle on the link, then the test
    Cycle won = 0;
    lone.run(decided + 100000, [&](Cycle now) {
        Cycle retry = never;
        if (west.can_send(env.classes.answer, retry)) lone.send(west, streaming);
        if (now == sent) lone.send(lone.from(Side::south), ray);
        if (older && now == 100 - 1 - machine.costs.walk_step) lone.send(lone.from(Side::north), *older);
        for (int index = 0; index < env.classes.count; ++index) {
            const Message front = east.front(index);
            if (front.kind == Message::Kind::none) continue;
            const bool is_ray = front.kind == Message::Kind::ray;
            const bool is_older = older && is_ray && front.ray->ray.id == older->id;
            if (won == 0 && !is_older && (is_ray || front.answer->child != 1))
                won = east.arrival(index) - Cycle(env.cycles_for(is_ray ? env.bits.ray : env.bits.intensity));
            lone.drop(east, index);
        }
    });
    return won;
}

/// Epochs have 8192 cycles. A message goes before all others from the first epoch that begins when it has
/// waited for more than 65536 cycles, so the cycle of its test determines when it wins.
class TimedStarvationBound : public ::testing::TestWithParam<Cycle> {
  protected:
    Cycle expected() const { return ((GetParam() + 65536) / 8192 + 1) * 8192; }
};

TEST_P(TimedStarvationBound, ARayGoesFirstInTheFirstEpochThatBeginsMoreThan65536CyclesAfterItsTest) {
    EXPECT_EQ(wins_in(ray_from_south({0.9, 1, 7}, glm::normalize(dvec3(1, -0.1, 0))), GetParam()),
              expected());
}

TEST_P(TimedStarvationBound, AnAnswerToARayThatEndsGoesFirstInTheSameCycle) {
    EXPECT_EQ(wins_in(ray_from_south({0.5, 1, 9.9}, glm::normalize(dvec3(0, -0.1, 1))), GetParam()),
              expected());
}

TEST_P(TimedStarvationBound, ARayGoesNoEarlierBecauseAnOlderOneMakesTheCellLook) {
    Ray older = ray_from_south({0.9, 0, 7}, glm::normalize(dvec3(1, 0.1, 0)));
    older.id = 7;
    const Cycle won =
        wins_in(ray_from_south({0.9, 1, 7}, glm::normalize(dvec3(1, -0.1, 0))), GetParam(), &older);
    // If both become overdue in the same epoch, the older one goes first.
    const bool same = (GetParam() + 65536) / 8192 == (100 + 65536) / 8192;
    if (same) {
        EXPECT_GT(won, expected());
    } else {
        EXPECT_EQ(won, expected());
    }
}

/// The kind of message that first starts over the east output when both its buffers, full since cycle 1, are
/// read in cycle `opens`. By then everything that waits for them has long been overdue.
Message::Kind first_when_it_opens(LoneCell& lone, const std::function<void(Cycle)>& script) {
    constexpr Cycle opens = 100000;
    const Environment& env = *lone.environment;
    Link& east = lone.towards(Side::east);
    const Ray passing = lone_ray({0, 0.5, 7}, {1, 0, 0});
    const int ways[] = {env.classes.ray(passing), env.classes.answer};
    Message::Kind first = Message::Kind::none;
    lone.run(opens + 100, [&](Cycle now) {
        if (now == 1) lone.send(east, passing);
        if (now == 2) lone.send(east, Answer());
        script(now);
        for (const int index : ways) {
            if (now < opens || east.front(index).kind == Message::Kind::none) continue;
            if (now > opens && first == Message::Kind::none) first = east.front(index).kind;
            lone.drop(east, index);
        }
    });
    return first;
}

MachineSettings roomy() {
    MachineSettings machine = estimated_machine();
    machine.link_bits = 1000;  // every message takes one cycle
    machine.buffer_depth = 1;
    machine.ray_store = 4;
    machine.slots = Slots::free;
    return machine;
}

/// An answer whose routing takes 50 cycles comes in; a passing ray is tested `later` cycles after it.
Message::Kind beside_an_answer(Cycle later) {
    MachineSettings machine = roomy();
    machine.costs.route_return = 50;
    LoneCell lone(machine, LoneCell::empty(10));
    return first_when_it_opens(lone, [&, later](Cycle now) {
        Answer answer;
        answer.home_x = 2;
        answer.home_y = 1;
        if (now == 100) lone.send(lone.from(Side::west), answer);
        if (now == 100 + later - machine.costs.walk_step)
            lone.send(lone.from(Side::south), ray_from_south({0.9, 1, 7}, glm::normalize(dvec3(1, -0.1, 0))));
    });
}

TEST(TimedStarvationOrder, AnAnswerIsAsOldAsTheEndOfItsRouting) {
    EXPECT_EQ(beside_an_answer(49), Message::Kind::ray);
}

TEST(TimedStarvationOrder, AnAnswerRoutedBeforeARayIsTestedGoesFirst) {
    EXPECT_EQ(beside_an_answer(51), Message::Kind::answer);
}

/// A wall and a source behind it: hits need a slot for that source, but are complete once set up.
CellScene turned_away() {
    CellScene scene = walled();
    Source behind;
    behind.position = {1.5, 1.5, 9};
    scene.sources.push_back(behind);
    return scene;
}

const Ray hits_wall = ray_from_south({0.5, 1, 4.9}, glm::normalize(dvec3(0, -0.1, 1)));

/// A ray that hits comes in, and its shading takes a thousand cycles; a passing ray comes in `later` cycles
/// after it.
Message::Kind beside_a_reply(Cycle later) {
    MachineSettings machine = roomy();
    machine.costs.shade_setup = 1000;
    LoneCell lone(machine, turned_away());
    return first_when_it_opens(lone, [&, later](Cycle now) {
        if (now == 100) lone.send(lone.from(Side::south), hits_wall);
        if (now == 100 + later)
            lone.send(lone.from(Side::south), ray_from_south({0.9, 1, 2}, glm::normalize(dvec3(1, -0.1, 0))));
    });
}

TEST(TimedStarvationOrder, AReplyIsAsOldAsTheEndOfItsShading) {
    EXPECT_EQ(beside_a_reply(500), Message::Kind::ray);
}

TEST(TimedStarvationOrder, AReplyShadedBeforeARayIsTestedGoesFirst) {
    EXPECT_EQ(beside_a_reply(5000), Message::Kind::answer);
}

TEST(TimedStarvationOrder, RepliesAndAnswersThatPassTakeTurns) {
    MachineSettings machine = roomy();
    machine.buffer_depth = 4;
    LoneCell lone(machine, turned_away());
    const Environment& env = *lone.environment;
    Link& east = lone.towards(Side::east);
    constexpr Cycle opens = 5000;
    Answer passing;
    passing.home_x = 2;
    passing.home_y = 1;
    passing.child = 1;
    std::string order;
    lone.run(opens + 100, [&](Cycle now) {
        if (now <= 4) lone.send(east, Answer());
        if (now == 100 || now == 300 || now == 500) {
            lone.send(lone.from(Side::south), hits_wall);
            lone.send(lone.from(Side::west), passing);
        }
        const Message front = east.front(env.classes.answer);
        if (now < opens || front.kind != Message::Kind::answer) return;
        if (now >= opens + 4) order += front.answer->child == 1 ? "A" : "R";
        lone.drop(east, env.classes.answer);
    });
    EXPECT_TRUE(order == "ARARAR" || order == "RARARA") << order;
}

INSTANTIATE_TEST_SUITE_P(TestedIn, TimedStarvationBound,
                         ::testing::Values(110, 8191, 8192, 8193, 16383, 16384));

INSTANTIATE_TEST_SUITE_P(LinkBitsAndDepth, TimedStarvation,
                         ::testing::Combine(::testing::Values(1, 9, 27), ::testing::Values(1, 2, 4)));

}  // namespace
}  // namespace raycell
