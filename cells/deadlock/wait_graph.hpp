// The wait-for graph of a machine: what can't move until something else does (design, section 5).
//
// A node is a place of the machine that holds something: a buffer, a slot of a ray store, a child or own ray
// on its way out, a shading unit, an exterior processor. It waits for one of several others (any slot that
// becomes free will do: OR) or for all of them (a slot waits for all its children: AND). What can move by
// itself, and what only waits for such, is live; the rest never moves again. Among the dead, a knot is a set
// in which every node waits, directly or not, for every other and for nothing dead outside: the deadlock
// itself. The other dead nodes only wait for a knot: its tails. An empty place is no node, so an idle cell
// never counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace raycell {

class WaitGraph {
  public:
    using Index = std::uint32_t;
    enum class Kind : std::uint8_t { buffer, slot, child, own, shading, processor, stage };
    enum class State : std::uint8_t { live, tail, knot };

    struct Node {
        Kind kind = Kind::buffer;
        int x = 0;  ///< cell that it belongs to; of a buffer, the cell that its link leads to (the border's,
                    ///< outside)
        int y = 0;
        int side = -1;      ///< of a buffer: the Side that its link comes from; -1: none
        std::string what;   ///< "input east ray_west", "slot 3", ...
        std::string holds;  ///< "ray 17/4c2 of generation 1", "answer to ray ...": the message that waits
        std::string wants;  ///< what it waits for, in words
        std::uint64_t since = 0;  ///< cycle in which the last of what it holds came to where it is
        bool moves = false;       ///< can go on by itself, now or after a while
        bool all = false;         ///< waits for all of `waits_for`, not for any
        std::vector<Index> waits_for;
        State state = State::live;  ///< set by analyse()
    };

    /// Adds a node without edges and returns its index.
    Index add(Node node);
    Node& operator[](Index index) { return nodes_[index]; }
    const std::vector<Node>& nodes() const { return nodes_; }

    /// Sorts every node into live, tail and knot. A node that neither moves nor waits for anything counts as
    /// dead: a graph that was built right has none.
    void analyse();
    /// After analyse(): the knots, each a list of nodes, oldest first; the knot with the oldest node first.
    const std::vector<std::vector<Index>>& knots() const { return knots_; }
    std::size_t tails() const { return tails_; }
    bool deadlocked() const { return !knots_.empty(); }
    /// Cycle from which on a knot stands: nothing in it has moved since.
    std::uint64_t formed(const std::vector<Index>& knot) const;

  private:
    void mark_live();
    void find_knots();

    std::vector<Node> nodes_;
    std::vector<std::vector<Index>> knots_;
    std::size_t tails_ = 0;
};

const char* name_of(WaitGraph::Kind kind);
const char* name_of(WaitGraph::State state);

}  // namespace raycell
