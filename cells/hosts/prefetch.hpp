// Asking for memory ahead: in a large array a hop costs what the caches miss, not what it computes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cells/cell.hpp"
#include "cells/memory/fetch_line.hpp"

namespace raycell {

/// Prefetch hints for the next step of cells that lie row by row in memory; no side effects. A host that
/// knows which cells run next calls the four parts in their order, some steps apart and ahead: each reads
/// what the one before has brought.
class Prefetch {
  public:
    Prefetch(const BufferClasses& classes, int width);

    /// What every step looks at, which comes first in a cell. Any client will do: a hint may name any
    /// address.
    static void cell(const void* client);
    /// The buffers that it will read, and the depths that it will compare.
    static void links(const Cell& cell);
    /// What stands at their heads, and who waits for the room behind it.
    void messages(const Cell& cell) const;
    /// Where these messages go.
    void outputs(const Cell& cell) const;

  private:
    static constexpr std::size_t line = 64;      // bytes
    static constexpr std::size_t hot_lines = 7;  // of a cell
    static std::uint32_t rays_of(const Cell& cell) {
        return cell.inputs_.with_rays(cell.pending_) & ~cell.router_.parked();
    }
    static void buffer(const Link& link, std::size_t place);
    template <typename Object>
    static void object(const Object& object);
    void sender(const Cell& cell, std::size_t side, std::uint8_t place) const;
    void neighbour(const Cell& cell, Side side) const;
    void output(const Cell& cell, Side side, int index) const;

    /// Place of a class's buffer in a link, by side of its source: read from here, not from the link.
    std::array<std::array<std::uint8_t, Link::most_classes>, side_count> places_{};
    /// Bytes from a cell to its neighbour. Where the row above or below is another rank's, to some other
    /// cell, and beyond the border to anything.
    std::array<std::ptrdiff_t, side_count> neighbours_;
};

}  // namespace raycell
