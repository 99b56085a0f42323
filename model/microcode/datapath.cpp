#include "model/microcode/datapath.hpp"

#include <algorithm>

namespace raycell {

int parts_of(int bits, int width) { return bits <= width ? 1 : 1 + (bits - width + width - 2) / (width - 1); }

int Datapath::products(int bits, int other) const {
    return parts_of(bits, first_bits) * parts_of(other, second_bits);
}

std::vector<Datapath> datapaths(int word_bits, int wide_bits) {
    // A bit more than a word, for words without a sign too.
    const int word = word_bits + 1;
    return {{"word", "one multiplier of words", 1, word, word},
            {"wide", "one multiplier, one of its operands as wide as a distance or a depth", 1,
             std::max(wide_bits, word), word},
            {"two", "two multipliers of words", 2, word, word}};
}

}  // namespace raycell
