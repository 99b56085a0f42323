// A machine whose cycles tests write out.
#pragma once

#include "model/settings/settings.hpp"

namespace raycell {

/// The default machine with the costs that were estimated by hand. They stay as they are, whatever programs
/// count, so sums of them can stand in tests.
inline MachineSettings estimated_machine() {
    MachineSettings machine;
    machine.costs = CostTable(CostBasis::estimate);
    return machine;
}

}  // namespace raycell
