// A cell alone under a stream of passing answers that never ends: whatever else wants the same output gets
// its turn all the same. The argument in cells/deadlock.md stands on it.
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

/// Cell (1, 1) of 3x3. Answers for (2, 1) keep coming in from the west, as fast as the link allows; rays that
/// `make` draws keep coming in from the south. What leaves to the east is read at once.
struct BesideAStream {
    struct Passed {
        int answers = 0;  ///< of the stream
        int replies = 0;  ///< answers to the rays
        int rays = 0;
    };

    BesideAStream(const MachineSettings& machine_settings, const Material& wall)
        : scene(hand_made::cube(3, 3, 10)), machine(machine_settings), picture(3, 3) {
        expect_first_elaboration();
        scene.frame.depth_levels = 10;
        // A wall across the cell at z = 5: what comes in at z < 5 and goes on in z hits it.
        hand_made::add_rectangle(scene, hand_made::add_object(scene, wall), {1, 1, 5}, {0, 1, 0}, {1, 0, 0});
        settings.width = settings.height = 3;
        settings.exterior = ExteriorMode::none;
        environment = std::make_unique<Environment>(scene, settings, machine, scheduler, picture);
        environment->phase = Phase::trace;
        cell = std::make_unique<CellModule>("cell", *environment, 1, 1);
        cell->cell().store() = UntimedMachine(scene, settings, nullptr).cells()[4];
        for (int side = 0; side < side_count; ++side) {
            for (auto* links : {&in, &out}) {
                links->push_back(
                    std::make_unique<Link>(scheduler, environment->classes.count, machine.buffer_depth));
            }
            in.back()->connect_sink(*cell);
            out.back()->connect_source(*cell);
            cell->in[std::size_t(side)].bind(*in.back());
            cell->out[std::size_t(side)].bind(*out.back());
        }
    }

    Passed run(const Ray& ray, Cycle cycles) {
        Environment& env = *environment;
        const int answers = env.classes.answer;
        const int rays = env.classes.ray(ray);
        Actor sources("sources", scheduler, [&](Cycle now) {
            Cycle retry = never;
            Link& west = *in[std::size_t(Side::west)];
            if (west.can_send(answers, retry)) {
                Answer* answer = env.pools.answers.take();
                answer->home_x = 2;
                answer->home_y = 1;
                answer->kind = Answer::Kind::postponed;
                answer->child = 1;  // marks the stream
                west.send(answers, Message(answer), env.cycles_for(env.bits.verdict));
            }
            Link& south = *in[std::size_t(Side::south)];
            if (south.can_send(rays, retry)) {
                RayPacket* packet = env.pools.rays.take();
                packet->ray = ray;
                south.send(rays, Message(packet), 1);
            }
            return now < cycles ? now + 1 : never;
        });
        Passed passed;
        Actor sinks("sinks", scheduler, [&](Cycle now) {
            Link& east = *out[std::size_t(Side::east)];
            for (int index = 0; index < env.classes.count; ++index) {
                const Message front = east.front(index);
                if (front.kind == Message::Kind::none) continue;
                east.pop(index);
                if (front.kind == Message::Kind::ray) {
                    ++passed.rays;
                    env.pools.rays.give_back(front.ray);
                } else {
                    ++(front.answer->child == 1 ? passed.answers : passed.replies);
                    env.pools.answers.give_back(front.answer);
                }
            }
            return now < cycles ? now + 1 : never;
        });
        scheduler.wake(sources, 1);
        scheduler.wake(sinks, 1);
        sc_core::sc_start();
        return passed;
    }

    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    CellScene scene;
    PictureSettings settings;
    MachineSettings machine;
    Picture picture;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<CellModule> cell;
    std::vector<std::unique_ptr<Link>> in;
    std::vector<std::unique_ptr<Link>> out;
};

Ray ray_from_south(const dvec3& position, const dvec3& direction) {
    Ray ray;
    ray.position = position;
    set_direction(ray, direction, exact_arithmetic());
    ray.home_x = 2;
    ray.home_y = 1;
    ray.fresh = false;
    return ray;
}

/// Width of the links in bits, from one bit per cycle to a verdict in one; and the buffers' depth.
class TimedStarvation : public ::testing::TestWithParam<std::tuple<int, int>> {
  protected:
    MachineSettings machine() const {
        MachineSettings m;
        m.link_bits = std::get<0>(GetParam());
        m.buffer_depth = std::get<1>(GetParam());
        return m;
    }
    static constexpr Cycle cycles = 600000;
    /// Nobody is passed over for much longer than Cell::patience, 65536 cycles: this is half of the turns
    /// that leaves.
    static constexpr int turns = 4;
};

TEST_P(TimedStarvation, AnswersToHitsGetTheirTurn) {
    BesideAStream lone(machine(), hand_made::glowing(dvec3(0.5)));
    const auto passed = lone.run(ray_from_south({0.5, 1, 4.9}, glm::normalize(dvec3(0, -0.1, 1))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.replies, turns);
}

TEST_P(TimedStarvation, AnswersToRaysThatEndGetTheirTurn) {
    BesideAStream lone(machine(), hand_made::glowing(dvec3(0.5)));
    const auto passed = lone.run(ray_from_south({0.5, 1, 9.9}, glm::normalize(dvec3(0, -0.1, 1))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.replies, turns);
}

TEST_P(TimedStarvation, RaysThatPassGetTheirTurn) {
    BesideAStream lone(machine(), hand_made::glowing(dvec3(0.5)));
    const auto passed = lone.run(ray_from_south({0.9, 1, 7}, glm::normalize(dvec3(1, -0.1, 0))), cycles);
    EXPECT_GT(passed.answers, turns);
    EXPECT_GT(passed.rays, turns);
}

INSTANTIATE_TEST_SUITE_P(LinkBitsAndDepth, TimedStarvation,
                         ::testing::Combine(::testing::Values(1, 9, 27), ::testing::Values(1, 2, 4)));

}  // namespace
}  // namespace raycell
