#include "cells/units/injector.hpp"

namespace raycell {

std::optional<unsigned> Injector::primary_due(Cycle now, Wakeup& wakeup) const {
    // In turn, so that none is passed over for ever by others that are postponed again and again.
    const std::uint32_t from_turn = to_send_ >> turn_ << turn_;
    for (std::uint32_t part : {from_turn, to_send_ & ~from_turn}) {
        for (; part; part &= part - 1) {
            const auto number = unsigned(__builtin_ctz(part));
            if (now >= own_[number].retry.at()) return number;
            wakeup.at(own_[number].retry.at());
        }
    }
    if (!begins_another()) return std::nullopt;
    if (now >= made_) return unsigned(__builtin_ctz(~awaited_ & all()));
    wakeup.at(made_);
    return std::nullopt;
}

bool Injector::primary_sent(unsigned number, Cycle made) {
    const auto bit = std::uint16_t(1U << number);
    to_send_ &= std::uint16_t(~bit);
    if (awaited_ & bit) {
        turn_ = std::uint8_t((number + 1) % count_);
        return false;
    }
    awaited_ |= bit;
    own_[number] = {Retry(), int(next_++)};
    made_ = made;
    return true;
}

void Injector::primary_postponed(unsigned number, const MachineSettings& machine, std::uint64_t ray,
                                 Cycle now) {
    to_send_ |= std::uint16_t(1U << number);
    own_[number].retry.postponed(machine, ray, now);
}

std::optional<Injector::Precast> Injector::next_precast(std::size_t voxels, std::size_t sources) {
    if (next_ >= voxels * sources) return std::nullopt;
    const Precast next{std::uint32_t(next_ / sources), next_ % sources};
    ++next_;
    return next;
}

}  // namespace raycell
