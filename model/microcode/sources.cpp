// Programs of sources that are no points.
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

RegisterIndex reg(Assembler& a, const std::string& name, const Format& format) {
    return a.reg(name, format.bits(), format.fraction_bits());
}

constexpr int fraction_bits = 16;  // of a place in the pattern

/// A register for such a fraction, which has no sign.
RegisterIndex fraction(Assembler& a, const std::string& name) { return a.reg(name, fraction_bits + 1, 0); }

/// target = x + y, wrapped around.
void wrap(Assembler& a, RegisterIndex target, RegisterIndex x, RegisterIndex y) {
    const RegisterIndex sum = a.reg("sum", fraction_bits + 2, 0);
    a.add(sum, x, y);
    a.low(target, sum, fraction_bits);
}

/// The next place of the pattern, and the same shifted.
std::array<RegisterIndex, 2> next_place(Assembler& a) {
    std::array<RegisterIndex, 2> at{};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string axis(1, "uv"[i]);
        const RegisterIndex place = fraction(a, axis);
        wrap(a, place, place, fraction(a, "step " + axis));
        at[i] = fraction(a, "at " + axis);
        wrap(a, at[i], place, fraction(a, "shift " + axis));
    }
    return at;
}

/// The same number as a fraction.
RegisterIndex as_fraction(Assembler& a, const std::string& name, RegisterIndex x, int bits) {
    const RegisterIndex out = a.reg(name, bits + 1, bits);
    a.reinterpret(out, x);
    return out;
}

Format mantissa_of(const Formats& f) { return Format(1, f.word_bits + 11); }

RegisterIndex unit_constant(Assembler& a, const std::string& name, const Format& unit, double value) {
    return a.constant(name, std::int64_t(unit.hold(value) / unit.step()), unit.bits(), unit.fraction_bits());
}

void dot(Assembler& a, RegisterIndex target, const Vector& v, const Vector& w) {
    a.sum(target, Assembler::none, {{v[0], w[0]}, {v[1], w[1]}, {v[2], w[2]}});
}

}  // namespace

MicroProgram facing_program(const MicroSetting& setting) {
    const Format unit = setting.formats().unit;
    Assembler a("facing", setting.datapath, setting.numbers.rounding);
    const Vector axis = vector(a, "a", unit);
    const Vector normal = vector(a, "n", unit);
    dot(a, reg(a, "cosine", unit), normal, axis);
    a.end();
    return a.finish();
}

MicroProgram emission_program(const MicroSetting& setting) {
    const Format unit = setting.formats().unit;
    Assembler a("emission", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Format& power_word = operators.operators().exponent_word();
    const Vector axis = vector(a, "a", unit);
    const Vector direction = vector(a, "l", unit);
    const RegisterIndex cut_off = reg(a, "cut-off", unit);
    const RegisterIndex falloff = reg(a, "falloff", power_word);
    const RegisterIndex along = reg(a, "along", unit);
    const RegisterIndex emission = reg(a, "emission", unit);
    dot(a, along, axis, direction);
    a.move(emission, a.constant("0", 0, 2, unit.fraction_bits()));
    a.jump_less(cut_off, along, "inside");
    a.end();
    a.label("inside");
    a.move(emission, operators.power("power", along, falloff));
    a.end();
    return a.finish();
}

MicroProgram emitted_program(const MicroSetting& setting) {
    const Format unit = setting.formats().unit;
    Assembler a("emitted", setting.datapath, setting.numbers.rounding);
    const RegisterIndex emission = reg(a, "emission", unit);
    for (const char* name : {"cosine", "highlight"}) {
        const RegisterIndex share = reg(a, name, unit);
        a.sum(share, Assembler::none, {{share, emission}});
    }
    a.end();
    return a.finish();
}

MicroProgram shift_program(const MicroSetting& setting) {
    Assembler a("shift", setting.datapath, setting.numbers.rounding);
    const RegisterIndex polygon = a.reg("polygon", 21, 0);
    const RegisterIndex x = a.reg("x", 13, 0);
    const RegisterIndex y = a.reg("y", 13, 0);
    const RegisterIndex sum = a.reg("sum", 40, 0);
    constexpr std::int64_t factors[2][3] = {{56143, 48097, 40503}, {41203, 35297, 49471}};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string axis(1, "uv"[i]);
        std::array<RegisterIndex, 3> by{};
        for (std::size_t k = 0; k < 3; ++k)
            by[k] = a.constant(axis + std::to_string(k), factors[i][k], fraction_bits + 1, 0);
        a.sum(sum, Assembler::none, {{x, by[0]}, {y, by[1]}, {polygon, by[2]}});
        a.low(fraction(a, axis), sum, fraction_bits);
    }
    a.end();
    return a.finish();
}

MicroProgram sample_program(const MicroSetting& setting) {
    const Format mantissa = mantissa_of(setting.formats());
    Assembler a("sample", setting.datapath, setting.numbers.rounding);
    const Vector corner = vector(a, "c", mantissa);
    const Vector u = vector(a, "u ", mantissa);
    const Vector v = vector(a, "v ", mantissa);
    const Vector place = vector(a, "s", mantissa);
    const RegisterIndex fold = a.reg("fold", 2, 0);
    const RegisterIndex both = a.reg("both", fraction_bits + 2, 0);
    const RegisterIndex whole = a.constant("whole", 1 << fraction_bits, fraction_bits + 2, 0);
    const RegisterIndex last = a.constant("last", (1 << fraction_bits) - 1, fraction_bits + 1, 0);
    const std::array<RegisterIndex, 2> at = next_place(a);
    a.jump_zero(fold, "place");
    a.add(both, at[0], at[1]);
    a.jump_less(both, whole, "place");
    for (const RegisterIndex side : at) a.subtract(side, last, side);
    a.label("place");
    const RegisterIndex s = as_fraction(a, "s", at[0], fraction_bits);
    const RegisterIndex t = as_fraction(a, "t", at[1], fraction_bits);
    for (std::size_t i = 0; i < 3; ++i) a.sum_to_nearest(place[i], corner[i], {{s, u[i]}, {t, v[i]}});
    a.end();
    return a.finish();
}

MicroProgram disc_axes_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("disc axes", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Vector way = vector(a, "w", Format(5, f.word_bits + 11));
    const Vector l = vector(a, "l", f.unit);
    const Vector size = vector(a, "size ", f.unit);
    const Vector across = vector(a, "across ", f.unit);
    const Vector first = vector(a, "t", f.unit);
    const Vector second = vector(a, "b", f.unit);
    const RegisterIndex zero = a.constant("0", 0, 2, f.unit.fraction_bits());
    operators.normalise("to the middle", way, f.word_bits + 16, l);
    for (std::size_t i = 0; i < 3; ++i) a.absolute(size[i], l[i]);
    a.jump_less(size[1], size[0], "not x");
    a.jump_less(size[2], size[0], "least z");
    for (std::size_t least = 0; least < 3; ++least) {
        const std::size_t p = (least + 1) % 3, q = (least + 2) % 3;
        if (least == 1) {
            a.label("not x");
            a.jump_less(size[2], size[1], "least z");
        }
        if (least == 2) a.label("least z");
        a.move(across[least], zero);
        a.move(across[p], l[q]);
        a.subtract(across[q], zero, l[p]);
        if (least < 2) a.jump("across");
    }
    a.label("across");
    operators.normalise("first", across, f.unit.bits(), first);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        a.sum(second[i], Assembler::none, {{l[j], first[k]}, {l[k], first[j], true}});
    }
    a.end();
    return a.finish();
}

namespace {

/// sin(t · 90 degrees).
RegisterIndex quarter_sine(Assembler& a, const std::string& name, RegisterIndex t, const Format& unit) {
    const RegisterIndex squared = reg(a, name + " squared", unit);
    const RegisterIndex inner = reg(a, name + " inner", unit);
    const RegisterIndex sine = reg(a, name, unit);
    a.sum(squared, Assembler::none, {{t, t}});
    a.sum(inner, unit_constant(a, "third", unit, -0.6432292),
          {{squared, unit_constant(a, "fifth", unit, 0.0727102)}});
    a.sum(inner, unit_constant(a, "first", unit, 1.5706268), {{squared, inner}});
    a.sum(sine, Assembler::none, {{t, inner}});
    return sine;
}

}  // namespace

MicroProgram disc_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const Format& unit = f.unit;
    Assembler a("disc place", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Vector first = vector(a, "t", unit);
    const Vector second = vector(a, "b", unit);
    const Vector middle = vector(a, "c", mantissa_of(f));
    const Vector place = vector(a, "s", mantissa_of(f));
    const RegisterIndex radius = reg(a, "radius", mantissa_of(f));
    const RegisterIndex from_middle = reg(a, "from the middle", unit);
    const RegisterIndex squared = reg(a, "squared", unit);
    const RegisterIndex t = reg(a, "t", unit);
    const RegisterIndex rest = reg(a, "rest", unit);
    const RegisterIndex quarter = a.reg("quarter", 3, 0);
    const RegisterIndex within = a.reg("within", 15, 0);
    const RegisterIndex zero = a.constant("0", 0, 2, unit.fraction_bits());
    const RegisterIndex one = unit_constant(a, "1", unit, 1);
    const std::array<RegisterIndex, 2> at = next_place(a);
    a.round(squared, as_fraction(a, "u of 1", at[0], fraction_bits));
    a.move(from_middle, zero);
    a.jump_zero(squared, "turn");
    const OperatorWriter::Float root = operators.root("root", squared, unit.fraction_bits());
    a.sum(from_middle, Assembler::none, {{squared, root.mantissa}}, root.exponent);
    a.label("turn");
    a.high(quarter, at[1], fraction_bits - 2);
    a.low(within, at[1], fraction_bits - 2);
    a.round(t, as_fraction(a, "v of a quarter", within, fraction_bits - 2));
    a.subtract(rest, one, t);
    const RegisterIndex sine = quarter_sine(a, "sine", t, unit);
    const RegisterIndex cosine = quarter_sine(a, "cosine", rest, unit);
    const std::array<RegisterIndex, 2> way{reg(a, "way x", unit), reg(a, "way y", unit)};
    a.jump_zero(quarter, "quarter 0");
    a.jump_less(quarter, a.constant("two", 2, 3, 0), "quarter 1");
    a.jump_less(quarter, a.constant("three", 3, 3, 0), "quarter 2");
    a.move(way[0], sine);
    a.subtract(way[1], zero, cosine);
    a.jump("place");
    a.label("quarter 2");
    a.subtract(way[0], zero, cosine);
    a.subtract(way[1], zero, sine);
    a.jump("place");
    a.label("quarter 1");
    a.subtract(way[0], zero, sine);
    a.move(way[1], cosine);
    a.jump("place");
    a.label("quarter 0");
    a.move(way[0], cosine);
    a.move(way[1], sine);
    a.label("place");
    for (const RegisterIndex axis : way) a.sum(axis, Assembler::none, {{from_middle, axis}});
    const RegisterIndex direction = reg(a, "direction", unit);
    for (std::size_t i = 0; i < 3; ++i) {
        a.sum(direction, Assembler::none, {{way[0], first[i]}, {way[1], second[i]}});
        a.sum_to_nearest(place[i], middle[i], {{radius, direction}});
    }
    a.end();
    return a.finish();
}

MicroProgram lit_sample_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("lit sample", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const Format sum(8, f.unit.fraction_bits());
    const RegisterIndex cosine = reg(a, "cosine", f.unit);
    const RegisterIndex ks = reg(a, "ks", f.feature);
    const RegisterIndex shine = reg(a, "shine", operators.operators().exponent_word());
    const Vector direction = vector(a, "l", f.unit);
    const Vector mirrored = vector(a, "r", f.unit);
    const RegisterIndex along = reg(a, "along", f.unit);
    const RegisterIndex diffuse = reg(a, "diffuse", sum);
    const RegisterIndex highlight = reg(a, "highlight", sum);
    a.add(diffuse, diffuse, cosine);
    a.jump_zero(ks, "done");
    dot(a, along, mirrored, direction);
    a.jump_negative(along, "done");
    a.jump_zero(along, "done");
    a.add(highlight, highlight, operators.power("power", along, shine));
    a.label("done");
    a.end();
    return a.finish();
}

MicroProgram mean_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("mean", setting.datapath, setting.numbers.rounding);
    const Format sum(8, f.unit.fraction_bits());
    const RegisterIndex share = a.reg("share", f.word_bits, f.word_bits - 1);
    const RegisterIndex exponent = a.reg("share exponent", 7, 0);
    for (const char* name : {"diffuse", "highlight"})
        a.sum(reg(a, std::string("mean ") + name, f.unit), Assembler::none, {{reg(a, name, sum), share}},
              exponent);
    a.end();
    return a.finish();
}

}  // namespace raycell
