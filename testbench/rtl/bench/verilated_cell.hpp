// A verilated cell with ports by side: the only place that knows how Verilator lays out wide ports.
#pragma once

#include <memory>
#include <string>
#include <type_traits>

#ifdef RTL_WHOLE
#include "Vwhole_cell.h"
#else
#include "Vempty_cell.h"
#endif
#include "raycell_rtl.hpp"

namespace rtl {

#ifdef RTL_WHOLE
using Top = Vwhole_cell;
#else
using Top = Vempty_cell;
#endif

constexpr int sides = 4;
constexpr int load_link = 4;
constexpr int home = 4;  ///< as a goal: the ray store's port
#ifdef RTL_WHOLE
constexpr int replies = ray_store;  ///< that may ask for an output: of the slots
#else
constexpr int replies = 0;
#endif
// Places of rays: buffers by side and class, the own ray's register, the slots' child registers. What asks
// for an output: answers by side, replies, rays by place.
constexpr int ray_classes = classes - 1;
constexpr int own_place = sides * ray_classes;
constexpr int places = own_place + 1 + replies;
constexpr int first_ray = sides + replies;
constexpr int requesters = first_ray + places;

/// Bits of a port, however wide it is.
template <typename Port>
std::uint64_t bits_at(const Port& port, int low, int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
        const int at = low + i;
        std::uint64_t bit = 0;
        if constexpr (std::is_integral_v<Port>) {
            bit = std::uint64_t(port) >> at & 1;
        } else {
            bit = port[std::size_t(at) / 32] >> (at % 32) & 1;
        }
        value |= bit << i;
    }
    return value;
}

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
    /// `id`: of the ray, beside the wires.
    void in(int side, int index, std::uint32_t cycles, const std::string& message, std::uint64_t id);
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
#ifdef RTL_WHOLE
    bool makes_voxel() const { return top_->failed; }
#else
    bool makes_voxel() const { return top_->makes_voxel; }
#endif
    bool idle() const { return top_->idle; }
#ifdef RTL_WHOLE
    /// Edges of the fast clock to one of the cell's; microprograms need so many to end in time.
    static constexpr int fast_edges = 8;
    bool late() const { return top_->late; }
#endif
    Top& top() { return *top_; }
    const Top& top() const { return *top_; }

  private:
    void fast();
    std::unique_ptr<Top> top_;
};

}  // namespace rtl
