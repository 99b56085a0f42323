// Programs of the shading unit.
#include <algorithm>
#include <cmath>
#include <stdexcept>

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
    const Vector base = vector(a, "b", f.normal);
    const Vector du = vector(a, "u", f.normal);
    const Vector dv = vector(a, "v", f.normal);
    // Either may be a place in the cell or a depth.
    const int place = std::max(f.unit.fraction_bits(), f.depth.fraction_bits());
    const int place_bits = f.depth.bits() + 1 + place - f.depth.fraction_bits();
    const RegisterIndex u = a.reg("u", place_bits, place);
    const RegisterIndex v = a.reg("v", place_bits, place);
    const Vector field = vector(a, "f", f.field);
    for (std::size_t i = 0; i < 3; ++i) a.sum(field[i], base[i], {{u, du[i]}, {v, dv[i]}});
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

MicroProgram refract_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const Format& field = f.field;
    const int mantissa = f.word_bits - 1;
    Assembler a("refract", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const auto reg = [&](const char* name, const Format& format) {
        return a.reg(name, format.bits(), format.fraction_bits());
    };
    const Vector direction = vector(a, "d", f.unit);
    const Vector normal = vector(a, "n", f.unit);
    const RegisterIndex ior = reg("ior", f.ior);
    const RegisterIndex entering = a.reg("entering", 2, 0);
    const RegisterIndex total = a.reg("total", 2, 0);
    const RegisterIndex eta = reg("eta", f.normal);
    const RegisterIndex cosine = reg("cosine", f.unit);
    const RegisterIndex sine = reg("squared sine", field);
    const RegisterIndex eta_squared = reg("eta squared", field);
    const RegisterIndex squared = a.reg("squared", field.bits() + 1, field.fraction_bits());
    const RegisterIndex held = reg("held", f.unit);
    const RegisterIndex root = reg("sqrt", f.unit);
    const RegisterIndex across = reg("across", field);
    const Vector way = vector(a, "way ", field);
    const Vector out = vector(a, "r", f.unit);
    const RegisterIndex zero = a.constant("0", 0, 2, f.unit.fraction_bits());
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    const RegisterIndex one =
        a.constant("1", std::int64_t(1) << field.fraction_bits(), field.bits(), field.fraction_bits());

    a.move(total, no);
    a.jump_zero(entering, "leaving");
    const OperatorWriter::Float inverse =
        operators.reciprocal("eta", ior, f.ior.bits(), f.ior.fraction_bits());
    a.scale(eta, inverse.mantissa, inverse.exponent, mantissa - f.normal.fraction_bits());
    a.jump("bend");
    a.label("leaving");
    a.round(eta, ior);
    a.label("bend");
    a.sum(cosine, Assembler::none,
          {{direction[0], normal[0]}, {direction[1], normal[1]}, {direction[2], normal[2]}});
    a.subtract(cosine, zero, cosine);
    a.sum(sine, one, {{cosine, cosine, true}});
    a.sum(eta_squared, Assembler::none, {{eta, eta}});
    a.sum(sine, Assembler::none, {{eta_squared, sine}});
    a.subtract(squared, one, sine);
    a.jump_negative(squared, "reflected");
    a.jump_zero(squared, "grazes");
    a.round(held, squared);
    const OperatorWriter::Float inverse_root = operators.root("root", squared, field.fraction_bits());
    a.sum(root, Assembler::none, {{held, inverse_root.mantissa}}, inverse_root.exponent);
    a.subtract(root, zero, root);
    a.label("bent");
    a.sum(across, root, {{eta, cosine}});
    for (std::size_t i = 0; i < 3; ++i) {
        a.sum(way[i], Assembler::none, {{eta, direction[i]}});
        a.sum(way[i], way[i], {{across, normal[i]}});
    }
    a.jump("unit");
    a.label("reflected");
    a.move(total, yes);
    // 2·cosine: the same word, whose last bit is worth twice as much.
    const RegisterIndex twice = a.reg("twice", f.unit.bits(), f.unit.fraction_bits() - 1);
    a.reinterpret(twice, cosine);
    for (std::size_t i = 0; i < 3; ++i) a.sum(way[i], direction[i], {{twice, normal[i]}});
    a.label("unit");
    operators.normalise("normalise", way, field.bits(), out, "reflected");
    a.end();
    a.label("grazes");
    a.move(root, zero);
    a.jump("bent");
    return a.finish();
}

MicroProgram setup_program(const MicroSetting& setting, const ChildLimits& limits) {
    const Formats f = setting.formats();
    Assembler a("setup", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const auto reg = [&](const std::string& name, const Format& format) {
        return a.reg(name, format.bits(), format.fraction_bits());
    };
    const RegisterIndex t = reg("t", f.distance);
    const Vector place{reg("x", f.unit), reg("y", f.unit), reg("z", f.depth)};
    const Vector point{reg("px", f.unit), reg("py", f.unit), reg("pz", f.depth)};
    const Vector direction = vector(a, "d", f.unit);
    const Vector field = vector(a, "f", f.field);
    const Vector plane = vector(a, "g", f.unit);
    const Vector normal = vector(a, "n", f.unit);
    const RegisterIndex entering = a.reg("entering", 2, 0);
    const RegisterIndex squared = reg("squared", f.accumulator);
    const RegisterIndex along = reg("along", f.accumulator);
    const double step = f.normal.step();
    const RegisterIndex least = a.constant("least", std::int64_t(64 * step * step / f.accumulator.step()),
                                           f.accumulator.bits(), f.accumulator.fraction_bits());
    const RegisterIndex zero = a.constant("0", 0, 2, f.unit.fraction_bits());
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    for (std::size_t i = 0; i < 3; ++i) a.sum(point[i], place[i], {{t, direction[i]}});
    a.sum_to_nearest(squared, Assembler::none,
                     {{field[0], field[0]}, {field[1], field[1]}, {field[2], field[2]}});
    a.jump_less(least, squared, "has a direction");
    for (std::size_t i = 0; i < 3; ++i) a.round(field[i], plane[i]);
    a.label("has a direction");
    operators.normalise("normalise", field, f.field.bits(), normal);
    a.sum_to_nearest(along, Assembler::none,
                     {{normal[0], direction[0]}, {normal[1], direction[1]}, {normal[2], direction[2]}});
    a.move(entering, yes);
    a.jump_negative(along, "turned");
    a.move(entering, no);
    for (std::size_t i = 0; i < 3; ++i) a.subtract(normal[i], zero, normal[i]);
    a.label("turned");
    // Which children are worth sending.
    const RegisterIndex weight = reg("weight", f.unit);
    const RegisterIndex generation = a.reg("generation", 7, 0);
    const RegisterIndex last = a.constant("last", limits.max_depth, 7, 0);
    const int fraction = f.unit.fraction_bits() + f.feature.fraction_bits();
    const auto weighs = std::int64_t(std::ceil(limits.min_weight * std::exp2(fraction)));
    const RegisterIndex too_little = a.constant("too little", -weighs, fraction + 3, fraction);
    const std::array<RegisterIndex, 2> share{reg("mirror", f.feature), reg("transmit", f.feature)};
    const std::array<RegisterIndex, 2> sends{a.reg("reflects", 2, 0), a.reg("refracts", 2, 0)};
    for (const RegisterIndex send : sends) a.move(send, no);
    a.jump_less(generation, last, "has children");
    a.end();
    a.label("has children");
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string next = i == 0 ? "transmits" : "done";
        a.jump_zero(share[i], next);
        a.jump_product_negative(too_little, weight, share[i], next);
        a.move(sends[i], yes);
        a.label(next);
    }
    a.end();
    return a.finish();
}

MicroProgram light_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("light", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const char* name, const Format& format) {
        return a.reg(name, format.bits(), format.fraction_bits());
    };
    OperatorWriter operators(a, setting);
    const Format& shine_word = operators.operators().exponent_word();
    const RegisterIndex cosine = reg("cosine", f.unit);
    const RegisterIndex kd = reg("kd", f.feature);
    const RegisterIndex ks = reg("ks", f.feature);
    const RegisterIndex shine = reg("shine", shine_word);
    const Vector mirrored = vector(a, "r", f.unit);
    const Vector direction = vector(a, "l", f.unit);
    const Vector colour = vector(a, "c", f.feature);
    const Vector intensity = vector(a, "i", f.intensity);
    const Vector sum = vector(a, "s", f.intensity);
    const RegisterIndex along = reg("along", f.unit);
    const RegisterIndex highlight = reg("highlight", f.intensity);
    const RegisterIndex diffuse = reg("diffuse", f.unit);
    const RegisterIndex share = reg("share", f.intensity);
    const RegisterIndex none = a.constant("0", 0, 2, f.intensity.fraction_bits());
    a.move(highlight, none);
    a.jump_zero(ks, "diffuse");
    a.sum(along, Assembler::none,
          {{mirrored[0], direction[0]}, {mirrored[1], direction[1]}, {mirrored[2], direction[2]}});
    a.jump_negative(along, "diffuse");
    a.jump_zero(along, "diffuse");
    const RegisterIndex power = operators.power("power", along, shine);
    a.sum(highlight, Assembler::none, {{ks, power}});
    a.label("diffuse");
    a.sum(diffuse, Assembler::none, {{kd, cosine}});
    for (std::size_t i = 0; i < 3; ++i) {
        a.sum(share, highlight, {{diffuse, colour[i]}});
        a.sum(sum[i], sum[i], {{intensity[i], share}});
    }
    a.end();
    return a.finish();
}

MicroProgram power_program(const MicroSetting& setting) {
    const Format unit = setting.formats().unit;
    Assembler a("power", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Format& shine_word = operators.operators().exponent_word();
    const RegisterIndex base = a.reg("base", unit.bits(), unit.fraction_bits());
    const RegisterIndex shine = a.reg("shine", shine_word.bits(), shine_word.fraction_bits());
    if (setting.numbers.operators.power == PowerMethod::rounded)
        throw std::invalid_argument("power, correctly rounded, has no microprogram");
    operators.power("power", base, shine);
    a.end();
    return a.finish();
}

MicroProgram ambient_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("ambient", setting.datapath, setting.numbers.rounding);
    const RegisterIndex kd = a.reg("kd", f.feature.bits(), f.feature.fraction_bits());
    const Vector colour = vector(a, "c", f.feature);
    const Vector sum = vector(a, "s", f.intensity);
    const RegisterIndex tenth = a.constant("0.1", std::int64_t(f.unit.hold(0.1) / f.unit.step()),
                                           f.unit.bits(), f.unit.fraction_bits());
    const RegisterIndex ambient = a.reg("ambient", f.unit.bits(), f.unit.fraction_bits());
    a.sum(ambient, Assembler::none, {{tenth, kd}});
    for (std::size_t i = 0; i < 3; ++i) a.sum(sum[i], Assembler::none, {{ambient, colour[i]}});
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
