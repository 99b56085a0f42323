#include "cells/meters/counters.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace raycell {

void join(Counters& sum, const Counters& other) {
    // Adds all words but the maxima at the end, so that no new counter can be forgotten here.
    static_assert(std::is_trivially_copyable_v<Counters> && sizeof(Counters) % sizeof(std::uint64_t) == 0);
    constexpr std::size_t words = sizeof(Counters) / sizeof(std::uint64_t);
    constexpr std::size_t maxima = 3;
    static_assert(offsetof(Counters, most_kept) == (words - maxima) * sizeof(std::uint64_t));
    std::uint64_t a[words];
    std::uint64_t b[words];
    std::memcpy(a, &sum, sizeof sum);
    std::memcpy(b, &other, sizeof other);
    for (std::size_t i = 0; i < words; ++i) a[i] = i < words - maxima ? a[i] + b[i] : std::max(a[i], b[i]);
    std::memcpy(static_cast<void*>(&sum), a, sizeof sum);
}

}  // namespace raycell
