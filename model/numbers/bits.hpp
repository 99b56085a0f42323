// Bits that numbers take.
#pragma once

#include <cstdint>

namespace raycell {

/// Bits that distinguish `values` values: 0 for one, 1 for two, 2 for three.
constexpr int bits_for(std::int64_t values) {
    int bits = 0;
    while ((std::int64_t(1) << bits) < values) ++bits;
    return bits;
}

}  // namespace raycell
