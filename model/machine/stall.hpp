// Seeded random stalls, for testing that they change nothing but times.
#pragma once

#include <cstdint>

namespace raycell {

/// Cycles by which the `count`-th action of `who` (a link, a unit) is stalled. Geometrically distributed:
/// each further cycle has `probability` (0 to 0.9). Depends on its arguments alone, so not on the order in
/// which cells run.
std::uint32_t stall_cycles(double probability, std::uint64_t seed, std::uint64_t who, std::uint64_t count);

/// Hashes two words into 64 well mixed bits.
std::uint64_t mix_bits(std::uint64_t a, std::uint64_t b);

}  // namespace raycell
