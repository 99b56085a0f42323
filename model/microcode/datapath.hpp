// What a microprogram runs on: multipliers, an accumulator, one adder, one shifter, registers.
#pragma once

#include <string>
#include <vector>

namespace raycell {

/// A microprogrammed datapath. In a cycle it runs one instruction: as many products as it has multipliers,
/// all added to the accumulator; or one operation of the adder (add, subtract, compare and jump) or of the
/// shifter (load the accumulator, round it into a register). Operands come from registers; a register that is
/// wider than a multiplier's operand takes part in several products.
struct Datapath {
    std::string name;
    std::string meaning;
    int multipliers = 1;
    /// Bits of a multiplier's two operands, two's complement.
    int first_bits = 20;
    int second_bits = 20;

    /// Products of an operand of `bits` bits with one of `other` bits.
    int products(int bits, int other) const;
};

/// Parts that an operand of `bits` bits is cut into for a multiplier's operand of `width` bits: all but the
/// last have width − 1 bits and no sign.
int parts_of(int bits, int width);

/// The datapaths to choose from, for a word length: "word" (one multiplier, both operands of a word), "wide"
/// (one, whose first operand takes a distance or a depth whole, `wide_bits`), "two" (two of a word).
std::vector<Datapath> datapaths(int word_bits, int wide_bits);

}  // namespace raycell
