// The exterior processors: trace the rays that leave the cube classically, through the whole scene (paper,
// section 3.3).
#pragma once

#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "cells/array.hpp"
#include "pipeline/rank_exchange.hpp"
#include "pipeline/stage.hpp"

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
    void begin(Processor& processor, std::uint32_t port, int index, Cycle now);

    const ExteriorTracer& tracer_;
    std::vector<BorderPort> ports_;
    std::vector<std::unique_ptr<Link>> links_;
    std::vector<Processor> processors_;
    std::set<std::tuple<Cycle, std::uint32_t, int>> waiting_;  ///< (visible, port, class): oldest first
    int working_ = 0;
};

}  // namespace raycell
