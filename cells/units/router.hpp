// The router: the four links out, and who waits for room behind them.
#pragma once

#include <array>

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"

namespace raycell {

class Router {
  public:
    void connect(Side side, Link& link) { links_[std::size_t(side)] = &link; }
    /// Null over a border without a link.
    Link* link(Side side) const { return links_[std::size_t(side)]; }
    /// All links are connected: each tells its source of room by the bit of its side.
    void elaborate() {
        for (unsigned side = 0; side < side_count; ++side) {
            if (links_[side]) links_[side]->tell_room(1U << side);
        }
    }

    /// The side over which an answer leaves cell (x, y) for its home: along x, then along y.
    static Side way_home(const Answer& answer, int x, int y) {
        if (answer.home_x != x) return answer.home_x > x ? Side::east : Side::west;
        return answer.home_y > y ? Side::south : Side::north;
    }

    /// Whether a message of a class can start over a side now. If the wires are busy the cell is to run when
    /// they are free. If there is no room, whoever asks with `bits` is parked: no credit, no use in asking
    /// again before the link says that room was made.
    Link::Room ask(Side side, int index, std::uint32_t bits, Wakeup& wakeup) {
        Link& out = *links_[std::size_t(side)];
        if (out.can_send(index, wakeup.next)) return Link::Room::free;
        const Link::Room room = out.room(index);
        if (room == Link::Room::full && out.sender_waits(index)) {
            parked_ |= bits;
            parked_on_[std::size_t(side)] |= std::uint16_t(bits);
        }
        return room;
    }
    /// Bits of what waits for room behind an output.
    std::uint32_t parked() const { return parked_; }
    /// Room was made behind the outputs whose bits are set: who is parked on them may ask again. Clears the
    /// bits and returns those of whom it concerns; some may have left since.
    std::uint32_t unpark(std::uint32_t& room_made) {
        std::uint32_t unparked = 0;
        for (; room_made; room_made &= room_made - 1) {
            std::uint16_t& bits = parked_on_[std::size_t(__builtin_ctz(room_made))];
            unparked |= bits;
            bits = 0;
        }
        parked_ &= ~unparked;
        return unparked;
    }

  private:
    std::uint32_t parked_ = 0;
    std::array<std::uint16_t, side_count> parked_on_{};  ///< by output
    std::array<Link*, side_count> links_{};
};

}  // namespace raycell
