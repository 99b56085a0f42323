// The loading units (paper, section 3.1): latch broadcast messages, pass spans on, and make the cell's voxels
// from those that cross it.
#pragma once

#include <algorithm>
#include <array>

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// A cell looks at one load message at a time, which stays at the head of its link until it can move on. A
/// span that makes a voxel here is kept: those at work in the units' registers, those that wait in the
/// voxels' memory. So a span need not wait in every cell for its voxel, and a cell at work lets pass what is
/// for others. A unit makes one voxel at a time, the units take the spans in turn.
class LoadingUnits {
  public:
    /// `count`: units of the cell, 1..most_units.
    explicit LoadingUnits(int count) : count_(std::uint8_t(count)) {}

    /// Looks at the oldest message of `from`, in the cell of column x. Returns it when it may move on:
    /// load_advance cycles after it was first seen if it makes a voxel there, load_forward cycles for others;
    /// null before.
    LoadItem* work(const LinkIn& from, int x, const CostTable& costs, Cycle now, Wakeup& wakeup);
    /// Whether a span can be kept: fewer than `most` are, or `most` is 0. If not, asks to be woken when one
    /// is done. `cycles`: of making a voxel.
    bool has_room(int most, Cycle cycles, Cycle now, Wakeup& wakeup) const;
    /// Spans kept, those at work included.
    int kept(Cycle cycles, Cycle now) const;
    int count() const { return count_; }
    /// Keeps a span: a unit makes its voxel after those that it has taken before. All voxels take equally
    /// long, so the units in turn is the same as the first that is free. The model stores the voxel at once,
    /// because nothing reads it before loading is over: it only keeps until when each unit is at work. The
    /// traversal unit, idle while loading, puts one voxel after the other in order: `ordering` cycles for
    /// this one, once it is made.
    void keep(Cycle cycles, Cycle ordering, Cycle now);
    /// Stores the voxel that the message makes in column x, if any, and advances a span to the next column.
    /// Returns the lines of the index table that were read to put it in order.
    static std::uint32_t take(LoadItem& item, int x, CellStore& store, const Context& context);
    /// Whether a load message ends in the cell of column x; to be asked before take().
    static bool ends_at(const LoadItem& item, int x, int width);
    /// The message has moved on or ended.
    void finish() { item_ = nullptr; }
    /// The end-of-scene mark has passed: the cell is loaded once its last voxel is made.
    void close() { closing_ = true; }
    /// Whether the cell is loaded in this cycle for the first time.
    bool closes(Cycle now, Wakeup& wakeup);

    const LoadItem* item() const { return item_; }
    Cycle done() const { return done_; }  ///< first cycle in which the message may move on
    /// First cycle in which all voxels of the spans kept are made and in order.
    Cycle made() const { return std::max(ordered_, *std::max_element(made_.begin(), made_.end())); }
    /// Cycles that the units still need for the spans kept, added.
    Cycle to_make(Cycle now) const;
    /// Whether a message makes a voxel in column x.
    static bool makes_voxel(const LoadItem& item, int x) {
        return item.kind == LoadItem::Kind::span && item.span.x == x;
    }

  private:
    LoadItem* item_ = nullptr;
    Cycle done_ = 0;
    std::array<Cycle, most_units> made_{};  ///< per unit: when the last of its voxels is made
    Cycle ordered_ = 0;                     ///< when the last voxel is in its place in the index table
    std::uint8_t turn_ = 0;                 ///< the unit that takes the next span
    std::uint8_t count_;
    bool closing_ = false;
};

}  // namespace raycell
