// Every interleaving in tiny arrays: what cells/deadlock/deadlock.md claims to end does end in every order.
// For what it does not claim, the search finds a shortest way to the deadlock or livelock.
#include "testbench/protocol/search.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "../property.hpp"

namespace raycell::protocol {
namespace {

const char* const network_names[] = {"shared", "split", "quadrant", "half"};
const char* const slot_names[] = {"reserved", "free", "nested"};

Result look(const char* what, const Script& script, const Rules& rules, Networks networks) {
    const Result result = search(script, rules);
    std::cout << what << ", " << network_names[int(networks)] << ", " << slot_names[int(rules.slots)] << ", "
              << (rules.recovery == Recovery::none ? "none" : "postpone") << ", M " << rules.ray_store << ": "
              << result.states << " states, " << result.moves << " moves, " << result.deadlocks
              << " deadlocks, " << result.traps << " trapped\n";
    for (const auto* way : {&result.way_to_deadlock, &result.way_to_trap}) {
        if (way->empty()) continue;
        std::cout << (way == &result.way_to_trap ? "  to the livelock:\n" : "  to the deadlock:\n");
        for (const std::string& line : *way) std::cout << "    " << line << "\n";
    }
    EXPECT_TRUE(result.complete) << "more states than the limit";
    return result;
}

Rules rules_for(const Script& script, int ray_store, Slots slots, Recovery recovery) {
    Rules rules;
    rules.ray_store = ray_store;
    rules.slots = slots;
    rules.recovery = recovery;
    rules.generations = std::max(script.waiting_generations(), 1);
    return rules;
}

/// Two mirrors at the ends of a row. From each, `trees` trees start and go back and forth; the last
/// generation waits for a verdict on a source in the middle.
Script facing_mirrors(Networks networks, int width, int trees, int generations, int depth = 1) {
    Script script(width, 1, networks, depth);
    for (int tree = 0; tree < trees; ++tree) {
        for (const bool east : {true, false}) {
            const std::string name = std::string(east ? "w" : "e") + std::to_string(tree);
            int at = script.add(name + "/0", east ? 0 : width - 1, 0, 0, 0, 0, End::hit);
            double way = east ? 1 : -1;
            for (int g = 1; g < generations; ++g, way = -way) {
                at = script.add_child(at, name + "/" + std::to_string(g), way, 0, width - 1, End::hit);
            }
            script.add_child(at, name + "/s", way, 0, width / 2, End::answer);
        }
    }
    return script;
}

/// Four rays round a square, each over two links: a ray that turns a corner waits for the next ray.
Script round_a_square(Networks networks) {
    Script script(2, 2, networks);
    script.add("a", 0, 0, 1, 0.9, 2, End::answer);
    script.add("b", 1, 0, -0.9, 1, 2, End::answer);
    script.add("c", 1, 1, -1, -0.9, 2, End::answer);
    script.add("d", 0, 1, 0.9, -1, 2, End::answer);
    return script;
}

constexpr Networks acyclic[] = {Networks::half, Networks::quadrant};

TEST(EveryOrder, OfRaysRoundASquareEndsWithHalvesAndQuadrantsAlone) {
    for (const Networks n : acyclic) {
        const Script script = round_a_square(n);
        EXPECT_TRUE(
            look("square", script, rules_for(script, 1, Slots::reserved, Recovery::none), n).always_ends());
    }
    const Script split = round_a_square(Networks::split);
    const Result ring =
        look("square", split, rules_for(split, 1, Slots::reserved, Recovery::postpone), Networks::split);
    EXPECT_GT(ring.deadlocks, 0u);
    EXPECT_EQ(ring.way_to_deadlock.size(), 4u + 4u + 1u + 4u)
        << "each sent, each one link on, then what waits";
}

TEST(EveryOrder, OfRaysEachWayAndTheirAnswersLocksWhereTheyShareABuffer) {
    for (const Networks n : {Networks::shared, Networks::split, Networks::half}) {
        for (const int depth : {1, 2}) {
            Script script(2, 1, n, depth);
            for (int i = 0; i < depth; ++i) {
                script.add("a" + std::to_string(i), 0, 0, 1, 0, 1, End::answer);
                script.add("b" + std::to_string(i), 1, 0, -1, 0, 1, End::answer);
            }
            const Rules rules = rules_for(script, 8, Slots::reserved, Recovery::postpone);
            const Result result = look("to and fro", script, rules, n);
            EXPECT_EQ(result.deadlocks > 0, n == Networks::shared);
            EXPECT_EQ(result.traps, 0u);
        }
    }
}

TEST(EveryOrder, BetweenFacingMirrorsEndsFromOneSlotPerGenerationOn) {
    for (const Networks n : acyclic) {
        for (const int generations : {1, 2, 3}) {
            const Script script = facing_mirrors(n, 2, 1, generations);
            for (int m = generations; m <= generations + 1; ++m) {
                for (const Slots slots : {Slots::reserved, Slots::nested}) {
                    const Rules rules = rules_for(script, m, slots, Recovery::postpone);
                    EXPECT_TRUE(look("mirrors", script, rules, n).always_ends());
                }
            }
        }
    }
}

TEST(EveryOrder, BetweenFacingMirrorsNeedNotEndWithOneSlotLess) {
    for (const int generations : {2, 3, 4}) {
        const Script script = facing_mirrors(Networks::half, 2, 1, generations);
        const Rules rules = rules_for(script, generations - 1, Slots::reserved, Recovery::postpone);
        const Result result = look("mirrors", script, rules, Networks::half);
        EXPECT_EQ(result.deadlocks, 0u);
        EXPECT_GT(result.traps, 0u);
    }
}

TEST(EveryOrder, InARowEndsWithSplitBuffersToo) {
    const Script script = facing_mirrors(Networks::split, 3, 1, 3);
    const Rules rules = rules_for(script, 3, Slots::reserved, Recovery::postpone);
    EXPECT_TRUE(look("mirrors apart", script, rules, Networks::split).always_ends());
}

TEST(EveryOrder, BetweenFacingMirrorsWithManyTreesEndsWhereDeepGenerationsTakeAllSlots) {
    struct Case {
        int trees, generations, ray_store;
    };
    for (const Case& c : {Case{3, 2, 2}, Case{2, 2, 3}, Case{2, 3, 3}, Case{2, 3, 4}}) {
        const Script script = facing_mirrors(Networks::half, 2, c.trees, c.generations);
        const Rules rules = rules_for(script, c.ray_store, Slots::nested, Recovery::postpone);
        EXPECT_TRUE(look("mirrors, many trees", script, rules, Networks::half).always_ends());
    }
}

TEST(EveryOrder, BetweenFacingMirrorsWithSeveralTreesEnds) {
    const Script script = facing_mirrors(Networks::half, 2, 2, 2);
    const Rules rules = rules_for(script, 2, Slots::reserved, Recovery::postpone);
    EXPECT_TRUE(look("mirrors, four trees", script, rules, Networks::half).always_ends());
}

TEST(EveryOrder, OfBlocksOfPixelsEndsFromTheSameSlotsOnWhateverTheOwnRays) {
    struct Case {
        int trees, generations;
    };
    for (const Networks n : acyclic) {
        for (const Case& c : {Case{2, 1}, Case{3, 1}, Case{2, 2}, Case{3, 2}}) {
            const Script script = facing_mirrors(n, 2, c.trees, c.generations);
            for (int own_rays = 1; own_rays <= c.trees; ++own_rays) {
                for (const Slots slots : {Slots::reserved, Slots::nested}) {
                    Rules rules = rules_for(script, c.generations, slots, Recovery::postpone);
                    rules.own_rays = own_rays;
                    SCOPED_TRACE(std::to_string(own_rays) + " of " + std::to_string(c.trees));
                    EXPECT_TRUE(look("mirrors, own rays", script, rules, n).always_ends());
                }
            }
        }
    }
    // They don't make a machine end that would not with one pixel a cell.
    const Script script = facing_mirrors(Networks::half, 2, 2, 2);
    Rules rules = rules_for(script, 1, Slots::reserved, Recovery::postpone);
    rules.own_rays = 1;
    EXPECT_GT(look("mirrors, one slot", script, rules, Networks::half).traps, 0u);
}

TEST(EveryOrder, OfHitsWithManyShadowRaysEnds) {
    for (const Networks n : acyclic) {
        for (const int shadows : {2, 3}) {
            Script script(2, 1, n);
            for (const bool east : {true, false}) {
                const std::string name = east ? "w" : "e";
                const int x = east ? 0 : 1;
                const double way = east ? 1 : -1;
                const int first = script.add(name, x, 0, 0, 0, 0, End::hit);
                const int second = script.add_child(first, name + "/1", way, 0, 1, End::hit);
                for (int s = 0; s < shadows; ++s) {
                    script.add_child(first, name + "/s" + std::to_string(s), way, 0, 1, End::answer);
                    if (s < 4 - shadows)
                        script.add_child(second, name + "/1s" + std::to_string(s), -way, 0, 1, End::answer);
                }
            }
            EXPECT_TRUE(look("shadows", script, rules_for(script, 2, Slots::reserved, Recovery::postpone), n)
                            .always_ends());
        }
    }
}

TEST(EveryOrder, BetweenFacingMirrorsFartherApartAndWithDeeperBuffersEnds) {
    for (const Networks n : acyclic) {
        for (const int depth : {1, 2}) {
            const Script script = facing_mirrors(n, 3, 1, 4, depth);
            const Rules rules = rules_for(script, 4, Slots::reserved, Recovery::postpone);
            EXPECT_TRUE(look("mirrors apart", script, rules, n).always_ends());
        }
    }
    const Script script = facing_mirrors(Networks::half, 2, 2, 2, 2);
    const Rules rules = rules_for(script, 2, Slots::reserved, Recovery::postpone);
    EXPECT_TRUE(look("mirrors, four trees, depth 2", script, rules, Networks::half).always_ends());
}

TEST(EveryOrder, OfATreeThatComesBackToItsOnlySlotIsALivelock) {
    Script script(2, 1, Networks::half);
    const int root = script.add("0", 0, 0, 0, 0, 0, End::hit);
    const int there = script.add_child(root, "1", 1, 0, 1, End::hit);
    script.add_child(there, "2", -1, 0, 1, End::hit);
    const Result result =
        look("one tree", script, rules_for(script, 1, Slots::reserved, Recovery::postpone), Networks::half);
    EXPECT_EQ(result.deadlocks, 0u);
    EXPECT_GT(result.traps, 0u);
    const Rules enough = rules_for(script, 3, Slots::reserved, Recovery::postpone);
    EXPECT_TRUE(look("one tree", script, enough, Networks::half).always_ends());
}

TEST(EveryOrder, WithFreeSlotsIsALivelockWhereReservedOnesEnd) {
    // Each mirror has as many trees as slots: all wait for a slot of the other mirror.
    const Script script = facing_mirrors(Networks::half, 2, 2, 2);
    const Rules rules = rules_for(script, 2, Slots::free, Recovery::postpone);
    const Result result = look("mirrors, four trees", script, rules, Networks::half);
    EXPECT_EQ(result.deadlocks, 0u);
    EXPECT_GT(result.traps, 0u);
}

/// A ray that waits for a slot stands in the buffer before the child (a shadow ray) that would free the slot.
Script head_of_line(Networks networks) {
    Script script(2, 1, networks);
    for (const bool east : {true, false}) {
        const std::string name = east ? "w" : "e";
        const int x = east ? 0 : 1;
        const double way = east ? 1 : -1;
        const int here = script.add(name, x, 0, 0, 0, 0, End::hit);
        script.add_child(here, name + "/s", way, 0, 1, End::answer);
        script.add(name + "2", x, 0, way, 0, 1, End::hit);  // an oblique primary ray: hits in the next cell
    }
    return script;
}

TEST(EveryOrder, WithoutRecoveryLocksAtTheHeadOfALineWherePostponingEnds) {
    for (const Networks n : acyclic) {
        const Script script = head_of_line(n);
        const Result locked = look("line", script, rules_for(script, 1, Slots::reserved, Recovery::none), n);
        EXPECT_GT(locked.deadlocks, 0u);
        EXPECT_TRUE(
            look("line", script, rules_for(script, 1, Slots::reserved, Recovery::postpone), n).always_ends());
        // With a slot for every ray that may ever wait there, no recovery is needed.
        EXPECT_TRUE(
            look("line", script, rules_for(script, 2, Slots::reserved, Recovery::none), n).always_ends());
    }
}

TEST(EveryOrder, OfVerdictsThatSeveralSlotsShareEnds) {
    // Two hits of one voxel by different generations; the first to come requests the verdict for both (memo).
    for (const Networks n : acyclic) {
        Script script(2, 1, n);
        const int root = script.add("a", 0, 0, 0, 0, 0, End::hit);
        const int other = script.add("b", 1, 0, 0, 0, 0, End::hit);
        const int back = script.add_child(other, "b/1", -1, 0, 1, End::hit);
        const int verdict = script.add_child(root, "memo", 1, 0, 1, End::answer);
        script.also_asked_by(verdict, back);
        const int on = script.add_child(root, "a/1", 1, 0, 1, End::hit);
        script.add_child(on, "a/2", -1, 0, 1, End::direct);
        EXPECT_TRUE(
            look("memo", script, rules_for(script, 2, Slots::reserved, Recovery::postpone), n).always_ends());
    }
}

TEST(EveryOrder, OfRaysToTheExteriorAndBackEnds) {
    for (const Networks n : acyclic) {
        Script script(2, 1, n);
        const int a = script.add("a", 0, 0, 0, 0, 0, End::hit);
        script.add_child(a, "a/out", 1, 0, 1, End::exterior);
        const int b = script.add("b", 1, 0, 0, 0, 0, End::hit);
        script.add_child(b, "b/out", -1, 0.1, 1, End::exterior);
        script.add("c", 0, 0, 0, 0, 1, End::exterior);  // axial: east to the border
        script.add("d", 1, 0, 0.1, -1, 0, End::exterior);
        EXPECT_TRUE(look("exterior", script, rules_for(script, 1, Slots::reserved, Recovery::postpone), n)
                        .always_ends());
    }
}

TEST(EveryOrder, OfPrecastRaysEndsWithoutAnySlot) {
    for (const Networks n : acyclic) {
        Script script(2, 2, n);
        const double ways[4][2] = {{1, 0.9}, {-0.9, 1}, {0.9, -1}, {-1, -0.9}};
        for (int i = 0; i < 4; ++i) {
            const std::string name = std::to_string(i);
            script.add(name + " blocked", i % 2, i / 2, ways[i][0], ways[i][1], 2, End::answer);
            script.add(name + " lit", i % 2, i / 2, ways[i][0], ways[i][1], 1, End::silent);
        }
        EXPECT_TRUE(look("precast", script, rules_for(script, 1, Slots::reserved, Recovery::postpone), n)
                        .always_ends());
    }
}

/// A few random trees in a tiny array, all of one cell or of any; a ray is drawn again when it would leave
/// the array.
Script random_script(property::Random& random, Networks networks, bool of_one_cell = false) {
    const int width = random.whole(1, 3);
    const int height = width == 1 ? random.whole(2, 3) : random.whole(1, 2);
    Script script(width, height, networks);
    const int generations = random.whole(1, 3);
    const auto grow = [&](int parent, bool last) {
        const Ray* from = parent < 0 ? nullptr : &script.rays()[std::size_t(parent)];
        const int x = from ? from->end_x : of_one_cell ? 0 : random.whole(0, width - 1);
        const int y = from ? from->end_y : of_one_cell ? 0 : random.whole(0, height - 1);
        const std::string name = std::to_string(script.rays().size());
        const End ends[] = {End::answer, End::direct, End::exterior};
        const End end = last ? ends[random.whole(0, 2)] : End::hit;
        for (int attempt = 0;; ++attempt) {
            const double dx = random.uniform(-1, 1), dy = random.uniform(-1, 1);
            const int hops = attempt > 20 ? 0 : random.whole(parent < 0 ? 0 : 1, 3);
            if (attempt > 20 && end == End::exterior) return -1;
            try {
                return parent < 0 ? script.add(name, x, y, dx, dy, hops, end)
                                  : script.add_child(parent, name, dx, dy, hops, end);
            } catch (const std::invalid_argument&) {  // left the array: draw another way
            }
        }
    };
    for (int tree = random.whole(2, 3); tree > 0; --tree) {
        int at = grow(-1, false);
        for (int g = 1; g < generations; ++g) {
            if (random.chance(0.3)) grow(at, true);
            at = grow(at, false);
        }
        grow(at, true);
    }
    return script;
}

TEST(EveryOrder, OfRandomTreesEndsWithReservedOrNestedSlotsAndRecovery) {
    int looked_at = 0;
    std::uint64_t states = 0;
    for (const std::uint64_t seed : property::seeds(1, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Networks networks = acyclic[random.whole(0, 1)];
        const Script script = random_script(random, networks);
        const int bound = script.waiting_generations();
        const Slots slots = random.chance(0.5) ? Slots::reserved : Slots::nested;
        const Result result =
            search(script, rules_for(script, bound + random.whole(0, 1), slots, Recovery::postpone), 60000);
        if (!result.complete) continue;
        ++looked_at;
        states += result.states;
        EXPECT_EQ(result.deadlocks, 0u);
        EXPECT_EQ(result.traps, 0u);
    }
    std::cout << looked_at << " scripts, " << states << " states\n";
    EXPECT_TRUE(looked_at > 75 || looked_at == 1) << "most are to be small enough";
}

TEST(EveryOrder, OfRandomTreesOfTheBlockOfOneCellEnds) {
    int looked_at = 0;
    for (const std::uint64_t seed : property::seeds(2001, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Script script = random_script(random, acyclic[random.whole(0, 1)], true);
        const Slots slots = random.chance(0.5) ? Slots::reserved : Slots::nested;
        Rules rules =
            rules_for(script, script.waiting_generations() + random.whole(0, 1), slots, Recovery::postpone);
        rules.own_rays = random.whole(1, 3);
        const Result result = search(script, rules, 60000);
        if (!result.complete) continue;
        ++looked_at;
        EXPECT_EQ(result.deadlocks, 0u);
        EXPECT_EQ(result.traps, 0u);
    }
    std::cout << looked_at << " scripts\n";
    EXPECT_TRUE(looked_at > 75 || looked_at == 1) << "most are to be small enough";
}

TEST(EveryOrder, OfRandomTreesNeverLocksWithRecoveryWhateverTheSlots) {
    int livelocks = 0;
    int looked_at = 0;
    for (const std::uint64_t seed : property::seeds(1001, 150)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Networks networks = acyclic[random.whole(0, 1)];
        const Script script = random_script(random, networks);
        const Slots slots = Slots(random.whole(0, 2));
        const Result result =
            search(script, rules_for(script, random.whole(1, 2), slots, Recovery::postpone), 60000);
        if (!result.complete) continue;
        ++looked_at;
        EXPECT_EQ(result.deadlocks, 0u);
        livelocks += result.traps > 0;
    }
    std::cout << looked_at << " scripts, " << livelocks << " with a livelock\n";
}

}  // namespace
}  // namespace raycell::protocol
