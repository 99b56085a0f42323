// Frames in a row: two stores, one of which is loaded while the other is traced.
#include "model/machine/frame_schedule.hpp"

#include <gtest/gtest.h>

#include <random>

namespace raycell {
namespace {

using Frames = std::vector<FrameCycles>;

/// The cycles in which the frames are done, by stepping a loader, a tracer and two stores cycle by cycle.
std::vector<std::uint64_t> stepped(const Frames& frames) {
    std::vector<std::uint64_t> done;
    std::size_t loading = 0;  // next frame to load, or the one that is being loaded
    std::size_t loaded = 0;   // frames whose loading has ended
    std::uint64_t load_left = 0;
    std::uint64_t trace_left = 0;
    bool loads = false;
    bool traces = false;
    for (std::uint64_t cycle = 0; done.size() < frames.size(); ++cycle) {
        for (bool changed = true; changed;) {
            changed = false;
            const auto ends = [&](bool& busy, std::uint64_t left) {
                if (!busy || left > 0) return false;
                busy = false;
                return changed = true;
            };
            if (ends(loads, load_left)) ++loaded;
            if (ends(traces, trace_left)) done.push_back(cycle);
            // Two stores: of the frames that are begun at most two are not done.
            if (!loads && loading < frames.size() && loading < done.size() + 2) {
                load_left = frames[loading++].load;
                loads = changed = true;
            }
            if (!traces && done.size() < loaded) {
                trace_left = frames[done.size()].trace;
                traces = changed = true;
            }
        }
        load_left -= loads;
        trace_left -= traces;
    }
    return done;
}

Frames repeated(const Frames& frames, int times) {
    Frames all;
    for (int i = 0; i < times; ++i) all.insert(all.end(), frames.begin(), frames.end());
    return all;
}

TEST(FrameSchedule, TraceLongerThanLoadingBindsTheRow) {
    const auto times = schedule_of({{10, 30}, {10, 30}, {10, 30}});
    EXPECT_EQ(times[0].done, 40U);
    EXPECT_EQ(times[1].load_begins, 10U) << "with the trace of the first";
    EXPECT_EQ(times[1].done, 70U);
    EXPECT_EQ(times[2].load_begins, 40U) << "when the first one's store is free";
    EXPECT_EQ(times[2].done, 100U);
    const SteadyState steady = steady_state_of({{10, 30}, {10, 30}, {10, 30}});
    EXPECT_EQ(steady.cycles_per_frame(), 30);
    EXPECT_EQ(steady.cycles_with_one_store(), 40);
    EXPECT_STREQ(steady.binds(), "trace");
    EXPECT_EQ(steady.bound_by_load, 0U);
}

TEST(FrameSchedule, LoadingLongerThanTheTraceBindsTheRow) {
    const auto times = schedule_of({{50, 20}, {50, 20}});
    EXPECT_EQ(times[0].done, 70U);
    EXPECT_EQ(times[1].load_begins, 50U);
    EXPECT_EQ(times[1].trace_begins, 100U);
    EXPECT_EQ(times[1].done, 120U);
    const SteadyState steady = steady_state_of({{50, 20}, {50, 20}});
    EXPECT_EQ(steady.cycles_per_frame(), 50);
    EXPECT_STREQ(steady.binds(), "load");
    EXPECT_EQ(steady.bound_by_load, 2U);
}

TEST(FrameSchedule, OneFrameTakesItsLoadingAndItsTraceAndRepeatedTheLongerOfThem) {
    EXPECT_EQ(schedule_of({{7, 5}})[0].done, 12U);
    EXPECT_EQ(steady_state_of({{7, 5}}).cycles_per_frame(), 7);
    EXPECT_EQ(steady_state_of({{5, 5}}).cycles_per_frame(), 5);
    EXPECT_STREQ(steady_state_of({{5, 5}}).binds(), "both");
    EXPECT_TRUE(schedule_of({}).empty());
}

TEST(FrameSchedule, EqualsAMachineThatIsSteppedCycleByCycle) {
    const auto seed = std::mt19937::default_seed;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 draw(seed);
    for (int trial = 0; trial < 300; ++trial) {
        Frames frames(1 + draw() % 6);
        for (FrameCycles& frame : frames) frame = {draw() % 40, draw() % 40};
        constexpr int rounds = 8;
        const Frames row = repeated(frames, rounds);
        const std::vector<std::uint64_t> done = stepped(row);
        const std::vector<FrameTimes> times = schedule_of(row);
        for (std::size_t i = 0; i < row.size(); ++i) ASSERT_EQ(times[i].done, done[i]) << "trial " << trial;
        const std::size_t n = frames.size();
        ASSERT_EQ(steady_state_of(frames).period, done[row.size() - 1] - done[row.size() - 1 - n])
            << "trial " << trial << ": a round takes the steady state's period";
    }
}

}  // namespace
}  // namespace raycell
