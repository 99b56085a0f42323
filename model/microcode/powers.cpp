// base^exponent by tables or by Schlick's fraction, and the operators digit by digit (numbers/operators.cpp).
#include "model/microcode/operators.hpp"

namespace raycell {

RegisterIndex OperatorWriter::power(const std::string& name, RegisterIndex base, RegisterIndex exponent) {
    const Format& unit = formats_.unit;
    const RegisterIndex result = a_.reg(name, unit.bits(), unit.fraction_bits());
    const PowerMethod method = setting_.numbers.operators.power;
    if (method == PowerMethod::rounded) return result;
    const RegisterIndex zero = a_.constant(name + ".0", 0, 2, unit.fraction_bits());
    const RegisterIndex one = a_.constant(name + ".one", std::int64_t(1) << unit.fraction_bits(), unit.bits(),
                                          unit.fraction_bits());
    a_.move(result, one);
    a_.jump_zero(exponent, name + " done");
    a_.jump_less(base, one, name + " less");
    a_.jump(name + " done");
    a_.label(name + " less");
    a_.move(result, zero);
    a_.jump_negative(base, name + " done");
    a_.jump_zero(base, name + " done");
    if (method == PowerMethod::tables) {
        tables_power(name, base, exponent, result);
    } else {
        schlick_power(name, base, exponent, one, result);
    }
    a_.label(name + " done");
    return result;
}

/// 2^-(exponent · -log2(base)), for a base between 0 and 1. A base is a word of `unit`, so its logarithm is
/// at least 2 - word_bits.
void OperatorWriter::tables_power(const std::string& name, RegisterIndex base, RegisterIndex exponent,
                                  RegisterIndex result) {
    const RegisterIndex count = a_.reg(name + ".count", 8, 0);
    const RegisterIndex down = a_.reg(name + ".down", 8, 0);
    const RegisterIndex m = a_.reg(name + ".m", word_ + 1, f_);
    const RegisterIndex part = a_.reg(name + ".part", word_ + 1, f_);
    const RegisterIndex octaves = a_.reg(name + ".octaves", word_ + 6, f_);
    // 64 octaves leave no bit of a word: the product saturates there.
    const RegisterIndex product = a_.reg(name + ".product", f_ + 7, f_);
    const RegisterIndex minus = a_.reg(name + ".minus", f_ + 8, f_);
    const RegisterIndex whole = a_.reg(name + ".whole", 8, 0);
    const RegisterIndex scale = a_.constant(name + ".scale", formats_.unit.fraction_bits(), 8, 0);
    const RegisterIndex zero = a_.constant(name + ".no", 0, 2, f_);
    a_.count(count, base);
    a_.add(down, count, scale);
    a_.scale(m, base, count, -f_);
    a_.low(part, m, f_);
    const RegisterIndex logarithm = line(name + ".log2", "log2", operators_.logarithms(), part);
    a_.difference(octaves, down, logarithm);
    a_.sum(product, Assembler::none, {{octaves, exponent}});
    // A shift by the product rounded up to a whole number, times 2^(what rounding up added).
    a_.subtract(minus, zero, product);
    a_.low(part, minus, f_);
    a_.high(whole, minus, f_);
    const RegisterIndex mantissa = line(name + ".exp2", "exp2", operators_.exponentials(), part, 1);
    a_.scale(result, mantissa, whole, 1);
}

/// base / (exponent - exponent · base + base) (Schlick 1994), for a base between 0 and 1.
void OperatorWriter::schlick_power(const std::string& name, RegisterIndex base, RegisterIndex exponent,
                                   RegisterIndex one, RegisterIndex result) {
    const Format& power = operators_.exponent_word();
    const int fraction = formats_.unit.fraction_bits() + power.fraction_bits();
    const int bits = power.integer_bits() + fraction + 1;
    const RegisterIndex rest = a_.reg(name + ".rest", formats_.unit.bits(), formats_.unit.fraction_bits());
    const RegisterIndex divisor = a_.reg(name + ".divisor", bits, fraction);
    a_.subtract(rest, one, base);
    a_.sum(divisor, base, {{exponent, rest}});
    const Float inverse = reciprocal(name + ".1/divisor", divisor, bits, fraction);
    a_.sum(result, Assembler::none, {{base, inverse.mantissa}}, inverse.exponent);
    a_.least(result, result, one);
}

/// 1/m by restoring division, a digit each time round; m in [1, 2).
RegisterIndex OperatorWriter::divide(const std::string& name, RegisterIndex m) {
    const bool nearest = setting_.numbers.rounding == Rounding::nearest;
    const RegisterIndex rest = a_.reg(name + ".remainder", word_ + 3, f_);
    const RegisterIndex quotient = a_.reg(name + ".quotient", word_ + 3, f_);
    const RegisterIndex r = a_.reg(name + ".digits", word_ + 1, f_);
    const RegisterIndex one = a_.constant(name + ".whole", std::int64_t(1) << f_, word_ + 1, f_);
    const RegisterIndex last = a_.constant(name + ".last bit", 1, 2, f_);
    // The quotient begins with a 1 that is shifted out of its word when all digits are there.
    const RegisterIndex full = a_.constant(name + ".full", std::int64_t(2) << f_, word_ + 3, f_);
    a_.move(rest, one);
    a_.move(quotient, last);
    a_.label(name + " digit");
    a_.add(quotient, quotient, quotient);
    a_.jump_less(rest, m, name + " digit 0");
    a_.subtract(rest, rest, m);
    a_.add(quotient, quotient, last);
    a_.label(name + " digit 0");
    a_.add(rest, rest, rest);
    a_.jump_less(quotient, full, name + " digit");
    a_.subtract(r, quotient, full);
    if (nearest) {  // the remainder is twice what it was
        a_.jump_less(rest, m, name + " digits end");
        a_.add(r, r, last);
        a_.label(name + " digits end");
    }
    return r;
}

/// 1/sqrt(m), a digit each time round; m in [1, 4). h, a digit longer than the result, is the largest with
/// h^2·m <= 1; `residue` is 1 - h^2·m and `product` is h·m, both in last bits that shrink with each digit.
RegisterIndex OperatorWriter::divide_root(const std::string& name, RegisterIndex m) {
    const RegisterIndex whole = a_.reg(name + ".m as a whole", word_ + 1, 0);
    const RegisterIndex residue = a_.reg(name + ".residue", 2 * word_ + 4, 0);
    const RegisterIndex product = a_.reg(name + ".product", 2 * word_ + 2, 0);
    const RegisterIndex h = a_.reg(name + ".h", word_ + 4, f_ + 1);
    const RegisterIndex odd = a_.reg(name + ".last digit", 2, f_ + 1);
    const RegisterIndex r = a_.reg(name + ".digits", word_ + 1, f_);
    const RegisterIndex start = a_.constant(name + ".quarter", std::int64_t(1) << (f_ - 3), word_ + 1, 0);
    const RegisterIndex none = a_.constant(name + ".none", 0, 2, 0);
    const RegisterIndex last = a_.constant(name + ".last bit", 1, 2, f_ + 1);
    const RegisterIndex full = a_.constant(name + ".full", std::int64_t(4) << f_, word_ + 4, f_ + 1);
    a_.reinterpret(whole, m);
    a_.move(residue, start);
    a_.move(product, none);
    a_.move(h, last);
    a_.label(name + " digit");
    a_.add(product, product, product);
    a_.add(h, h, h);
    a_.jump_sum_negative({{residue, false, 2}, {product, true, 1}, {whole, true}}, name + " digit 0");
    a_.keep(residue);
    a_.add(product, product, whole);
    a_.add(h, h, last);
    a_.jump_less(h, full, name + " digit");
    a_.jump(name + " digits end");
    a_.label(name + " digit 0");
    a_.add(residue, residue, residue);
    a_.add(residue, residue, residue);
    a_.jump_less(h, full, name + " digit");
    a_.label(name + " digits end");
    a_.subtract(h, h, full);
    if (setting_.numbers.rounding == Rounding::nearest) a_.add(h, h, last);
    a_.low(odd, h, 1);
    a_.subtract(h, h, odd);
    a_.round(r, h);
    return r;
}

}  // namespace raycell
