// Aging: a ready message that has lost arbitration for too long wins over all others. The proof needs it
// (deadlock.md, step 5): without it a stream of postponed notices can starve the messages that would end it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cells/clock/scheduler.hpp"
#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {

/// Finds overdue messages and sorts them. A message is overdue if it had waited for more than `patience`
/// cycles when the current epoch began. Overdue messages move before all others, oldest first. The cell looks
/// for them at the start of each epoch in which there may be any, and in every step while there are some, so
/// the result does not depend on how often the cell runs.
class AgingArbiter {
  public:
    static constexpr Cycle patience = 65536;                      ///< starvation bound, cycles
    static constexpr Cycle epoch = patience / 8;                  ///< unit of ages, cycles
    static_assert(bits_for(patience + epoch + 1) == field::age);  // counted as a register of the cell
    static constexpr std::uint32_t others = 1U << 11;             ///< stands for all that was not looked at

    enum class Kind : std::uint8_t { answer, reply, ray };
    struct Overdue {
        Cycle since;
        Kind kind;
        std::size_t index;  ///< the side of an answer, the place of a ray
    };

    /// Whether the cell must look for overdue messages in this step.
    bool due(Cycle now) const { return now >= look_at_; }
    /// A new message is at the head of a buffer; it may have waited longer than any other.
    void new_head(Cycle now);
    /// A new answer is at the head of a buffer. Matters only while an overdue message is parked: the answer
    /// may be overdue too.
    void new_answer() {
        if (parked_) parked_ |= others;
    }
    /// The messages of these bits (InputPorts) may move again: if one of them was overdue, the cell looks in
    /// this cycle.
    void unparked(std::uint32_t bits, Cycle now);

    /// One look at all waiting messages.
    class Look {
      public:
        Look(AgingArbiter& arbiter, Cycle now);
        /// Adds a message that has waited since cycle `since`. `parked`: it can't move before its bit is
        /// unparked.
        void add(Cycle since, Kind kind, std::size_t index, std::uint32_t bit = 0, bool parked = false);
        /// Returns the overdue messages, oldest first, and decides when to look next.
        std::vector<Overdue> finish();

      private:
        AgingArbiter& arbiter_;
        Cycle now_;
        Cycle began_;   ///< first cycle of the epoch
        Cycle oldest_;  ///< start of the oldest wait that is not overdue
        std::vector<Overdue> overdue_;
    };

  private:
    Cycle look_at_ = patience;
    std::uint32_t parked_ = 0;  ///< bits of messages that the last look found overdue and parked
};

}  // namespace raycell
