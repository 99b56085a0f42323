#include "cells/units/retry.hpp"

#include <algorithm>

namespace raycell {
namespace {

std::uint64_t jitter(std::uint64_t seed, std::uint64_t ray, std::uint64_t attempt) {
    std::uint64_t h =
        seed * 0x9e3779b97f4a7c15ULL ^ ray * 0xbf58476d1ce4e5b9ULL ^ attempt * 0x94d049bb133111ebULL;
    h ^= h >> 31;
    h *= 0x7fb5d329728ea185ULL;
    return h ^ h >> 27;
}

}  // namespace

Cycle Retry::backoff(const MachineSettings& machine, std::uint64_t ray, unsigned attempt) {
    const Cycle base = machine.costs.backoff << std::min(attempt, 6U);
    return base + jitter(machine.seed, ray, attempt) % base;
}

Cycle Retry::first_start(const MachineSettings& machine, std::uint64_t ray) {
    // No attempt has this number.
    return machine.start_within > 0 ? jitter(machine.seed, ray, most_attempts + 1) % machine.start_within : 0;
}

void Retry::postponed(const MachineSettings& machine, std::uint64_t ray, Cycle now) {
    at_ = now + backoff(machine, ray, attempts_);
    attempts_ = std::uint8_t(std::min<int>(attempts_ + 1, most_attempts));
}

}  // namespace raycell
