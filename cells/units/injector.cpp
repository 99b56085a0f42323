#include "cells/units/injector.hpp"

namespace raycell {

bool Injector::primary_due(Cycle now, Wakeup& wakeup) const {
    if (!primary_to_send_) return false;
    if (now >= retry_.at()) return true;
    wakeup.at(retry_.at());
    return false;
}

bool Injector::primary_sent() {
    const bool first = !primary_awaited_;
    primary_to_send_ = false;
    primary_awaited_ = true;
    return first;
}

void Injector::primary_postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now) {
    primary_to_send_ = true;
    retry_.postponed(machine, ray, now);
}

std::optional<Injector::Precast> Injector::next_precast(std::size_t voxels, std::size_t sources) {
    if (precast_next_ >= std::uint64_t(voxels) * sources) return std::nullopt;
    const Precast next{std::uint32_t(precast_next_ / sources), std::size_t(precast_next_ % sources)};
    ++precast_next_;
    return next;
}

}  // namespace raycell
