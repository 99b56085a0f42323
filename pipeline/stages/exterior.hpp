// The exterior processors: trace the rays that leave the cube classically, through the whole scene (paper,
// section 3.3).
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <queue>
#include <set>
#include <tuple>
#include <vector>

#include "cells/hosts/array.hpp"
#include "pipeline/ranks/rank_exchange.hpp"
#include "pipeline/stages/stage.hpp"

namespace raycell {

/// Joined to every border link. Rays queue in the border links' own buffers until one of the processors is
/// free; its answer goes back over the same border link after the processor's latency.
class Exterior : public Stage, public Link::Arrivals {
  public:
    Exterior(sc_core::sc_module_name name, Environment& environment, const ExteriorTracer& tracer);

    /// Makes the border links and joins them to the array. Before the simulation starts. Of an array that
    /// several ranks share, rank 0 has the exterior; the links of the others' cells are halves.
    void join(Array& array, RankExchange* ranks = nullptr);
    /// For the other ranks: the cells' halves of the links to rank 0's exterior.
    static void join_remote(Array& array, Environment& environment, RankExchange& ranks);

    const std::vector<std::unique_ptr<Link>>& links() const { return links_; }
    void arrives(std::uint32_t port, int index, Cycle visible) override;
    /// The exterior's part of the wait-for graph.
    void add_places(WaitMap& map) const;
    void add_waits(WaitMap& map) const;
    bool busy() const { return !waiting_.empty() || working_ > 0; }
    /// Of all processors, up to now.
    StageStatistics statistics() const;
    /// Rays that its processors have taken and not yet answered.
    int working() const { return working_; }
    /// Processors that have been busy at some time: all that a run takes memory and time for.
    std::size_t processors_used() const { return processors_.size(); }

  private:
    struct BorderPort {
        int x;
        int y;
        Link* from_cell;
        Link* to_cell;
    };
    struct Processor {
        bool busy = false;
        std::uint32_t port = 0;
        Answer answer;
        bool silent = false;
        Cycle done = 0;
    };

    Cycle step(Cycle now) override;
    bool answer(Processor& processor, Cycle now, Cycle& retry);
    std::uint32_t take_idle();
    void begin(std::uint32_t number, std::uint32_t port, int index, Cycle now);

    const ExteriorTracer& tracer_;
    std::vector<BorderPort> ports_;
    std::vector<std::unique_ptr<Link>> links_;
    // A step costs what the busy processors cost, however many there are.
    std::deque<Processor> processors_;  ///< those used so far, by number: the idle one of the lowest is next
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> idle_;  ///< of them
    std::deque<std::uint32_t> at_work_;  ///< in the order in which they will be done: all take as long
    std::set<std::uint32_t> done_;       ///< with answers that still have to leave
    std::set<std::tuple<Cycle, std::uint32_t, int>> waiting_;  ///< (visible, port, class): oldest first
    int working_ = 0;
};

}  // namespace raycell
