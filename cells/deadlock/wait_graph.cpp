#include "cells/deadlock/wait_graph.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace raycell {

const char* name_of(WaitGraph::Kind kind) {
    constexpr const char* names[] = {"buffer", "slot", "child", "own", "shading", "processor", "stage"};
    return names[int(kind)];
}

const char* name_of(WaitGraph::State state) {
    constexpr const char* names[] = {"live", "tail", "knot"};
    return names[int(state)];
}

WaitGraph::Index WaitGraph::add(Node node) {
    nodes_.push_back(std::move(node));
    return Index(nodes_.size() - 1);
}

void WaitGraph::analyse() {
    knots_.clear();
    mark_live();
    find_knots();
    tails_ = std::size_t(std::count_if(nodes_.begin(), nodes_.end(),
                                       [](const Node& node) { return node.state == State::tail; }));
}

/// Propagates from the nodes that move by themselves to their waiters: an OR node is live if one of its
/// successors is, an AND node if all are.
void WaitGraph::mark_live() {
    std::vector<std::vector<Index>> waiters(nodes_.size());
    std::vector<std::size_t> missing(nodes_.size());
    std::vector<Index> front;
    for (Index i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        node.state = State::tail;
        missing[i] = node.all ? node.waits_for.size() : 1;
        for (const Index other : node.waits_for) waiters[other].push_back(i);
        if (node.moves) {
            node.state = State::live;
            front.push_back(i);
        }
    }
    while (!front.empty()) {
        const Index freed = front.back();
        front.pop_back();
        for (const Index waiter : waiters[freed]) {
            if (nodes_[waiter].state == State::live || --missing[waiter] > 0) continue;
            nodes_[waiter].state = State::live;
            front.push_back(waiter);
        }
    }
}

/// Finds the strongly connected components of the dead nodes (Tarjan, without recursion). A component is a
/// knot if no edge leads from it to another dead node.
void WaitGraph::find_knots() {
    constexpr Index none = ~Index(0);
    std::vector<Index> order(nodes_.size(), none);
    std::vector<Index> low(nodes_.size(), none);
    std::vector<Index> component(nodes_.size(), none);
    std::vector<Index> stack;
    std::vector<std::vector<Index>> components;
    Index next = 0;
    struct Visit {
        Index node;
        std::size_t edge;
    };
    std::vector<Visit> path;
    const auto dead = [&](Index i) { return nodes_[i].state != State::live; };
    const auto enter = [&](Index i) {
        order[i] = low[i] = next++;
        stack.push_back(i);
        path.push_back({i, 0});
    };
    for (Index root = 0; root < nodes_.size(); ++root) {
        if (!dead(root) || order[root] != none) continue;
        enter(root);
        while (!path.empty()) {
            Visit& visit = path.back();
            const Index node = visit.node;
            if (visit.edge < nodes_[node].waits_for.size()) {
                const Index other = nodes_[node].waits_for[visit.edge++];
                if (!dead(other)) continue;
                if (order[other] == none) {
                    enter(other);
                } else if (component[other] == none) {
                    low[node] = std::min(low[node], order[other]);
                }
                continue;
            }
            path.pop_back();
            if (!path.empty()) low[path.back().node] = std::min(low[path.back().node], low[node]);
            if (low[node] != order[node]) continue;
            components.emplace_back();
            Index member = none;
            while (member != node) {
                member = stack.back();
                stack.pop_back();
                component[member] = Index(components.size() - 1);
                components.back().push_back(member);
            }
        }
    }
    for (std::vector<Index>& members : components) {
        const Index own = component[members.front()];
        const bool left = std::any_of(members.begin(), members.end(), [&](Index i) {
            return std::any_of(nodes_[i].waits_for.begin(), nodes_[i].waits_for.end(),
                               [&](Index other) { return dead(other) && component[other] != own; });
        });
        if (left) continue;
        const auto older = [&](Index a, Index b) {
            return nodes_[a].since != nodes_[b].since ? nodes_[a].since < nodes_[b].since : a < b;
        };
        std::sort(members.begin(), members.end(), older);
        knots_.push_back(members);
    }
    std::sort(knots_.begin(), knots_.end(), [&](const auto& a, const auto& b) {
        const Node& first = nodes_[a.front()];
        const Node& second = nodes_[b.front()];
        return first.since != second.since ? first.since < second.since : a.front() < b.front();
    });
    for (const auto& knot : knots_) {
        for (const Index i : knot) nodes_[i].state = State::knot;
    }
}

std::vector<WaitGraph::Index> WaitGraph::ring(const std::vector<Index>& knot) const {
    // A node of a knot waits for one in it, so going on from node to node comes back to one seen before; but
    // for one that waits for nothing that there is, which is a knot alone.
    const std::set<Index> members(knot.begin(), knot.end());
    std::vector<Index> path;
    std::map<Index, std::size_t> seen;
    Index at = knot.front();
    while (seen.emplace(at, path.size()).second) {
        path.push_back(at);
        const auto& next = nodes_[at].waits_for;
        const auto found =
            std::find_if(next.begin(), next.end(), [&](Index other) { return members.count(other) > 0; });
        if (found == next.end()) return {at};
        at = *found;
    }
    path.erase(path.begin(), path.begin() + std::ptrdiff_t(seen.at(at)));
    return path;
}

std::uint64_t WaitGraph::formed(const std::vector<Index>& knot) const {
    return nodes_[knot.back()].since;  // nodes of a knot are sorted by `since`
}

}  // namespace raycell
