#include "model/microcode/operators.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {
namespace {

MicroTable table_of(const std::string& name, const Operators::Table& table) {
    MicroTable lines{name, {}};
    for (const auto& line : table.lines) lines.lines.push_back({std::int64_t(line.start), line.rise});
    return lines;
}

}  // namespace

OperatorWriter::OperatorWriter(Assembler& assembler, const MicroSetting& setting)
    : a_(assembler),
      setting_(setting),
      formats_(setting.formats()),
      operators_(setting.numbers.operators, setting.numbers.word_bits, setting.numbers.rounding),
      word_(setting.numbers.word_bits),
      f_(word_ - 1) {}

/// The line of a table at the argument `part`, rounded to a mantissa.
RegisterIndex OperatorWriter::line(const std::string& name, const std::string& table_name,
                                   const Operators::Table& table, RegisterIndex part, int more) {
    const int rest_bits = table.rest_bits;
    const RegisterIndex r = a_.reg(name + ".r", word_ + 1 + more, f_);
    const RegisterIndex rise = a_.reg(name + ".rise", word_ + 1, f_);
    const RegisterIndex rest = a_.reg(name + ".rest", std::max(rest_bits, 1) + 1, rest_bits);
    a_.table(r, rise, table_of(table_name, table), part, rest_bits);
    a_.low(rest, part, rest_bits);
    a_.sum(r, r, {{rise, rest}});
    return r;
}

OperatorWriter::Float OperatorWriter::reciprocal(const std::string& name, RegisterIndex x, int bits,
                                                 int fraction) {
    const Iteration method = setting_.numbers.operators.reciprocal;
    const RegisterIndex size = a_.reg(name + ".size", bits + 1, fraction);
    const RegisterIndex exponent = a_.reg(name + ".exponent", 8, 0);
    // A mantissa without a sign fills a word; rounded up it may be one more.
    const RegisterIndex rounded = a_.reg(name + ".rounded", word_ + 2, f_);
    const RegisterIndex m = a_.reg(name + ".m", word_ + 1, f_);
    const RegisterIndex part = a_.reg(name + ".part", word_ + 1, f_);
    const RegisterIndex one = a_.constant(name + ".1", 1, 8, 0);
    const RegisterIndex scale = a_.constant(name + ".scale", fraction, 8, 0);
    const RegisterIndex first = a_.constant(name + ".first", std::int64_t(1) << f_, word_ + 1, f_);
    const RegisterIndex over = a_.constant(name + ".over", std::int64_t(2) << f_, word_ + 2, f_);
    a_.absolute(size, x);
    a_.count(exponent, size);
    a_.scale(rounded, size, exponent, -f_);
    a_.add(exponent, exponent, scale);
    a_.jump_less(rounded, over, name + " normal");
    a_.subtract(exponent, exponent, one);
    a_.move(m, first);
    a_.jump(name + " look up");
    a_.label(name + " normal");
    a_.move(m, rounded);
    a_.label(name + " look up");
    if (method == Iteration::rounded) return {divide(name, m), exponent};
    a_.low(part, m, f_);
    const RegisterIndex r = line(name, "reciprocal", operators_.reciprocals(), part);
    if (method == Iteration::newton) {
        a_.sum(part, over, {{m, r, true}});  // 2 − m·r
        a_.sum(r, Assembler::none, {{r, part}});
    }
    return {r, exponent};
}

OperatorWriter::Float OperatorWriter::root(const std::string& name, RegisterIndex x, int fraction) {
    const Iteration method = setting_.numbers.operators.root;
    const RegisterIndex count = a_.reg(name + ".count", 8, 0);
    const RegisterIndex odd = a_.reg(name + ".odd", 8, 0);
    const RegisterIndex exponent = a_.reg(name + ".exponent", 8, 0);
    const RegisterIndex rounded = a_.reg(name + ".rounded", word_ + 2, f_ - 1);
    const RegisterIndex m = a_.reg(name + ".m", word_ + 1, f_ - 1);
    const RegisterIndex part = a_.reg(name + ".part", word_ + 1, f_ - 1);
    const RegisterIndex correction = a_.reg(name + ".correction", word_ + 1, f_);
    const RegisterIndex r = a_.reg(name + ".root", word_ + 1, f_);
    const RegisterIndex scale = a_.constant(name + ".scale", fraction, 8, 0);
    const RegisterIndex two = a_.constant(name + ".2", 2, 8, 0);
    const RegisterIndex one_m = a_.constant(name + ".first", std::int64_t(1) << (f_ - 1), word_ + 1, f_ - 1);
    const RegisterIndex two_m = a_.constant(name + ".octave", std::int64_t(2) << (f_ - 1), word_ + 1, f_ - 1);
    const RegisterIndex four_m = a_.constant(name + ".over", std::int64_t(4) << (f_ - 1), word_ + 2, f_ - 1);
    const RegisterIndex three = a_.constant(name + ".3", std::int64_t(3) << f_, word_ + 2, f_);
    // Minus the exponent of x, made even: x · 2^-exponent lies in [1, 4).
    a_.count(count, x);
    a_.add(count, count, scale);
    a_.low(odd, count, 1);
    a_.add(count, count, odd);
    a_.scale(rounded, x, count, fraction - (f_ - 1));
    a_.jump_less(rounded, four_m, name + " normal");
    a_.subtract(count, count, two);
    a_.move(m, one_m);
    a_.jump(name + " octave");
    a_.label(name + " normal");
    a_.move(m, rounded);
    a_.label(name + " octave");
    if (method == Iteration::rounded) {
        a_.halve(exponent, count);
        return {divide_root(name, m), exponent};
    }
    a_.jump_less(m, two_m, name + " low");
    for (const int octave : {1, 0}) {
        const std::string part_name = name + (octave == 0 ? ".low" : ".high");
        if (octave == 0) a_.label(name + " low");
        const Operators::Table& table = operators_.roots(octave);
        a_.low(part, m, f_ - 1 + octave);
        a_.move(r, line(part_name, "root " + std::to_string(octave), table, part));
        if (octave == 1) a_.jump(name + " looked up");
    }
    a_.label(name + " looked up");
    if (method == Iteration::newton) {
        const RegisterIndex square_root = a_.reg(name + ".sqrt", word_ + 1, f_);
        a_.sum(square_root, Assembler::none, {{m, r}});
        // (3 − sqrt·r) / 2: the sum's last bit is worth half.
        a_.half_sum(correction, three, {{square_root, r, true}});
        a_.sum(r, Assembler::none, {{r, correction}});
    }
    a_.halve(exponent, count);
    return {r, exponent};
}

OperatorWriter::Normalised OperatorWriter::normalise(const std::string& name, const Vector& v, int bits,
                                                     const Vector& out, const std::string& zero) {
    const RegisterIndex size = a_.reg(name + ".largest", bits + 1, 0);
    const RegisterIndex other = a_.reg(name + ".other", bits + 1, 0);
    const RegisterIndex count = a_.reg(name + ".count", 8, 0);
    const RegisterIndex squared =
        a_.reg(name + ".squared", formats_.field.bits(), formats_.field.fraction_bits());
    Vector m;
    a_.absolute_of(size, v[0]);
    for (int i = 1; i < 3; ++i) {
        a_.absolute_of(other, v[std::size_t(i)]);
        a_.most(size, size, other);
    }
    if (!zero.empty()) a_.jump_zero(size, zero);
    a_.count(count, size);
    for (std::size_t i = 0; i < 3; ++i) {
        m[i] = a_.reg(name + ".m" + std::to_string(i), word_, word_ - 1);
        a_.scale(m[i], v[i], count, 2 - word_);
    }
    a_.sum(squared, Assembler::none, {{m[0], m[0]}, {m[1], m[1]}, {m[2], m[2]}});
    const Float inverse = root(name + ".root", squared, formats_.field.fraction_bits());
    for (std::size_t i = 0; i < 3; ++i)
        a_.sum(out[i], Assembler::none, {{m[i], inverse.mantissa}}, inverse.exponent);
    return {count, squared, inverse};
}

}  // namespace raycell
