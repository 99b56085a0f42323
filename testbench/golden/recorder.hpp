// Golden vectors of a run: everything that some of its cells are told, and everything that they do.
#pragma once

#include <cstdio>
#include <functional>
#include <map>
#include <vector>

#include "pipeline/machine.hpp"
#include "testbench/golden/memory_file.hpp"

namespace raycell {

/// Writes while the run goes on. Make it after the machine and before the first run. It changes nothing in
/// the run.
class GoldenRecorder : public sc_core::sc_module, public LinkObserver, public CellObserver {
  public:
    /// Files are owned by the caller.
    struct Target {
        const Cell* cell;
        std::FILE* file;
        std::FILE* memory_in;   ///< for $readmemh: what the cell is told; null: none
        std::FILE* memory_out;  ///< what it does
    };
    /// `configuration`: TOML that reproduces the run's settings.
    GoldenRecorder(sc_core::sc_module_name name, Machine& machine, std::vector<Target> targets,
                   std::string configuration);

    /// Call when the run is over: writes the pixels and ends the records.
    void finish();

    void cell_event(const Cell&, Cycle, CellEvent, std::uint64_t, std::uint32_t) override {}
    void phase_begins(Phase phase, Cycle first) override;
    void draining(bool on, Cycle now) override;

  private:
    struct Role {
        std::size_t target;
        bool incoming;
        int side;
    };
    void start_of_simulation() override;
    void attach(std::size_t target);
    void watch(Link& link, const Role& role);
    void sent(const Link& link, int index, const Message& message, int cycles, Cycle now) override;
    void popped(const Link& link, int index, const Message& message, Cycle now) override;
    void write(std::size_t target, const GoldenEvent& event);

    Machine& machine_;
    Words words_;
    Packing packing_;
    MemoryText memory_;
    std::vector<Target> targets_;
    std::string configuration_;
    std::map<const Link*, std::vector<Role>> roles_;
    std::vector<Link*> links_;
};

}  // namespace raycell
