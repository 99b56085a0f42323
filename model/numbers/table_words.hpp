// The words of the operators' tables, for those who need the tables themselves: files for hardware, tests.
#pragma once

#include <cstdint>

namespace raycell::table_word {

// Word i of a table of n lines, i from 0 to n, with `fraction_bits` (W - 1): the curve's value at the start
// of line i, or at the end of the last, rounded to the nearest.
std::uint64_t reciprocal(std::uint64_t i, std::uint64_t n, int fraction_bits);  ///< 1/m over [1, 2)
std::uint64_t root(int octave, std::uint64_t i, std::uint64_t n,
                   int fraction_bits);  ///< 1/sqrt(m), [1, 2) or [2, 4)
std::uint64_t logarithm(std::uint64_t i, std::uint64_t n, int fraction_bits);    ///< log2(m) over [1, 2)
std::uint64_t exponential(std::uint64_t i, std::uint64_t n, int fraction_bits);  ///< 2^x over [0, 1)

}  // namespace raycell::table_word
