// The loading unit (paper, section 3.1): latches what is broadcast and makes the cell's voxels from the spans
// that cross it. It works on one load message at a time, which stays at the head of its link until it can go
// on.
#pragma once

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"
#include "model/settings/costs.hpp"

namespace raycell {

class LoadingUnit {
  public:
    /// Works on the oldest message of `from`, for the cell in column x: load_voxel cycles for a span that has
    /// come to it, load_forward for others. Returns the message when that is over, null before.
    LoadItem* work(const LinkIn& from, int x, const CostTable& costs, Cycle now, Wakeup& wakeup);
    /// What the message leaves in the cell of column x; a span goes on to the next column.
    static void take(LoadItem& item, int x, CellStore& store, const Context& context);
    /// Whether a load message ends in the cell of column x, before take().
    static bool ends_at(const LoadItem& item, int x, int width);
    /// The message went on or ended.
    void finish() { item_ = nullptr; }

    const LoadItem* item() const { return item_; }
    Cycle done() const { return done_; }  ///< cycle from which on it may go on
    /// Whether a message makes a voxel in column x.
    static bool makes_voxel(const LoadItem& item, int x) {
        return item.kind == LoadItem::Kind::span && item.span.x == x;
    }

  private:
    LoadItem* item_ = nullptr;
    Cycle done_ = 0;
};

}  // namespace raycell
