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
    /// out = v / |v|, words of `unit`; `bits`: of each of v's components.
    void normalise(const std::string& name, const Vector& v, int bits, const Vector& out);

  private:
    RegisterIndex line(const std::string& name, const MicroTable& table, RegisterIndex part, int rest_bits);

    Assembler& a_;
    const MicroSetting& setting_;
    Formats formats_;
    Operators operators_;
    int word_;
    int f_;  ///< fraction bits of a mantissa
};

}  // namespace raycell
