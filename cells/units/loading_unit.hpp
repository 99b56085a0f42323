// The loading unit (paper, section 3.1): latches broadcast messages, passes spans on, and makes the cell's
// voxels from those that cross it.
#pragma once

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

/// It looks at one load message at a time, which stays at the head of its link until it can move on. A span
/// that makes a voxel here is kept: the one at work in the unit's register, those that wait in the voxels'
/// memory, one after the other. So a span need not wait in every cell for its voxel, and a cell at work lets
/// pass what is for others.
class LoadingUnit {
  public:
    /// Looks at the oldest message of `from`, in the cell of column x. Returns it when it may move on:
    /// load_advance cycles after it was first seen if it makes a voxel there, load_forward cycles for others;
    /// null before.
    LoadItem* work(const LinkIn& from, int x, const CostTable& costs, Cycle now, Wakeup& wakeup);
    /// Whether a span can be kept: fewer than `most` are, or `most` is 0. If not, asks to be woken when one
    /// is done. `cycles`: of making a voxel.
    bool has_room(int most, Cycle cycles, Cycle now, Wakeup& wakeup) const;
    /// Spans kept, the one at work included.
    int kept(Cycle cycles, Cycle now) const {
        return made_ > now ? int((made_ - now + cycles - 1) / cycles) : 0;
    }
    /// Keeps a span: its voxel is made after those before it. The model stores the voxel at once, because
    /// nothing reads it before loading is over, so all that it needs to keep is when the last one is made.
    void keep(Cycle cycles, Cycle now) { made_ = std::max(made_, now) + cycles; }
    /// Stores the voxel that the message makes in column x, if any, and advances a span to the next column.
    static void take(LoadItem& item, int x, CellStore& store, const Context& context);
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
    Cycle made() const { return made_; }  ///< first cycle in which all voxels of the spans kept are made
    /// Whether a message makes a voxel in column x.
    static bool makes_voxel(const LoadItem& item, int x) {
        return item.kind == LoadItem::Kind::span && item.span.x == x;
    }

  private:
    LoadItem* item_ = nullptr;
    Cycle done_ = 0;
    Cycle made_ = 0;
    bool closing_ = false;
};

}  // namespace raycell
