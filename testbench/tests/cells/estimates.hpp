// A machine whose cycles tests write out.
#pragma once

#include "model/settings/settings.hpp"

namespace raycell {

/// The default machine with the costs that were estimated by hand and the least of everything: one lane of
/// the feed, as wide as the links of the array, one unit of a kind in a cell, buffers of one message. They
/// stay as they are, whatever programs count and studies find best, so sums of them can stand in tests.
inline MachineSettings estimated_machine() {
    MachineSettings machine;
    machine.costs = CostTable(CostBasis::estimate);
    machine.feed_lanes = 1;
    machine.feed_bits = 20;
    machine.loading_units = 1;
    machine.traversal_units = 1;
    machine.buffer_depth = 1;
    machine.exterior_processors = 64;
    return machine;
}

}  // namespace raycell
