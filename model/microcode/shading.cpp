// Programs of the shading unit.
#include "model/microcode/operators.hpp"

namespace raycell {
namespace {

using Vector = OperatorWriter::Vector;

Vector vector(Assembler& a, const std::string& before, const std::string& after, int bits, int fraction) {
    Vector v{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = a.reg(before + "xyz"[i] + after, bits, fraction);
    return v;
}

Vector vector(Assembler& a, const std::string& before, const Format& format) {
    return vector(a, before, "", format.bits(), format.fraction_bits());
}

}  // namespace

MicroProgram reciprocal_program(const MicroSetting& setting) {
    const Format argument = setting.formats().accumulator;
    Assembler a("reciprocal", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const RegisterIndex x = a.reg("x", argument.bits(), argument.fraction_bits());
    const RegisterIndex r = a.reg("r", setting.numbers.word_bits + 1, setting.numbers.word_bits - 1);
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    const RegisterIndex zero = a.constant("0", 0, 2, setting.numbers.word_bits - 1);
    const OperatorWriter::Float inverse =
        operators.reciprocal("reciprocal", x, argument.bits(), argument.fraction_bits());
    a.move(exponent, inverse.exponent);
    a.jump_negative(x, "negative");
    a.move(r, inverse.mantissa);
    a.end();
    a.label("negative");
    a.subtract(r, zero, inverse.mantissa);
    a.end();
    return a.finish();
}

MicroProgram root_program(const MicroSetting& setting) {
    const Format argument = setting.formats().field;
    Assembler a("root", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const RegisterIndex x = a.reg("x", argument.bits(), argument.fraction_bits());
    const RegisterIndex r = a.reg("r", setting.numbers.word_bits + 1, setting.numbers.word_bits - 1);
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    const OperatorWriter::Float inverse = operators.root("root", x, argument.fraction_bits());
    a.move(exponent, inverse.exponent);
    a.move(r, inverse.mantissa);
    a.end();
    return a.finish();
}

MicroProgram normalise_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("normalise", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Vector v = vector(a, "", f.field);
    const Vector out = vector(a, "n", f.unit);
    operators.normalise("normalise", v, f.field.bits(), out);
    a.end();
    return a.finish();
}

MicroProgram normal_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("normal", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Vector base = vector(a, "b", f.normal);
    const Vector du = vector(a, "u", f.normal);
    const Vector dv = vector(a, "v", f.normal);
    const RegisterIndex u = a.reg("u", f.depth.bits() + 1, f.depth.fraction_bits());
    const RegisterIndex v = a.reg("v", f.depth.bits() + 1, f.depth.fraction_bits());
    const Vector field = vector(a, "field ", f.field);
    const Vector out = vector(a, "n", f.unit);
    for (std::size_t i = 0; i < 3; ++i) a.sum(field[i], base[i], {{u, du[i]}, {v, dv[i]}});
    operators.normalise("normalise", field, f.field.bits(), out);
    a.end();
    return a.finish();
}

MicroProgram reflect_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("reflect", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Vector direction = vector(a, "d", f.unit);
    const Vector normal = vector(a, "n", f.unit);
    const RegisterIndex along = a.reg("along", f.unit.bits(), f.unit.fraction_bits());
    // 2·along: the same word, whose last bit is worth twice as much.
    const RegisterIndex twice = a.reg("twice", f.unit.bits(), f.unit.fraction_bits() - 1);
    const Vector field = vector(a, "field ", f.field);
    const Vector out = vector(a, "r", f.unit);
    a.sum(along, Assembler::none,
          {{direction[0], normal[0]}, {direction[1], normal[1]}, {direction[2], normal[2]}});
    a.reinterpret(twice, along);
    for (std::size_t i = 0; i < 3; ++i) a.sum(field[i], direction[i], {{twice, normal[i], true}});
    operators.normalise("normalise", field, f.field.bits(), out);
    a.end();
    return a.finish();
}

MicroProgram combine_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("combine", setting.datapath, setting.numbers.rounding);
    const auto intensity = [&](const char* name) {
        return a.reg(name, f.intensity.bits(), f.intensity.fraction_bits());
    };
    const RegisterIndex local = intensity("local");
    const RegisterIndex mirror = a.reg("mirror", f.feature.bits(), f.feature.fraction_bits());
    const RegisterIndex transmit = a.reg("transmit", f.feature.bits(), f.feature.fraction_bits());
    const RegisterIndex reflected = intensity("reflected");
    const RegisterIndex refracted = intensity("refracted");
    const RegisterIndex out = intensity("sum");
    a.sum(out, local, {{reflected, mirror}, {refracted, transmit}});
    a.end();
    return a.finish();
}

}  // namespace raycell
