// The exterior processors: they trace the rays that leave the cube through the whole scene, in the classical
// way (paper, section 3.3).
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

/// Connected to every border link. Rays queue in the buffers of the outward border links until a processor is
/// free. Its answer goes back into the same cell after the processor's latency.
class Exterior : public Stage, public Link::Arrivals {
  public:
    Exterior(sc_core::sc_module_name name, Environment& environment, const ExteriorTracer& tracer);

    /// Makes the border links and connects them to the array; to be called before the simulation starts. With
    /// several ranks, rank 0 has the exterior, and its links to the cells of other ranks are half links.
    void join(Array& array, RankExchange* ranks = nullptr);
    /// For the other ranks: makes their halves of the links to rank 0's exterior.
    static void join_remote(Array& array, Environment& environment, RankExchange& ranks);

    const std::vector<std::unique_ptr<Link>>& links() const { return links_; }
    void arrives(std::uint32_t port, int index, Cycle visible) override;
    /// The exterior's part of the wait-for graph.
    void add_places(WaitMap& map) const;
    void add_waits(WaitMap& map) const;
    bool busy() const { return !waiting_.empty() || working_ > 0; }
    /// The statistics of all processors, up to now.
    StageStatistics statistics() const;
    /// Number of rays that processors have taken and not yet answered.
    int working() const { return working_; }
    /// Number of processors that have ever been busy; only these cost memory and time.
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
    // The cost of a step grows with the busy processors only, not with their total number.
    std::deque<Processor> processors_;  ///< those used so far, by number; the lowest idle one is next
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> idle_;  ///< of them
    std::deque<std::uint32_t> at_work_;  ///< in the order in which they end: all take the same time
    std::set<std::uint32_t> done_;       ///< processors whose answers must still leave
    std::set<std::tuple<Cycle, std::uint32_t, int>> waiting_;  ///< (visible, port, class): oldest first
    int working_ = 0;
};

}  // namespace raycell
