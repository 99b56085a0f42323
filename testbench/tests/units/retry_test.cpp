// When a postponed ray is sent again.
#include "cells/units/retry.hpp"

#include <gtest/gtest.h>

#include <set>

namespace raycell {
namespace {

MachineSettings machine(std::uint32_t backoff, std::uint64_t seed = 1) {
    MachineSettings m;
    m.costs.backoff = backoff;
    m.seed = seed;
    return m;
}

TEST(Retry, WaitsForItsBaseAndUpToAsMuchAgainDoubledSixTimesAtMost) {
    const MachineSettings m = machine(10);
    for (unsigned attempt = 0; attempt < 20; ++attempt) {
        const Cycle base = Cycle(10) << std::min(attempt, 6U);
        std::set<Cycle> seen;
        for (std::uint64_t ray = 0; ray < 2000; ++ray) {
            const Cycle wait = Retry::backoff(m, ray, attempt);
            ASSERT_GE(wait, base);
            ASSERT_LT(wait, 2 * base);
            seen.insert(wait);
        }
        EXPECT_GT(seen.size(), base / 2) << "rays that were refused together do not come back together";
    }
}

TEST(Retry, HangsOnTheSeedTheRayAndTheAttemptAlone) {
    EXPECT_EQ(Retry::backoff(machine(1000), 7, 2), Retry::backoff(machine(1000), 7, 2));
    EXPECT_NE(Retry::backoff(machine(1000), 7, 2), Retry::backoff(machine(1000, 2), 7, 2));
    EXPECT_NE(Retry::backoff(machine(1000), 7, 2), Retry::backoff(machine(1000), 8, 2));
}

TEST(Retry, CountsItsAttemptsAndWaitsFromTheNotice) {
    const MachineSettings m = machine(10);
    Retry retry;
    EXPECT_EQ(retry.at(), 0u);
    for (unsigned attempt = 0; attempt < 300; ++attempt) {
        EXPECT_EQ(retry.attempts(), std::min(attempt, 250U));
        retry.postponed(m, 5, 1000 * attempt);
        EXPECT_EQ(retry.at(), 1000 * attempt + Retry::backoff(m, 5, std::min(attempt, 250U)));
    }
}

}  // namespace
}  // namespace raycell
