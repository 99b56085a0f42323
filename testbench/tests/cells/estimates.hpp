// A machine whose cycles tests write out.
#pragma once

#include "model/settings/settings.hpp"

namespace raycell {

/// The default machine with the costs that were estimated by hand, and with the narrowest feed: one lane, as
/// wide as the links of the array. They stay as they are, whatever programs count and studies find best, so
/// sums of them can stand in tests.
inline MachineSettings estimated_machine() {
    MachineSettings machine;
    machine.costs = CostTable(CostBasis::estimate);
    machine.feed_lanes = 1;
    machine.feed_bits = 20;
    return machine;
}

}  // namespace raycell
