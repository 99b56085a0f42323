// Estimates of the time left, for a running machine and as text.
#include "testbench/common/time_estimate.hpp"

#include "elaboration.hpp"

namespace raycell {
namespace {

RunProgress progress(const char* phase, double share, double seconds) {
    RunProgress p{};
    p.phase = phase, p.share = share, p.seconds = seconds;
    p.cycle = 700, p.done = 25, p.all = 100, p.hops = 1234;
    return p;
}

TEST(TimeLeft, IsWhatAPhaseTookForEachShareSoFar) {
    EXPECT_DOUBLE_EQ(seconds_left(progress("trace", 0.25, 10)), 30);
    EXPECT_DOUBLE_EQ(seconds_left(progress("load", 1, 10)), 0);
    EXPECT_LT(seconds_left(progress("trace", 0, 10)), 0) << "nothing is done: nothing can be said";
    EXPECT_LT(seconds_left(progress("trace", 0.5, 0.1)), 0) << "too early";
}

TEST(TimeLeft, StandsInTheLineOfProgressOnceItIsKnown) {
    EXPECT_EQ(progress_line(progress("trace", 0.25, 10)),
              "trace: cycle 700, 25 of 100 pixels done, 1234 hops, about 30 s left");
    EXPECT_EQ(progress_line(progress("trace", 0, 10)), "trace: cycle 700, 25 of 100 pixels done, 1234 hops");
    EXPECT_EQ(progress_line(progress("load", 0.5, 400)),
              "load: cycle 700, 50 % of the polygons, 1234 hops, about 6.7 min of loading left");
    EXPECT_EQ(progress_line(progress("precast", 0.5, 8000)),
              "precast: cycle 700, 50 % of the rays, 1234 hops, about 2.2 h left");
}

TEST(TimeLeft, IsSaidInTheLargestUnitOfWhichThereAreTwo) {
    EXPECT_EQ(duration(0), "0 s");
    EXPECT_EQ(duration(119), "119 s");
    EXPECT_EQ(duration(121), "2.0 min");
    EXPECT_EQ(duration(7100), "118 min");
    EXPECT_EQ(duration(7300), "2.0 h");
    EXPECT_EQ(duration(86400.0 * 12), "12 days");
}

TEST(TimeLeft, IsSaidOfEveryPhaseThatTakesTimeBeforeARun) {
    Forecast forecast;
    forecast.load_hops = 2e8;
    forecast.trace_hops = 1e9;
    EXPECT_EQ(expectation(forecast, {30, 0, 900}),
              "about 16 min for 1.2e+03 M hops: load 30 s, trace 15 min");
    EXPECT_EQ(expectation(forecast, {0, 90, 900}),
              "about 16 min for 1.2e+03 M hops: precast 90 s, trace 15 min");
}

TEST(TimeLeft, IsMoreForMoreHopsLargerArraysAndModulesAndLessForMoreRanks) {
    Forecast forecast;
    forecast.load_hops = forecast.load_steps = forecast.trace_hops = forecast.precast_hops = 1e6;
    const ExpectedSeconds one = expected_seconds(forecast, 4096, false);
    EXPECT_GT(expected_seconds(forecast, 65536, false).trace, one.trace);
    EXPECT_GT(expected_seconds(forecast, 4096, true).load, one.load);
    const double two_ranks = expected_seconds(forecast, 4096, false, 2).trace;
    EXPECT_LT(two_ranks, one.trace / 1.5);
    EXPECT_GT(two_ranks, one.trace / 2) << "each waits for the other";
    EXPECT_LT(expected_seconds(forecast, 4096, false, 4).trace, two_ranks);
    EXPECT_DOUBLE_EQ(expected_seconds(forecast, 4096, false, 2).load, one.load);
    forecast.trace_hops = 2e6;
    EXPECT_DOUBLE_EQ(expected_seconds(forecast, 4096, false).trace, 2 * one.trace);
    EXPECT_DOUBLE_EQ(expected_seconds(forecast, 4096, false).precast, one.precast);
}

TEST(TimeLeft, HasItsShareFromEveryPhaseOfARun) {
    PictureSettings settings;
    settings.width = settings.height = 32;
    settings.shadows = Shadows::precast;
    const auto placed = place_own_scene("still_life", settings);
    expect_first_elaboration();
    Machine machine("machine", placed->scene, settings, {}, placed->exterior.get());
    std::map<std::string, std::vector<double>> shares;
    machine.run([&](const RunProgress& p) {
        shares[p.phase].push_back(p.share);
        EXPECT_GE(p.seconds, 0);
    });
    ASSERT_EQ(shares.size(), 3u) << "load, precast, trace";
    for (const auto& [phase, list] : shares) {
        SCOPED_TRACE(phase);
        EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
        EXPECT_GE(list.front(), 0);
        EXPECT_LT(list.front(), 0.9);
        EXPECT_LE(list.back(), 1);
        EXPECT_GT(list.back(), phase == "trace" ? 0.0 : 0.5);
    }
}

}  // namespace
}  // namespace raycell
