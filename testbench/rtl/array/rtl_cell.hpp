// What rtl_tb and the library of a verilated cell agree on. It names nothing of the model and nothing of
// Verilator: the library is built for one machine, rtl_tb for all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rtl {

constexpr int load_side = 4;      ///< as the side of a place: the load link of the first column
constexpr int own_register = 5;   ///< as the side of a place: the register of the own ray
constexpr int slot_register = 6;  ///< the same: the child register of slot `index`
constexpr int to_home = 4;        ///< as a goal: the cell itself
constexpr int to_nobody = 5;      ///< as a goal: it ends here without an answer
constexpr int to_slot = 6;        ///< as a goal: a slot of the ray store, of a hit

/// Where a message stands: the buffer of a class at the end of the link from `side` (or the load link), or
/// the own ray's register, or a slot's.
struct CellPlace {
    int side = 0;
    int index = 0;
};

/// What a cell does in a cycle. A cycle's events come in the order of the schedule: a job that ended, overdue
/// messages, answers and replies, rays that are made, rays, tests, a job that begins.
struct CellAct {
    enum class What : std::uint8_t {
        load,    ///< a load message was taken; `to` is 0, or nobody if it ends here
        loaded,  ///< the last voxel is made; only of a cell that makes voxels
        launch,  ///< the own ray, or a slot's child, came into its register
        answer,  ///< an answer left its buffer, or asks to (`waits`)
        ray,     ///< a decided ray left its place, or asks to
        test,    ///< the test of the ray in a place began
        reply,   ///< the reply of slot `slot` left, or asks to
        shades,  ///< the shading of slot `slot` began, or its set-up (`first`)
        shaded   ///< it ended with the cycle before
    };
    What what = What::test;
    CellPlace place;
    int to = 0;               ///< side, home or nobody
    bool waits = false;       ///< it asks and can't go
    bool full = false;        ///< of one that waits: the cell believes that the far buffer is full
    std::uint64_t since = 0;  ///< of an answer, a reply or a ray: the cycle from which it asks
    int slot = 0;             ///< of a hit: that it takes; of reply, shades and shaded
    bool first = false;
};

/// A message on its way out.
struct CellMessage {
    int index = 0;         ///< buffer class
    int cycles = 0;        ///< on the link
    std::string digits;    ///< hexadecimal, the first bit sent on the left, filled up with zeros
    std::uint64_t id = 0;  ///< what no wire carries; only of a cell that has_ids()
};

/// One cell. In each cycle: begin(), phase(), drain(), settle(), then the outputs; arrivals and free places
/// of the cycle may be told after that, because no output of the same cycle depends on them; then clock().
class ArrayCell {
  public:
    virtual ~ArrayCell() = default;

    /// Out of reset. `viewer`: the digits of the viewer's message, for a cell that is not to load itself.
    virtual void reset(const std::string& viewer) = 0;

    virtual void begin(std::uint64_t now) = 0;
    virtual void phase(int code, bool begins) = 0;
    virtual void drain(bool on) = 0;
    virtual void settle() = 0;
    /// A message can be seen from the next cycle on.
    virtual void arrives(int side, int index, const std::string& digits, std::uint64_t id) = 0;
    /// A place at the far end is free from the next cycle on.
    virtual void frees(int side, int index) = 0;
    virtual void clock() = 0;

    // The settled outputs.
    virtual const std::vector<CellAct>& acts() = 0;
    virtual CellMessage sent(int side) const = 0;
    virtual std::vector<std::uint64_t> pixel() const = 0;  ///< its three words, when its answer is home
    virtual bool idle() const = 0;                         ///< nothing happens before something comes
    virtual bool still() const = 0;                        ///< nor before a place at a far end is freed
    virtual std::string refusal() const = 0;               ///< what it was given and can't do; empty: nothing

    virtual bool makes_voxels() const = 0;
    virtual bool has_ids() const = 0;
};

/// A library has these two functions, with C's names: rtl_make_cell and rtl_put_fault. `fault`: a number of
/// raycell_numbers.sv, 0 for none; false if the cell was built without faults.
using MakeCell = ArrayCell* (*)(int x, int y);
using PutFault = bool (*)(int fault);
constexpr const char* make_cell_name = "rtl_make_cell";
constexpr const char* put_fault_name = "rtl_put_fault";

}  // namespace rtl
