// The input ports (paper, section 4.3): the buffers at the ends of the four input links, as the cell reads
// them, and the waits of the oldest answers.
#pragma once

#include <array>

#include "cells/channels/link.hpp"

namespace raycell {

/// Ray inputs are the buffers that hold rays, numbered by side, then by class. A message stays in its buffer
/// until it moves on. A word of bits for the waiting messages of a cell has one bit per ray input from bit 0,
/// then one for the cell's own ray, and one per side with answers from bit `answer_bits`.
class InputPorts {
  public:
    static constexpr std::size_t most_ray_inputs = 8;
    static constexpr unsigned answer_bits = 12;

    void connect(Side side, Link& link) { links_[std::size_t(side)] = &link; }
    /// Null over a border without a link.
    Link* link(Side side) const { return links_[std::size_t(side)]; }
    /// To be called once all links are connected: each link then keeps the bits of its buffers in its sink's
    /// pending_.
    void elaborate(const BufferClasses& classes);

    // Rays.
    std::size_t ray_inputs() const { return count_; }
    /// The bits of the ray inputs in the word `pending`.
    std::uint32_t with_rays(std::uint32_t pending) const { return pending & ((1U << count_) - 1); }
    /// The oldest message if it is a ray that has arrived, else null.
    RayPacket* ray(std::size_t input, Cycle now) const {
        const Message* message = link_of(input).head_at(inputs_[input].place, now);
        return message && message->kind == Message::Kind::ray ? message->ray : nullptr;
    }
    /// Cycle since which the oldest ray has been at the head of its buffer.
    Cycle head_since(std::size_t input) const { return link_of(input).head_since_at(inputs_[input].place); }
    /// Removes the oldest ray; returns the bits to clear in pending_. Sets `more` if the next message has
    /// arrived; one on the wires wakes the cell itself, and whether it has left already in this cycle must
    /// not matter.
    std::uint32_t pop_ray(std::size_t input, Cycle now, bool& more) {
        Link& link = link_of(input);
        const std::uint32_t emptied = link.pop_at(inputs_[input].place, now);
        more = link.head_at(inputs_[input].place, now) != nullptr;
        return emptied;
    }

    // Answers, by side.
    static constexpr std::uint32_t answer_bit(std::size_t side) {
        return 1U << (answer_bits + unsigned(side));
    }
    /// The oldest message of the buffer of answers if it is an answer that has arrived, else null.
    Answer* answer(std::size_t side, Cycle now) const {
        const Message* message = links_[side]->head_at(answer_places_[side], now);
        return message && message->kind == Message::Kind::answer ? message->answer : nullptr;
    }
    Cycle answer_arrival(std::size_t side) const { return links_[side]->arrival_at(answer_places_[side]); }
    std::uint32_t pop_answer(std::size_t side, Cycle now, bool& more) {
        const std::uint32_t emptied = links_[side]->pop_at(answer_places_[side], now);
        more = links_[side]->head_at(answer_places_[side], now) != nullptr;
        return emptied;
    }
    /// What the oldest answer waits for.
    Wait& answer_wait(std::size_t side) { return answer_waits_[side]; }
    const std::array<Wait, side_count>& answer_waits() const { return answer_waits_; }

    // Location of a buffer: its side and its place in the link.
    std::size_t side_of(std::size_t input) const { return std::size_t(inputs_[input].side); }
    std::uint8_t place_of(std::size_t input) const { return inputs_[input].place; }
    std::uint8_t answer_place(std::size_t side) const { return answer_places_[side]; }

  private:
    struct RayInput {
        Side side : 2;
        std::uint8_t place : 3;  ///< of its buffer in the link
        RayInput(Side from = Side::east, int at = 0) : side(from), place(std::uint8_t(at & 7)) {}
    };
    static_assert(sizeof(RayInput) == 1 && Link::most_classes < 8);
    Link& link_of(std::size_t input) const { return *links_[std::size_t(inputs_[input].side)]; }

    std::array<RayInput, most_ray_inputs> inputs_{};
    std::array<Link*, side_count> links_{};
    std::array<Wait, side_count> answer_waits_{};
    std::array<std::uint8_t, side_count> answer_places_{};  ///< of the buffers of answers in their links
    std::uint8_t count_ = 0;
};

}  // namespace raycell
