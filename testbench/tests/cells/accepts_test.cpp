// The ray store follows the same slot rule as the search over all orders.
#include "../property.hpp"
#include "cells/units/ray_store.hpp"
#include "testbench/protocol/search.hpp"

namespace raycell {
namespace {

/// Expects would_help to agree with the rule for a refused ray: if releasing one slot of a generation lets
/// the ray in, it helps; if it does not help, releasing all slots of that generation does not let it in
/// either.
void expect_help(const RayStore& store, const protocol::Rules& rules, const std::vector<int>& used,
                 int generation) {
    EXPECT_FALSE(store.has_room(generation));
    bool any = false;
    for (std::size_t held = 0; held < used.size(); ++held) {
        if (used[held] == 0) continue;
        std::vector<int> after = used;
        --after[held];
        const bool lets_in = protocol::accepts(rules, after, generation);
        const bool helps = store.would_help(int(held), generation);
        any = any || helps;
        if (lets_in || rules.slots != Slots::nested) {
            EXPECT_EQ(helps, lets_in) << "held " << held;
        }
        if (!helps) {
            after[held] = 0;
            EXPECT_FALSE(protocol::accepts(rules, after, generation)) << "held " << held;
        }
    }
    EXPECT_TRUE(any) << "a refused ray waits for somebody";
}

TEST(TimedRayStore, AcceptsWhatTheSearchedProtocolAccepts) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        protocol::Rules rules;
        rules.ray_store = random.whole(1, 8);
        rules.generations = random.whole(1, 6);
        rules.slots = Slots(random.whole(0, 2));
        RayStore store(rules.ray_store, rules.generations, rules.slots);
        std::vector<int> used(std::size_t(rules.generations), 0);
        std::vector<std::pair<std::uint32_t, int>> held;
        for (int step = 0; step < 200; ++step) {
            if (!held.empty() && random.chance(0.4)) {
                const std::size_t i = std::size_t(random.whole(0, int(held.size()) - 1));
                store.release(held[i].first, held[i].second);
                --used[std::size_t(held[i].second)];
                held.erase(held.begin() + std::ptrdiff_t(i));
                continue;
            }
            const int generation = random.whole(0, rules.generations - 1);
            const bool expected = protocol::accepts(rules, used, generation);
            const auto slot = store.allocate(generation);
            ASSERT_EQ(slot.has_value(), expected) << "step " << step;
            if (!slot) {
                expect_help(store, rules, used, generation);
                continue;
            }
            held.emplace_back(*slot, generation);
            ++used[std::size_t(generation)];
        }
    }
}

}  // namespace
}  // namespace raycell
