// The rule that the search over all orders uses for slots is the ray store's.
#include "../property.hpp"
#include "cells/ray_store.hpp"
#include "testbench/protocol/search.hpp"

namespace raycell {
namespace {

TEST(TimedRayStore, AcceptsWhatTheSearchedProtocolAccepts) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        protocol::Rules rules;
        rules.ray_store = random.whole(1, 8);
        rules.generations = random.whole(1, 6);
        rules.slots = Slots(random.whole(0, 1));
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
            if (!slot) continue;
            held.emplace_back(*slot, generation);
            ++used[std::size_t(generation)];
        }
    }
}

}  // namespace
}  // namespace raycell
