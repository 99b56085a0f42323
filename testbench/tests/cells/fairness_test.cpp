// A cell alone, its neighbours played by actors: no ray that waits for an output is passed over for ever.
#include "../truth/hand_made.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

/// Rays that keep coming in over one link and class, all the same.
struct Stream {
    Side from;
    dvec3 position;
    dvec3 direction;
};

struct LoneCell {
    explicit LoneCell(const MachineSettings& machine_settings)
        : scene(hand_made::cube(3, 3, 100)), machine(machine_settings), picture(3, 3) {
        expect_first_elaboration();
        scene.frame.depth_levels = 10;
        settings.width = settings.height = 3;
        settings.exterior = ExteriorMode::none;
        environment = std::make_unique<Environment>(scene, settings, machine, scheduler, picture);
        environment->phase = Phase::trace;
        cell = std::make_unique<CellModule>("cell", *environment, 1, 1);
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

    /// Every stream's buffer is filled again as soon as it is empty; every output is read `pause()` cycles
    /// after a message has come. Returns how many rays of each stream left the cell.
    std::vector<int> run(const std::vector<Stream>& streams, Cycle cycles,
                         const std::function<int()>& pause) {
        std::vector<int> passed(streams.size(), 0);
        const auto send = [&](std::size_t i) {
            const Stream& stream = streams[i];
            Ray ray;
            ray.position = stream.position;
            set_direction(ray, stream.direction, environment->context.arithmetic);
            Link& link = *in[std::size_t(stream.from)];
            const int index = environment->classes.ray(ray);
            Cycle retry = never;
            if (!link.can_send(index, retry)) return;
            RayPacket* packet = environment->pools.rays.take();
            ray.slot = std::uint32_t(i);
            packet->ray = ray;
            link.send(index, Message(packet), 1);
        };
        Actor sources("sources", scheduler, [&](Cycle now) {
            for (std::size_t i = 0; i < streams.size(); ++i) send(i);
            return now < cycles ? now + 1 : never;
        });
        std::vector<Cycle> due(std::size_t(side_count) * std::size_t(environment->classes.count), never);
        Actor sinks("sinks", scheduler, [&](Cycle now) {
            for (std::size_t i = 0; i < due.size(); ++i) {
                Link& link = *out[i % side_count];
                const int index = int(i / side_count);
                const Message front = link.front(index);
                if (front.kind != Message::Kind::ray) continue;
                if (due[i] == never) due[i] = now + Cycle(pause());
                if (now < due[i]) continue;
                due[i] = never;
                ++passed[front.ray->ray.slot];
                link.pop(index);
                environment->pools.rays.give_back(front.ray);
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

const Stream from_west_to_east{Side::west, {0, 0.5, 5}, {1, 0, 0}};
const Stream from_south_to_east{Side::south, {0.9, 1, 5}, glm::normalize(dvec3(1, -0.5, 0))};
const Stream from_north_to_east{Side::north, {0.9, 0, 5}, glm::normalize(dvec3(1, 0.5, 0))};
const Stream from_south_to_west{Side::south, {0.1, 1, 5}, glm::normalize(dvec3(-1, -0.5, 0))};
const Stream from_north_to_west{Side::north, {0.1, 0, 5}, glm::normalize(dvec3(-1, 0.5, 0))};
const Stream from_east_to_west{Side::east, {1, 0.5, 5}, {-1, 0, 0}};
const Stream from_south_to_north{Side::south, {0.5, 1, 5}, {0, -1, 0}};

/// Those that want the same output share it, whatever goes on at the others.
void expect_shared(const std::vector<Stream>& streams, const std::vector<std::size_t>& rivals, int slowest) {
    for (const std::uint64_t seed : property::seeds(1, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        LoneCell lone{MachineSettings()};
        const auto passed = lone.run(streams, 60000, [&] { return random.whole(0, slowest); });
        int sum = 0;
        for (const std::size_t i : rivals) sum += passed[i];
        EXPECT_GT(sum, 500);
        for (const std::size_t i : rivals) {
            EXPECT_GT(passed[i], sum / int(rivals.size()) / 2)
                << "stream " << i << " of " << sum << " rays over the output";
        }
    }
}

TEST(TimedFairness, TwoInputsShareAnOutputThatNobodyElseWants) {
    expect_shared({from_west_to_east, from_south_to_east}, {0, 1}, 20);
}

TEST(TimedFairness, TwoInputsShareAnOutputWhileOthersPassBetweenThem) {
    expect_shared({from_west_to_east, from_south_to_east, from_south_to_west}, {0, 1}, 20);
}

TEST(TimedFairness, TwoInputsShareASlowOutputWhileOthersPassBetweenThem) {
    expect_shared({from_west_to_east, from_south_to_east, from_south_to_west}, {0, 1}, 200);
}

TEST(TimedFairness, ThreeInputsShareAnOutputUnderFullTraffic) {
    expect_shared({from_west_to_east, from_south_to_east, from_north_to_east, from_south_to_west,
                   from_north_to_west, from_east_to_west},
                  {0, 1, 2}, 60);
}

TEST(TimedFairness, ThreeInputsShareTheOtherOutputUnderFullTraffic) {
    expect_shared({from_west_to_east, from_south_to_north, from_north_to_east, from_south_to_west,
                   from_north_to_west, from_east_to_west},
                  {3, 4, 5}, 60);
}

}  // namespace
}  // namespace raycell
