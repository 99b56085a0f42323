// The analysis of wait-for graphs, against a search that uses only the definitions.
#include "cells/deadlock/wait_graph.hpp"

#include <gtest/gtest.h>

#include <set>

#include "../property.hpp"
#include "knot_check.hpp"

namespace raycell {
namespace {

using Index = WaitGraph::Index;
using State = WaitGraph::State;

struct Built {
    WaitGraph graph;
    Index moving() { return add(true, false, {}); }
    Index any(std::vector<Index> targets) { return add(false, false, std::move(targets)); }
    Index all(std::vector<Index> targets) { return add(false, true, std::move(targets)); }
    void waits(Index node, std::vector<Index> targets) { graph[node].waits_for = std::move(targets); }
    State state(Index node) const { return graph.nodes()[node].state; }

  private:
    Index add(bool moves, bool all, std::vector<Index> targets) {
        WaitGraph::Node node;
        node.moves = moves;
        node.all = all;
        node.waits_for = std::move(targets);
        node.since = 10 + graph.nodes().size();
        return graph.add(std::move(node));
    }
};

TEST(WaitGraph, WithoutNodesIsNoDeadlock) {
    WaitGraph graph;
    graph.analyse();
    EXPECT_FALSE(graph.deadlocked());
}

TEST(WaitGraph, ARingOfBuffersIsAKnotAndWhatWaitsForItATail) {
    Built b;
    const Index first = b.any({1});
    b.any({2});
    b.any({first});
    const Index tail = b.any({first});
    const Index tail_of_tail = b.any({tail});
    const Index idle = b.moving();
    const Index behind_idle = b.any({idle});
    b.graph.analyse();
    ASSERT_EQ(b.graph.knots().size(), 1u);
    EXPECT_EQ(b.graph.knots()[0], (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(b.state(tail), State::tail);
    EXPECT_EQ(b.state(tail_of_tail), State::tail);
    EXPECT_EQ(b.state(behind_idle), State::live);
    EXPECT_EQ(b.graph.tails(), 2u);
    EXPECT_EQ(b.graph.formed(b.graph.knots()[0]), 12u) << "the last of its nodes to come to rest";
}

TEST(WaitGraph, ARingThatOneOfSeveralWaysLeadsOutOfIsNoKnot) {
    Built b;
    const Index ring = b.any({1});
    b.any({ring, 2});  // any slot will do, and one of them moves
    b.moving();
    b.graph.analyse();
    EXPECT_FALSE(b.graph.deadlocked());
    EXPECT_EQ(b.state(ring), State::live);
}

TEST(WaitGraph, ASlotThatNeedsAllItsChildrenIsDeadWithOneOfThem) {
    Built b;
    const Index slot = b.all({1, 2});
    b.moving();
    const Index child = b.any({slot});
    b.graph.analyse();
    ASSERT_TRUE(b.graph.deadlocked());
    EXPECT_EQ(b.state(slot), State::knot);
    EXPECT_EQ(b.state(child), State::knot);
}

TEST(WaitGraph, TwoRingsAreTwoKnotsTheOlderFirst) {
    Built b;
    b.any({1});
    b.any({0});
    b.any({3});
    b.any({2});
    b.all({0, 2});
    b.graph[0].since = b.graph[1].since = 500;
    b.graph.analyse();
    ASSERT_EQ(b.graph.knots().size(), 2u);
    EXPECT_EQ(b.graph.knots()[0], (std::vector<Index>{2, 3}));
    EXPECT_EQ(b.graph.tails(), 1u);
}

TEST(WaitGraph, OfAnyShapeIsSortedAsASearchWithoutCleverness) {
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        Built b;
        const int size = random.whole(1, 14);
        const double moving = random.uniform(0, 0.3);
        for (int i = 0; i < size; ++i) {
            if (random.chance(moving)) {
                b.moving();
                continue;
            }
            std::vector<Index> targets;
            for (int edges = random.whole(1, 3); edges > 0; --edges)
                targets.push_back(Index(random.whole(0, size - 1)));
            random.chance(0.4) ? b.all(targets) : b.any(targets);
        }
        b.graph.analyse();
        std::vector<knot_check::Node> nodes;
        for (const WaitGraph::Node& n : b.graph.nodes()) {
            nodes.push_back({n.moves, n.all, {n.waits_for.begin(), n.waits_for.end()}});
        }
        const std::set<std::size_t> dead = knot_check::dead_nodes(nodes);
        std::set<std::size_t> found;
        std::set<std::size_t> in_knots;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (b.graph.nodes()[i].state != State::live) found.insert(i);
        }
        EXPECT_EQ(found, dead);
        for (const auto& knot : b.graph.knots()) {
            EXPECT_EQ(knot_check::objection(nodes, {knot.begin(), knot.end()}), "");
            in_knots.insert(knot.begin(), knot.end());
            const std::vector<Index> ring = b.graph.ring(knot);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const auto& targets = b.graph.nodes()[ring[i]].waits_for;
                const Index next = ring[(i + 1) % ring.size()];
                EXPECT_EQ(std::count(knot.begin(), knot.end(), ring[i]), 1);
                EXPECT_TRUE(ring.size() == 1 || std::count(targets.begin(), targets.end(), next) > 0);
            }
        }
        for (const std::size_t i : dead) {
            const std::set<std::size_t> reached = knot_check::reachable(nodes, dead, i);
            const bool leads_to_knot = std::any_of(reached.begin(), reached.end(),
                                                   [&](std::size_t j) { return in_knots.count(j) > 0; });
            EXPECT_TRUE(leads_to_knot) << "what is dead is in a knot or waits for one";
            const bool in_knot = in_knots.count(i) > 0;
            EXPECT_EQ(b.graph.nodes()[i].state, in_knot ? State::knot : State::tail);
        }
    }
}

}  // namespace
}  // namespace raycell
