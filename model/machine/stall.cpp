#include "model/machine/stall.hpp"

#include <cmath>

namespace raycell {

std::uint64_t mix_bits(std::uint64_t a, std::uint64_t b) {
    // SplitMix64's finaliser, after the bits of a are spread.
    std::uint64_t z = a * 0x9e3779b97f4a7c15ULL ^ (b + 0x632be59bd9b4e019ULL);
    for (int round = 0; round < 2; ++round) {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ z >> 27) * 0x94d049bb133111ebULL;
        z ^= z >> 31;
    }
    return z;
}

std::uint32_t stall_cycles(double probability, std::uint64_t seed, std::uint64_t who, std::uint64_t count) {
    if (!(probability > 0)) return 0;
    const double share = (double(mix_bits(mix_bits(seed, who), count) >> 11) + 0.5) * 0x1p-53;
    // P(n stalls or more) = probability^n; share > 0 bounds it (355 cycles at 0.9).
    return std::uint32_t(std::log(share) / std::log(probability));
}

}  // namespace raycell
