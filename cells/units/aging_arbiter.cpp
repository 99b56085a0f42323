#include "cells/units/aging_arbiter.hpp"

#include <algorithm>
#include <tuple>

namespace raycell {

void AgingArbiter::new_head(Cycle now) { look_at_ = std::min(look_at_, (now / epoch + 1) * epoch); }

void AgingArbiter::unparked(std::uint32_t bits, Cycle now) {
    if (parked_ & (bits | others)) look_at_ = std::min(look_at_, now);
}

AgingArbiter::Look::Look(AgingArbiter& arbiter, Cycle now)
    : arbiter_(arbiter), now_(now), began_(now / epoch * epoch), oldest_(now) {
    arbiter_.parked_ = 0;
}

void AgingArbiter::Look::add(Cycle since, Kind kind, std::size_t index, std::uint32_t bit, bool parked) {
    if (since >= began_ || began_ - since <= patience) {
        oldest_ = std::min(oldest_, since);
    } else if (parked) {
        arbiter_.parked_ |= bit;
    } else {
        overdue_.push_back({since, kind, index});
    }
}

std::vector<AgingArbiter::Overdue> AgingArbiter::Look::finish() {
    // A message that arrives later, or that stands in a buffer behind one that is not overdue, is younger.
    // The exception is an answer behind a ray, possible only where both share a buffer: new_head() handles
    // it.
    arbiter_.look_at_ = overdue_.empty() ? ((oldest_ + patience) / epoch + 1) * epoch : now_ + 1;
    std::sort(overdue_.begin(), overdue_.end(), [](const Overdue& a, const Overdue& b) {
        return std::tie(a.since, a.kind, a.index) < std::tie(b.since, b.kind, b.index);
    });
    return std::move(overdue_);
}

}  // namespace raycell
