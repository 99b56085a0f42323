// Probes: waveforms of the signals of some cells, cycle by cycle.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cells/probes/cell_view.hpp"
#include "cells/probes/vcd_writer.hpp"

namespace raycell {

struct ProbeSettings {
    Cycle from = 0;                    ///< first cycle of the window
    Cycle to = never;                  ///< last cycle of the window
    std::uint64_t limit = 1024000000;  ///< bytes of the dump
    Cycle mark = never;                ///< where viewers open, with a marker; `never`: at the first cycle
};

/// Observes cells of one environment and writes a dump of their signals (docs/use/probes.md lists them). The
/// values at a cycle's time are those at its end. A probe changes nothing in a run.
class Probe {
  public:
    /// Cells without a connection on a side have no signals there. The cells must be elaborated before
    /// the first sample. `warn` is called with what the user should know about the dump's size.
    Probe(std::vector<const Cell*> cells, const Environment& environment, std::FILE* file,
          const ProbeSettings& settings, std::function<void(const std::string&)> warn);

    /// To be called by the scheduler's sampler, and once more after the last cycle.
    void sample(Cycle now);
    /// The run is over after cycle `last`: ends the dump.
    void finish(Cycle last);

    /// Whether the dump has any cycle; false if the window begins after the run's end.
    bool begun() const { return begun_; }
    std::uint64_t bytes() const { return vcd_.bytes(); }
    /// The text of GTKWave's save file (save_file.hpp).
    std::string save_file(const std::string& name) const;

  private:
    using Signal = VcdWriter::Signal;
    struct BufferSignals {
        const Link* link;
        int index;
        int last_occupancy;
        std::string name;       ///< "cell_0_1.west.answer"
        bool quiet = true;      ///< no message was in it so far
        bool on_wires = false;  ///< held only unseen messages: the first appears without a step
        Signal full, occupancy, type, ray, stall;
    };
    struct UnitSignals {
        Signal state, operation, ray;
    };
    struct SlotSignals {
        Signal state, ray, child, stall;
    };
    struct CellSignals {
        const Cell* cell;
        std::vector<BufferSignals> buffers;
        std::vector<UnitSignals> traversal;
        UnitSignals shading, loading;
        Signal own_type, own_ray, own_stall;
        Signal store_occupancy;
        std::vector<SlotSignals> slots;
    };

    void declare();
    void declare_cell(const Cell& cell);
    void declare_side(CellSignals& cell, int side);
    void declare_buffer(CellSignals& cell, const Link& link, int index, const std::string& where,
                        const char* name);
    UnitSignals declare_unit(const char* name, bool of_rays);
    void begin(Cycle cycle);
    void sample_cell(CellSignals& cell, Cycle now);
    void sample_buffer(const Cell& cell, BufferSignals& buffer, Cycle now);
    void sample_unit(const UnitSignals& signals, const UnitView& unit, bool of_rays);
    void sample_slots(const CellSignals& signals, const Cell& cell, Cycle now);
    void sample_all(Cycle now, bool everything);
    void look_at_size(Cycle now);
    double expected_bytes(Cycle now) const;

    std::vector<const Cell*> watched_;
    const Environment& env_;
    ProbeSettings settings_;
    std::function<void(const std::string&)> warn_;
    VcdWriter vcd_;
    std::vector<CellSignals> cells_;
    Signal phase_ = 0;
    Signal cycle_ = 0;
    std::uint64_t look_at_ = 0;      ///< bytes of the dump at which its size is checked next
    std::uint64_t phase_bytes_ = 0;  ///< bytes of the dump when the phase began
    Phase last_phase_ = Phase::load;
    bool warned_ = false;
    bool declared_ = false;
    bool begun_ = false;
    bool done_ = false;
};

/// A period in whole picoseconds, the unit of the waveforms.
std::uint64_t picoseconds(const sc_core::sc_time& period);

}  // namespace raycell
