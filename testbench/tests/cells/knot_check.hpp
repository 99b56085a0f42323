// An independent check of a deadlock's knot: a search over the dumped graph that uses none of the model's
// code.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace raycell::knot_check {

struct Node {
    bool moves;
    bool all;  ///< waits for all of `waits_for`, not for any
    std::vector<std::size_t> waits_for;
};

/// The largest set of nodes of which none could go on even if everything outside the set did.
inline std::set<std::size_t> dead_nodes(const std::vector<Node>& nodes) {
    std::set<std::size_t> dead;
    for (std::size_t i = 0; i < nodes.size(); ++i) dead.insert(i);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!dead.count(i)) continue;
            const auto freed = [&](std::size_t other) { return !dead.count(other); };
            const auto& targets = nodes[i].waits_for;
            const bool goes_on =
                nodes[i].moves ||
                (!targets.empty() && (nodes[i].all ? std::all_of(targets.begin(), targets.end(), freed)
                                                   : std::any_of(targets.begin(), targets.end(), freed)));
            if (!goes_on) continue;
            dead.erase(i);
            changed = true;
        }
    }
    return dead;
}

/// The dead nodes that `from` waits for, directly or indirectly.
inline std::set<std::size_t> reachable(const std::vector<Node>& nodes, const std::set<std::size_t>& dead,
                                       std::size_t from) {
    std::set<std::size_t> reached;
    std::vector<std::size_t> front = {from};
    while (!front.empty()) {
        const std::size_t node = front.back();
        front.pop_back();
        for (const std::size_t other : nodes[node].waits_for) {
            if (dead.count(other) && reached.insert(other).second) front.push_back(other);
        }
    }
    return reached;
}

/// Why this set is no knot; empty if it is one. In a knot every node is dead, and waits, directly or
/// indirectly, for all of the knot and for nothing dead outside it.
inline std::string objection(const std::vector<Node>& nodes, const std::set<std::size_t>& knot) {
    if (knot.empty()) return "it is empty";
    const std::set<std::size_t> dead = dead_nodes(nodes);
    for (const std::size_t i : knot) {
        if (!dead.count(i)) return "node " + std::to_string(i) + " is not dead";
        if (reachable(nodes, dead, i) != knot)
            return "node " + std::to_string(i) + " does not reach just the knot";
    }
    return "";
}

}  // namespace raycell::knot_check
