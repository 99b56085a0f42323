// A cell alone, its neighbours played by actors: no ray that waits for an output starves.
#include "lone_cell.hpp"

namespace raycell {
namespace {

/// A stream of equal rays that keep coming in over one link and class.
struct Stream {
    Side from;
    dvec3 position;
    dvec3 direction;
};

/// Refills the buffer of every stream as soon as it is empty, and reads every output `pause()` cycles after a
/// message has arrived there. Returns how many rays of each stream left the cell.
std::vector<int> run(LoneCell& lone, const std::vector<Stream>& streams, Cycle cycles,
                     const std::function<int()>& pause) {
    const BufferClasses& classes = lone.environment->classes;
    std::vector<int> passed(streams.size(), 0);
    std::vector<Cycle> due(std::size_t(side_count) * std::size_t(classes.count), never);
    const auto send = [&](std::size_t i) {
        Ray ray = lone_ray(streams[i].position, streams[i].direction);
        ray.slot = std::uint32_t(i);
        Cycle retry = never;
        Link& link = lone.from(streams[i].from);
        if (link.can_send(classes.ray(ray), retry)) lone.send(link, ray);
    };
    lone.run(cycles, [&](Cycle now) {
        for (std::size_t i = 0; i < streams.size(); ++i) send(i);
        for (std::size_t i = 0; i < due.size(); ++i) {
            Link& link = lone.towards(Side(i % side_count));
            const int index = int(i / side_count);
            const Message front = link.front(index);
            if (front.kind != Message::Kind::ray) continue;
            if (due[i] == never) due[i] = now + Cycle(pause());
            if (now < due[i]) continue;
            due[i] = never;
            ++passed[front.ray->ray.slot];
            lone.drop(link, index);
        }
    });
    return passed;
}

const Stream from_west_to_east{Side::west, {0, 0.5, 5}, {1, 0, 0}};
const Stream from_south_to_east{Side::south, {0.9, 1, 5}, glm::normalize(dvec3(1, -0.5, 0))};
const Stream from_north_to_east{Side::north, {0.9, 0, 5}, glm::normalize(dvec3(1, 0.5, 0))};
const Stream from_south_to_west{Side::south, {0.1, 1, 5}, glm::normalize(dvec3(-1, -0.5, 0))};
const Stream from_north_to_west{Side::north, {0.1, 0, 5}, glm::normalize(dvec3(-1, 0.5, 0))};
const Stream from_east_to_west{Side::east, {1, 0.5, 5}, {-1, 0, 0}};
const Stream from_south_to_north{Side::south, {0.5, 1, 5}, {0, -1, 0}};

/// Expects streams that want the same output to share it, whatever passes over the others. `rivals` are those
/// streams; `slowest` is the longest pause in cycles.
void expect_shared(const std::vector<Stream>& streams, const std::vector<std::size_t>& rivals, int slowest) {
    for (const std::uint64_t seed : property::seeds(1, 1)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        LoneCell lone;
        const auto passed = run(lone, streams, 60000, [&] { return random.whole(0, slowest); });
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
