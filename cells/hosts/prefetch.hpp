// Prefetching: in a large array the cost of a hop is its cache misses, not its computation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cells/cell.hpp"
#include "cells/memory/fetch_line.hpp"

namespace raycell {

/// Prefetch hints for the next step of cells that lie row by row in memory; no side effects. A host that
/// knows which cells run next calls the four functions in their order, some cells ahead and some cells apart:
/// each reads what the one before has brought.
class Prefetch {
  public:
    Prefetch(const BufferClasses& classes, int width);

    /// The data that every step reads, which comes first in a cell. `client` need not be a cell: a hint may
    /// name any address.
    static void cell(const void* client);
    /// The buffers that the cell will read, and the depths that it will compare.
    static void links(const Cell& cell);
    /// The messages at the heads of these buffers, and the senders that wait for their room.
    void messages(const Cell& cell) const;
    /// The outputs to which these messages go.
    void outputs(const Cell& cell) const;

  private:
    static constexpr std::size_t line = 64;      // bytes
    static constexpr std::size_t hot_lines = 8;  // of a cell
    static std::uint32_t rays_of(const Cell& cell) {
        return cell.inputs_.with_rays(cell.pending_) & ~cell.router_.parked();
    }
    static void buffer(const Link& link, std::size_t place);
    template <typename Object>
    static void object(const Object& object);
    void sender(const Cell& cell, std::size_t side, std::uint8_t place) const;
    void neighbour(const Cell& cell, Side side) const;
    void output(const Cell& cell, Side side, int index) const;

    /// Place of a class's buffer in a link, by the side of the link's source. Read from here, to spare an
    /// access to the link.
    std::array<std::array<std::uint8_t, Link::most_classes>, side_count> places_{};
    /// Bytes from a cell to its neighbour. If the neighbouring row is another rank's, this leads to some
    /// other cell, and beyond the border to any address.
    std::array<std::ptrdiff_t, side_count> neighbours_;
};

}  // namespace raycell
