// Programs of rays: a source as a hit sees it, the start of a ray, an answer's way home.
#include "model/microcode/operators.hpp"

namespace raycell {
namespace {

using Vector = OperatorWriter::Vector;

Vector vector(Assembler& a, const std::string& before, const Format& format) {
    Vector v{};
    for (std::size_t i = 0; i < 3; ++i)
        v[i] = a.reg(before + "xyz"[i], format.bits(), format.fraction_bits());
    return v;
}

/// A point, whose depth has a format of its own.
Vector place(Assembler& a, const std::string& before, const Formats& f) {
    return {a.reg(before + "x", f.unit.bits(), f.unit.fraction_bits()),
            a.reg(before + "y", f.unit.bits(), f.unit.fraction_bits()),
            a.reg(before + "z", f.depth.bits(), f.depth.fraction_bits())};
}

constexpr int place_bits = 13;  // 0 to 4095, and a sign

}  // namespace

MicroProgram source_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("source", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Format& from_format = f.from;
    const Vector source = vector(a, "s", Format(1, f.word_bits + 11));
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    const Vector point = place(a, "p", f);
    const std::array<RegisterIndex, 2> cell{a.reg("cell x", place_bits, 0), a.reg("cell y", place_bits, 0)};
    const Vector normal = vector(a, "n", f.unit);
    const Vector direction = vector(a, "l", f.unit);
    const RegisterIndex cosine = a.reg("cosine", f.unit.bits(), f.unit.fraction_bits());
    const RegisterIndex reach = a.reg("reach", f.reach.bits(), f.reach.fraction_bits());
    const RegisterIndex minus = a.reg("minus", 8, 0);
    const RegisterIndex length = a.reg("length", 8, 0);
    const Vector from = vector(a, "from ", from_format);
    const Vector way = vector(a, "way ", Format(5, f.word_bits + 11));
    const RegisterIndex none = a.constant("0", 0, 2, 0);
    const RegisterIndex scale = a.constant("scale", f.word_bits + 10, 8, 0);
    a.subtract(minus, none, exponent);
    for (std::size_t i = 0; i < 2; ++i) a.scale_sum(from[i], cell[i], point[i], minus);
    a.scale(from[2], point[2], minus, f.depth.fraction_bits() - from_format.fraction_bits());
    for (std::size_t i = 0; i < 3; ++i) a.subtract(way[i], source[i], from[i]);
    const auto n = operators.normalise("normalise", way, f.word_bits + 16, direction, "on the surface");
    // |v| = squared/sqrt(squared), times the power of two that the largest component was brought to 1 with.
    a.subtract(length, exponent, n.count);
    a.subtract(length, length, scale);
    a.add(length, length, n.inverse.exponent);
    a.sum(reach, Assembler::none, {{n.squared, n.inverse.mantissa}}, length);
    a.sum(cosine, Assembler::none,
          {{normal[0], direction[0]}, {normal[1], direction[1]}, {normal[2], direction[2]}});
    a.end();
    a.label("on the surface");
    const RegisterIndex zero = a.constant("no way", 0, 2, f.unit.fraction_bits());
    const RegisterIndex no_reach = a.constant("no reach", 0, 2, f.reach.fraction_bits());
    const RegisterIndex one =
        a.constant("1", std::int64_t(1) << f.unit.fraction_bits(), f.unit.bits(), f.unit.fraction_bits());
    a.move(direction[0], zero);
    a.move(direction[1], zero);
    a.move(direction[2], one);
    a.move(cosine, zero);
    a.move(reach, no_reach);
    a.end();
    return a.finish();
}

MicroProgram start_program(const MicroSetting& setting, double normal_offset) {
    const Formats f = setting.formats();
    const int word = f.word_bits;
    Assembler a("start", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const auto unit = [&](const std::string& name) {
        return a.reg(name, f.unit.bits(), f.unit.fraction_bits());
    };
    const Vector direction = vector(a, "d", f.unit);
    const Vector point = place(a, "p", f);
    const Vector normal = vector(a, "n", f.unit);
    const Vector out = place(a, "", f);
    const RegisterIndex weight = unit("weight");
    const RegisterIndex share = a.reg("share", f.feature.bits(), f.feature.fraction_bits());
    const RegisterIndex front = a.reg("front", 2, 0);
    const RegisterIndex along = a.reg("along", f.accumulator.bits(), f.accumulator.fraction_bits());
    const RegisterIndex offset = unit("offset");
    const auto in_words = std::int64_t(normal_offset / f.unit.step());
    const RegisterIndex forth = a.constant("forth", in_words, word, f.unit.fraction_bits());
    const RegisterIndex back = a.constant("back", -in_words, word, f.unit.fraction_bits());
    const RegisterIndex zero = a.constant("0", 0, word, f.unit.fraction_bits());
    const RegisterIndex one =
        a.constant("1", std::int64_t(1) << f.unit.fraction_bits(), word, f.unit.fraction_bits());
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    a.sum_to_nearest(along, Assembler::none,
                     {{normal[0], direction[0]}, {normal[1], direction[1]}, {normal[2], direction[2]}});
    a.move(offset, forth);
    a.move(front, yes);
    a.jump_negative(along, "to the back");
    a.jump("off");
    a.label("to the back");
    a.move(offset, back);
    a.move(front, no);
    a.label("off");
    for (std::size_t i = 0; i < 3; ++i) {
        a.sum(out[i], point[i], {{offset, normal[i]}});
        if (i == 2) break;
        a.most(out[i], out[i], zero);
        a.least(out[i], out[i], one);
    }
    a.sum(weight, Assembler::none, {{weight, share}});
    // The reciprocals that the ray carries: mantissas below 1.
    const RegisterIndex whole = a.constant("whole", std::int64_t(1) << (word - 1), word + 1, word - 1);
    const RegisterIndex half = a.constant("half", std::int64_t(1) << (word - 2), word, word - 1);
    const RegisterIndex none = a.constant("none", 0, 2, word - 1);
    const RegisterIndex more = a.constant("more", 1, 2, 0);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string axis(1, "xy"[i]);
        const RegisterIndex mantissa = a.reg("m" + axis, word, word - 1);
        const RegisterIndex exponent = a.reg("e" + axis, Formats::exponent_bits + 1, 0);
        a.move(exponent, no);
        a.move(mantissa, none);
        a.jump_zero(direction[i], axis + " none");
        const OperatorWriter::Float inverse =
            operators.reciprocal("1/d" + axis, direction[i], f.unit.bits(), f.unit.fraction_bits());
        a.move(exponent, inverse.exponent);
        a.jump_less(inverse.mantissa, whole, axis + " fits");
        a.move(mantissa, half);
        a.add(exponent, exponent, more);
        a.jump(axis + " none");
        a.label(axis + " fits");
        a.move(mantissa, inverse.mantissa);
        a.label(axis + " none");
    }
    a.end();
    return a.finish();
}

MicroProgram route_program(const MicroSetting& setting) {
    Assembler a("route", setting.datapath, setting.numbers.rounding);
    const RegisterIndex x = a.reg("x", place_bits, 0);
    const RegisterIndex y = a.reg("y", place_bits, 0);
    const RegisterIndex home_x = a.reg("home x", place_bits, 0);
    const RegisterIndex home_y = a.reg("home y", place_bits, 0);
    const RegisterIndex way = a.reg("way", 4, 0);
    constexpr const char* names[] = {"east", "south", "west", "north", "home"};
    a.jump_less(x, home_x, "east");
    a.jump_less(home_x, x, "west");
    a.jump_less(y, home_y, "south");
    a.jump_less(home_y, y, "north");
    for (const int side : {4, 0, 1, 2, 3}) {
        a.label(names[side]);
        a.move(way, a.constant(names[side], side, 4, 0));
        a.end();
    }
    return a.finish();
}

}  // namespace raycell
