// Programs of the traversal unit: the walk, a voxel's depth run, an edge.
#include <algorithm>
#include <array>
#include <cmath>

#include "model/microcode/operators.hpp"

namespace raycell {
namespace {

std::int64_t raw(double value, const Format& format) { return std::int64_t(value / format.step()); }

class WalkWriter {
  public:
    WalkWriter(const MicroSetting& setting, double depth)
        : f_(setting.formats()), a_("walk", setting.datapath, setting.numbers.rounding) {
        const int word = f_.word_bits;
        const int unit = f_.unit.fraction_bits();
        const Format& distance = f_.distance;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::string name(1, "xy"[axis]);
            place_[axis] = a_.reg(name, word, unit);
            direction_[axis] = a_.reg("d" + name, word, unit);
            mantissa_[axis] = a_.reg("m" + name, word, word - 1);
            exponent_[axis] = a_.reg("e" + name, Formats::exponent_bits + 1, 0);
            crossing_[axis] = a_.reg("t" + name, distance.bits(), distance.fraction_bits());
        }
        z_ = a_.reg("z", f_.depth.bits(), f_.depth.fraction_bits());
        dz_ = a_.reg("dz", word, unit);
        reach_ = a_.reg("reach", word, f_.reach.fraction_bits());
        way_ = a_.reg("way", word, unit);
        side_ = a_.reg("side", 4, 0);
        t_ = a_.reg("t", distance.bits(), distance.fraction_bits());
        flags_ = a_.reg("flags", 4, 0);
        const int left_fraction = std::max(distance.fraction_bits(), f_.reach.fraction_bits());
        left_ = a_.reg("left", std::max(distance.integer_bits(), f_.reach.integer_bits()) + 1 + left_fraction,
                       left_fraction);
        zero_ = a_.constant("0", 0, word, unit);
        one_ = a_.constant("1", raw(1, f_.unit), word, unit);
        depth_ = a_.constant("depth", raw(depth, f_.depth), f_.depth.bits(), f_.depth.fraction_bits());
        infinite_ = a_.constant("infinite", raw(f_.reach.most(), f_.reach), word, f_.reach.fraction_bits());
        for (std::size_t i = 0; i < 4; ++i)
            number_[i] = a_.constant("number " + std::to_string(i), std::int64_t(i), 4, 0);
    }

    MicroProgram write() {
        a_.move(flags_, number_[0]);
        a_.jump_zero(mantissa_[0], "only y");
        cross(0, "x");
        a_.jump_zero(mantissa_[1], "take x");
        cross(1, "y");
        a_.jump_less(crossing_[1], crossing_[0], "take y");
        a_.label("take x");
        take(0, "take x");
        a_.jump("depth");
        a_.label("only y");
        a_.jump_zero(mantissa_[1], "axial");
        cross(1, "y alone");
        a_.label("take y");
        take(1, "take y");
        a_.label("depth");
        a_.sum(z_, z_, {{t_, dz_}});
        a_.jump_less(zero_, dz_, "to the back");
        a_.jump_negative(z_, "leaves");
        a_.jump("reach");
        a_.label("to the back");
        a_.jump_less(depth_, z_, "leaves");
        a_.jump("reach");
        a_.label("leaves");
        a_.move(flags_, number_[1]);
        a_.label("reach");
        a_.jump_less(reach_, infinite_, "finite");
        a_.end();
        a_.label("finite");
        a_.difference(left_, reach_, t_);
        a_.round(reach_, left_);
        a_.end();
        a_.label("axial");
        a_.move(flags_, number_[2]);
        a_.end();
        return a_.finish();
    }

  private:
    /// The distance to the side that the ray leaves over in one axis: its way there times 1/|d|.
    void cross(std::size_t axis, const std::string& label) {
        a_.jump_negative(direction_[axis], label + " back");
        a_.subtract(way_, one_, place_[axis]);
        a_.jump(label + " way");
        a_.label(label + " back");
        a_.move(way_, place_[axis]);
        a_.label(label + " way");
        a_.sum(crossing_[axis], Assembler::none, {{way_, mantissa_[axis]}}, exponent_[axis]);
    }

    /// The crossing is this axis's: the place on it, seen from the cell entered.
    void take(std::size_t axis, const std::string& label) {
        const std::size_t other = 1 - axis;
        a_.move(t_, crossing_[axis]);
        a_.sum(place_[other], place_[other], {{t_, direction_[other]}});
        a_.most(place_[other], place_[other], zero_);
        a_.least(place_[other], place_[other], one_);
        a_.jump_negative(direction_[axis], label + " back");
        a_.move(side_, number_[axis]);
        a_.move(place_[axis], zero_);
        a_.jump("depth");
        a_.label(label + " back");
        a_.move(side_, number_[2 + axis]);
        a_.move(place_[axis], one_);
    }

    Formats f_;
    Assembler a_;
    std::array<RegisterIndex, 2> place_, direction_, mantissa_, exponent_, crossing_;
    RegisterIndex z_, dz_, reach_, way_, side_, t_, flags_, left_, zero_, one_, depth_, infinite_;
    std::array<RegisterIndex, 4> number_;
};

}  // namespace

int widest_operand(const Formats& f) { return std::max(f.distance.bits(), f.depth.bits() + 1); }

MicroProgram walk_program(const MicroSetting& setting, double depth) {
    return WalkWriter(setting, depth).write();
}

MicroProgram run_program(const MicroSetting& setting) {
    const Format depth = setting.formats().depth;
    Assembler a("run", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const char* name) { return a.reg(name, depth.bits() + 1, depth.fraction_bits()); };
    const RegisterIndex near = reg("near");
    const RegisterIndex far = reg("far");
    const RegisterIndex low = reg("low");
    const RegisterIndex high = reg("high");
    const RegisterIndex meets = a.reg("meets", 2, 0);
    const RegisterIndex no = a.constant("0", 0, 2, 0);
    const RegisterIndex yes = a.constant("1", 1, 2, 0);
    a.jump_less(high, near, "misses");
    a.jump_less(far, low, "misses");
    a.move(meets, yes);
    a.end();
    a.label("misses");
    a.move(meets, no);
    a.end();
    return a.finish();
}

MicroProgram plane_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const int word = f.word_bits;
    const int unit = f.unit.fraction_bits();
    const int mantissa = word - 1;
    Assembler a("plane", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const auto reg = [&](const std::string& name, const Format& format, int more = 0) {
        return a.reg(name, format.bits() + more, format.fraction_bits());
    };
    std::array<RegisterIndex, 3> n{}, p{}, d{}, point{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        n[i] = reg("n" + axis, f.unit);
        p[i] = reg(axis, i == 2 ? f.depth : f.unit);
        d[i] = reg("d" + axis, f.unit);
        point[i] = reg("p" + axis, i == 2 ? f.depth : f.unit);
    }
    const RegisterIndex c = reg("c", f.offset);
    const RegisterIndex base = reg("base", f.depth);
    const RegisterIndex near = reg("near", f.depth);
    const RegisterIndex far = reg("far", f.depth);
    const RegisterIndex end = reg("end", f.distance);
    const RegisterIndex leaves = a.reg("leaves", 2, 0);
    const RegisterIndex hit = a.reg("hit", 2, 0);
    const RegisterIndex t = reg("t", f.distance);
    const RegisterIndex along = reg("along", f.accumulator);
    const RegisterIndex size = reg("size", f.accumulator, 1);
    const RegisterIndex inside = reg("z in the run", f.depth, 1);
    const RegisterIndex off = reg("off", f.depth);
    const RegisterIndex growth = a.reg("growth", word + 1, mantissa);
    const RegisterIndex exponent = a.reg("exponent", 8, 0);
    // The hair, 4 last bits of a unit word, grows with 1/along from 1 to 1024 times.
    constexpr int most_growth = 10;  // bits
    const RegisterIndex room = a.reg("room", word + 1 + most_growth, unit + mantissa - 2);
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    const RegisterIndex zero = a.constant("0", 0, 2, f.distance.fraction_bits());
    const auto flat = std::int64_t(std::ceil(1e-12 / f.accumulator.step()));
    const RegisterIndex in_plane =
        a.constant("in the plane", flat, f.accumulator.bits(), f.accumulator.fraction_bits());
    const RegisterIndex fresh = a.constant("least fresh", raw(64 * f.unit.step(), f.distance),
                                           f.distance.bits(), f.distance.fraction_bits());
    const RegisterIndex one = a.constant("1", std::int64_t(1) << mantissa, word + 1, mantissa);
    const RegisterIndex none = a.constant("e 0", 0, 8, 0);
    const RegisterIndex all = a.constant("e 10", most_growth, 8, 0);

    a.move(hit, no);
    a.sum_to_nearest(along, Assembler::none, {{n[0], d[0]}, {n[1], d[1]}, {n[2], d[2]}});
    a.absolute(size, along);
    a.jump_less(size, in_plane, "misses");
    a.subtract(inside, p[2], base);
    a.sum(off, c, {{p[0], n[0], true}, {p[1], n[1], true}, {inside, n[2], true}});
    const OperatorWriter::Float inverse =
        operators.reciprocal("1/along", along, f.accumulator.bits(), f.accumulator.fraction_bits());
    a.jump_negative(along, "from behind");
    a.sum(t, Assembler::none, {{off, inverse.mantissa}}, inverse.exponent);
    a.jump("met");
    a.label("from behind");
    a.sum(t, Assembler::none, {{off, inverse.mantissa, true}}, inverse.exponent);
    a.label("met");
    a.move(growth, inverse.mantissa);
    a.move(exponent, inverse.exponent);
    a.jump_less(none, exponent, "grows");
    a.move(growth, one);
    a.move(exponent, none);
    a.label("grows");
    a.jump_less(exponent, all, "grows little");
    a.jump_less(all, exponent, "grows most");
    a.jump("grows little");
    a.label("grows most");
    a.move(growth, one);
    a.move(exponent, all);
    a.label("grows little");
    a.scale(room, growth, exponent, 0);
    a.jump_zero(leaves, "stays");
    a.jump_less(t, fresh, "misses");
    a.jump("side");
    a.label("stays");
    a.jump_sum_negative({{room}, {t}}, "misses");
    a.label("side");
    a.jump_sum_negative({{end}, {room}, {t, true}}, "misses");
    for (std::size_t i = 0; i < 3; ++i) a.sum(point[i], p[i], {{t, d[i]}});
    a.jump_sum_negative({{point[2]}, {room}, {near, true}}, "misses");
    a.jump_sum_negative({{far}, {room}, {point[2], true}}, "misses");
    a.most(t, t, zero);
    a.move(hit, yes);
    a.label("misses");
    a.end();
    return a.finish();
}

MicroProgram edge_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    const int unit = f.unit.fraction_bits();
    Assembler a("edge", setting.datapath, setting.numbers.rounding);
    const RegisterIndex slope_u = a.reg("a", f.word_bits, unit);
    const RegisterIndex slope_v = a.reg("b", f.word_bits, unit);
    const RegisterIndex c = a.reg("c", f.edge_offset.bits(), f.edge_offset.fraction_bits());
    const RegisterIndex u = a.reg("u", f.depth.bits() + 1, f.depth.fraction_bits());
    const RegisterIndex v = a.reg("v", f.depth.bits() + 1, f.depth.fraction_bits());
    const RegisterIndex inside = a.reg("inside", 2, 0);
    const RegisterIndex no = a.constant("0", 0, 2, 0);
    const RegisterIndex yes = a.constant("1", 1, 2, 0);
    // The hair is 4 last bits of a unit word; it is outside the value's format in no word length.
    const RegisterIndex outside = a.constant("-hair", raw(-4 * f.unit.step(), f.edge_offset),
                                             f.edge_offset.bits(), f.edge_offset.fraction_bits());
    a.sum(c, c, {{u, slope_u}, {v, slope_v}});
    a.jump_less(c, outside, "outside");
    a.move(inside, yes);
    a.end();
    a.label("outside");
    a.move(inside, no);
    a.end();
    return a.finish();
}

}  // namespace raycell
