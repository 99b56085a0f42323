// A verilated cell with ports by side: the only place that knows how Verilator lays out wide ports.
#pragma once

#include <memory>
#include <string>

#include "Vempty_cell.h"
#include "raycell_rtl.hpp"

namespace rtl {

constexpr int sides = 4;
constexpr int load_link = 4;
constexpr int home = 4;  ///< as a goal: the ray store's port

#ifdef RTL_FAULTS
extern int fault_of_all;  ///< the error that is put into every cell (sv/raycell_numbers.sv); 0: none
#endif

/// What a cell sends in a cycle.
struct Sent {
    int index;
    int cycles;
    std::string message;  ///< digits, the first bit sent on the left
};

class VerilatedCell {
  public:
    VerilatedCell(VerilatedContext& context, int x, int y);

    /// Out of reset; `viewer`: the digits of the viewer's message for a record without it, or empty.
    void reset(const std::string& viewer);
    /// Begins a cycle: clears all that the cell is told.
    void begin(std::uint64_t now);
    void phase(int code, bool begins);
    void drain(bool on) { top_->draining = on; }
    void in(int side, int index, std::uint32_t cycles, const std::string& message);
    void free(int side, int index);
    /// Settles all outputs of this cycle.
    void settle() { top_->eval(); }
    /// Ends the cycle: registers take their new values.
    void clock();

    bool takes(int side, int index) const { return top_->take >> (side * classes + index) & 1; }
    bool takes_any() const { return top_->take != 0; }
    bool sends(int side) const { return top_->out_valid >> side & 1; }
    bool sends_any() const { return top_->out_valid != 0; }
    Sent sent(int side) const;
    bool pixel() const { return top_->pixel_valid; }
    std::string pixel_digits() const;
    bool makes_voxel() const { return top_->makes_voxel; }
    bool idle() const { return top_->idle; }
    Vempty_cell& top() { return *top_; }

  private:
    std::unique_ptr<Vempty_cell> top_;
};

}  // namespace rtl
