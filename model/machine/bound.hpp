// Tells before a run whether it is certain to end: the table of cells/deadlock/deadlock.md.
#pragma once

#include <optional>
#include <string>

#include "model/tracing/tracing.hpp"

namespace raycell {

struct Bound {
    /// How a run may end instead of completing.
    enum class May { nothing, livelock, deadlock };
    May may = May::nothing;
    int generations = 0;  ///< G: generations of rays that may have to wait
    /// The smallest ray store with which the run is certain to end, all other options unchanged; empty if
    /// none can be named.
    std::optional<int> ray_store_needed;
    std::string reason;   ///< why the run is certain to end, or not
    std::string options;  ///< options with which the run is certain to end; empty if it already is
    bool met() const { return may == May::nothing; }
    /// Reason and options as text, for a bound that is not met.
    std::string advice() const { return reason + "; certain to end with " + options; }
};
const char* name_of(Bound::May may);

Bound bound_of(const Context& context, const MachineSettings& machine);

}  // namespace raycell
