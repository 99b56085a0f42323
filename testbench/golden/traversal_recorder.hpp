// Golden vectors of the traversal units of some cells of a run.
#pragma once

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "pipeline/machine.hpp"
#include "testbench/golden/traversal.hpp"

namespace raycell {

/// Writes while the run goes on. It changes nothing in the run.
class TraversalRecorder : public CellObserver {
  public:
    struct Target {
        const Cell* cell;
        std::FILE* file;  ///< owned by the caller
    };
    /// `configuration`: TOML that reproduces the run's settings. The machine must outlive this.
    TraversalRecorder(Machine& machine, const std::vector<Target>& targets, std::string configuration);

    /// Call when the run is over: ends the records.
    void finish();

    void cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                    std::uint32_t detail) override;
    void phase_begins(Phase phase, Cycle first) override;

  private:
    void begin();

    const Environment& environment_;
    Words words_;
    Packing packing_;
    std::map<const Cell*, std::FILE*> files_;
    std::string configuration_;
    bool begun_ = false;
};

}  // namespace raycell
