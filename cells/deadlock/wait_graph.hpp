// The wait-for graph of a machine: what can't move until something else does (design, section 5).
//
// A node is a place of the machine that holds something: a buffer, a slot of a ray store, a child or own ray
// in its register, a shading unit, an exterior processor, a stage. A node waits for one of several others
// (OR: any slot that becomes free will do) or for all of them (AND: a slot waits for all its children). A
// node is live if it can move by itself or if live nodes free it. All other nodes are dead: they never move
// again. A knot is a set of dead nodes in which every node waits, directly or indirectly, for every other and
// for no dead node outside: the deadlock itself. The other dead nodes are tails: they only wait for a knot.
// An empty place is no node, so idle cells do not appear.
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
        int x = 0;  ///< its cell; of a buffer, the cell that its link leads to; outside, the border's cell
        int y = 0;
        int side = -1;      ///< of a buffer: the Side that its link comes from; -1: none
        std::string what;   ///< "input east ray_west", "slot 3", ...
        std::string holds;  ///< the message: "reflected ray 17/42 of generation 1", "answer 'lit' to ray ..."
        std::string wants;  ///< what it waits for, in words
        std::uint64_t since = 0;  ///< latest cycle in which a message in it came to its place
        bool moves = false;       ///< can move by itself, now or after some cycles
        bool all = false;         ///< waits for all of `waits_for`, not for any one
        std::vector<Index> waits_for;
        State state = State::live;  ///< set by analyse()
    };

    /// Adds a node without edges and returns its index.
    Index add(Node node);
    Node& operator[](Index index) { return nodes_[index]; }
    const std::vector<Node>& nodes() const { return nodes_; }

    /// Marks every node as live, tail or knot. A node that neither moves nor waits for anything counts as
    /// dead; a correctly built graph has none.
    void analyse();
    /// After analyse(): the knots, the one with the oldest node first. Each is a list of nodes, oldest first.
    const std::vector<std::vector<Index>>& knots() const { return knots_; }
    /// Nodes of a knot each of which waits for the next one, and the last one for the first; a single node
    /// where a knot has one that waits for none.
    std::vector<Index> ring(const std::vector<Index>& knot) const;
    std::size_t tails() const { return tails_; }
    bool deadlocked() const { return !knots_.empty(); }
    /// Cycle since which a knot exists: nothing in it has moved since then.
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
