// The operators inside other microprograms: 1/x, 1/sqrt(x), a vector's normalisation (numbers/operators.hpp).
#pragma once

#include <array>

#include "model/microcode/programs.hpp"
#include "model/numbers/operators.hpp"

namespace raycell {

/// Writes operators into a program. Labels and registers of each begin with a name of their own.
class OperatorWriter {
  public:
    OperatorWriter(Assembler& assembler, const MicroSetting& setting);

    struct Float {
        RegisterIndex mantissa;
        RegisterIndex exponent;
    };
    /// 1/|x|: a mantissa with word_bits − 1 fraction bits and a whole exponent. `bits`, `fraction`: of x.
    Float reciprocal(const std::string& name, RegisterIndex x, int bits, int fraction);
    /// 1/sqrt(x).
    Float root(const std::string& name, RegisterIndex x, int fraction);
    using Vector = std::array<RegisterIndex, 3>;
    /// What normalise() leaves: |v|^2 = squared · 4^(1 − count), and 1/sqrt(squared). `count` is −floor(log2)
    /// of the largest component as a whole number.
    struct Normalised {
        RegisterIndex count;
        RegisterIndex squared;
        Float inverse;
    };
    /// out = v / |v|, words of `unit`; `bits`: of each of v's components. With `zero`: jumps there if v is 0.
    Normalised normalise(const std::string& name, const Vector& v, int bits, const Vector& out,
                         const std::string& zero = "");
    /// base^exponent, a word of `unit`, as is the base. `exponent` is held as Operators::exponent_word(). For
    /// `rounded`, which has no program, a register that holds the power beforehand.
    RegisterIndex power(const std::string& name, RegisterIndex base, RegisterIndex exponent);
    const Operators& operators() const { return operators_; }

  private:
    /// `more`: bits that the result may have above a mantissa's.
    RegisterIndex line(const std::string& name, const std::string& table_name, const Operators::Table& table,
                       RegisterIndex part, int more = 0);
    RegisterIndex divide(const std::string& name, RegisterIndex m);
    RegisterIndex divide_root(const std::string& name, RegisterIndex m);
    void tables_power(const std::string& name, RegisterIndex base, RegisterIndex exponent,
                      RegisterIndex result);
    void schlick_power(const std::string& name, RegisterIndex base, RegisterIndex exponent, RegisterIndex one,
                       RegisterIndex result);

    Assembler& a_;
    const MicroSetting& setting_;
    Formats formats_;
    Operators operators_;
    int word_;
    int f_;  ///< fraction bits of a mantissa
};

}  // namespace raycell
