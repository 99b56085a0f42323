// The wait-for graph of a whole machine: its cells, the stages before them and the exterior.
#pragma once

#include <vector>

#include "cells/deadlock/cell_waits.hpp"
#include "pipeline/machine_parts.hpp"

namespace raycell {

class MachineWaits {
  public:
    explicit MachineWaits(const MachineParts& parts) : parts_(parts), ranks_(parts.ranks) {}

    /// The analysed wait-for graph of the machine's present state. With several ranks, all must call it; each
    /// gets the whole graph.
    WaitGraph graph() const;

  private:
    void add_places(const Band& band, WaitMap& map) const;
    void add_waits(const Band& band, WaitMap& map) const;
    bool has_outside() const;
    void add_outside_places(WaitMap& map) const;
    void add_outside_waits(WaitMap& map) const;
    struct FarBuffer;
    void add_far_buffers(const WaitMap& map, int band, std::vector<FarBuffer>& far) const;
    std::vector<WaitGraph::Index> put_places_together(WaitMap& map) const;
    void put_together(WaitMap& map) const;

    const MachineParts& parts_;
    RankExchange* ranks_;
};

}  // namespace raycell
