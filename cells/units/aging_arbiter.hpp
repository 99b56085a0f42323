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

/// Finds overdue messages and puts them in order. A message is overdue if it had waited for more than
/// `patience` cycles when the current epoch began; overdue ones move before all others, oldest first. The
/// cell looks for them at the start of each epoch in which there may be any, and in every step while there
/// are some, so the result does not depend on how often the cell runs.
class AgingArbiter {
  public:
    static constexpr Cycle patience = 65536;                      ///< starvation bound, cycles
    static constexpr Cycle epoch = patience / 8;                  ///< ages are counted in these
    static_assert(bits_for(patience + epoch + 1) == field::age);  // counted as a register
    static constexpr std::uint32_t others = 1U << 11;  ///< a bit that stands for what was not looked at

    enum class Kind : std::uint8_t { answer, reply, ray };
    struct Overdue {
        Cycle since;
        Kind kind;
        std::size_t index;  ///< the side of an answer, the place of a ray
    };

    /// Whether the cell is to look for what is overdue in this step.
    bool due(Cycle now) const { return now >= look_at_; }
    /// Something new is at the head of a buffer, and may have waited for longer than anybody has.
    void new_head(Cycle now);
    /// The same of an answer, where something overdue is parked: it may be older than its epoch.
    void new_answer() {
        if (parked_) parked_ |= others;
    }
    /// These, bits of the cell's, may move again: if any of them was overdue it is looked at once.
    void unparked(std::uint32_t bits, Cycle now);

    /// One look at all that waits.
    class Look {
      public:
        Look(AgingArbiter& arbiter, Cycle now);
        /// Since when something has waited. `parked`: it can't move before its bit is unparked.
        void add(Cycle since, Kind kind, std::size_t index, std::uint32_t bit = 0, bool parked = false);
        /// What is overdue, oldest first. Decides when to look next.
        std::vector<Overdue> finish();

      private:
        AgingArbiter& arbiter_;
        Cycle now_;
        Cycle began_;   ///< the epoch
        Cycle oldest_;  ///< of what is not overdue
        std::vector<Overdue> overdue_;
    };

  private:
    Cycle look_at_ = patience;
    std::uint32_t parked_ = 0;  ///< bits of what was overdue and parked when it was looked for
};

}  // namespace raycell
