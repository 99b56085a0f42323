// The loading unit (paper, section 3.1): latches broadcast messages and makes the cell's voxels from the
// spans that cross it. It works on one load message at a time; the message stays at the head of its link
// until it can move on.
#pragma once

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

class LoadingUnit {
  public:
    /// Works on the oldest message of `from`, in the cell of column x: load_voxel(rung) cycles for a
    /// span that makes a voxel there, load_forward cycles for others. Returns the message when the work is
    /// over, null before.
    LoadItem* work(const LinkIn& from, int x, const CostTable& costs, HitTest rung, Cycle now,
                   Wakeup& wakeup);
    /// Stores the voxel that the message makes in column x, if any, and advances a span to the next column.
    static void take(LoadItem& item, int x, CellStore& store, const Context& context);
    /// Whether a load message ends in the cell of column x; to be asked before take().
    static bool ends_at(const LoadItem& item, int x, int width);
    /// The message has moved on or ended: the unit is free.
    void finish() { item_ = nullptr; }

    const LoadItem* item() const { return item_; }
    Cycle done() const { return done_; }  ///< first cycle in which it may move on
    /// Whether a message makes a voxel in column x.
    static bool makes_voxel(const LoadItem& item, int x) {
        return item.kind == LoadItem::Kind::span && item.span.x == x;
    }

  private:
    LoadItem* item_ = nullptr;
    Cycle done_ = 0;
};

}  // namespace raycell
