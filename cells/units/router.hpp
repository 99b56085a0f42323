// The router: the four output links, and the messages that wait for room behind them.
#pragma once

#include <array>

#include "cells/channels/link.hpp"
#include "cells/units/wakeup.hpp"

namespace raycell {

class Router {
  public:
    void connect(Side side, Link& link) { links_[std::size_t(side)] = &link; }
    /// Null at a border without a link.
    Link* link(Side side) const { return links_[std::size_t(side)]; }
    /// To be called once all links are connected: each then reports new room to its source by the bit of its
    /// side.
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

    /// Whether a message of a class can start over a side now. If the wires are busy, asks for a step when
    /// they are free. If there is no room, the message with these `bits` is parked: it waits for a credit and
    /// need not ask again before the link reports room.
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
    /// Bits of the parked messages.
    std::uint32_t parked() const { return parked_; }
    /// Unparks the messages parked on the outputs whose bits are set in `room_made`, and clears these bits.
    /// Returns the bits of the unparked messages; some of them may have left since they were parked.
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
    std::array<std::uint16_t, side_count> parked_on_{};  ///< parked bits by output
    std::array<Link*, side_count> links_{};
};

}  // namespace raycell
