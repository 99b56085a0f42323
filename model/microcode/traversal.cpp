// Programs of the traversal unit: the walk, the comparison with a voxel's depth run.
#include <algorithm>
#include <array>
#include <cmath>

#include "model/microcode/operators.hpp"

namespace raycell {
namespace {

std::int64_t raw(double value, const Format& format) { return std::int64_t(value / format.step()); }

class WalkWriter {
  public:
    WalkWriter(const std::string& program, const MicroSetting& setting, double depth)
        : f_(setting.formats()), a_(program, setting.datapath, setting.numbers.rounding) {
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
        shorten();
        a_.label("axial");
        a_.move(flags_, number_[2]);
        a_.end();
        return a_.finish();
    }

    MicroProgram write_leave(OperatorWriter& operators) {
        const RegisterIndex rest = a_.reg("rest", f_.depth.bits() + 1, f_.depth.fraction_bits());
        const RegisterIndex axial = a_.reg("axial", 2, 0);
        const RegisterIndex out = a_.reg("way out", f_.distance.bits(), f_.distance.fraction_bits());
        const RegisterIndex here = a_.constant("no way", 0, 2, f_.distance.fraction_bits());
        a_.move(rest, z_);
        a_.jump_negative(dz_, "way");
        a_.subtract(rest, depth_, z_);
        a_.label("way");
        const OperatorWriter::Float inverse =
            operators.reciprocal("1/dz", dz_, f_.word_bits, f_.unit.fraction_bits());
        a_.sum(out, Assembler::none, {{rest, inverse.mantissa}}, inverse.exponent);
        a_.most(out, out, here);
        a_.jump_less(number_[0], axial, "out");
        a_.least(out, out, t_);
        a_.label("out");
        a_.move(t_, out);
        for (const std::size_t axis : {0, 1}) {
            a_.sum(place_[axis], place_[axis], {{t_, direction_[axis]}});
            a_.most(place_[axis], place_[axis], zero_);
            a_.least(place_[axis], place_[axis], one_);
        }
        a_.sum(z_, z_, {{t_, dz_}});
        shorten();
        return a_.finish();
    }

    Assembler& assembler() { return a_; }

  private:
    /// What is left of the way to a source, if there is one; the end.
    void shorten() {
        a_.jump_less(reach_, infinite_, "finite");
        a_.end();
        a_.label("finite");
        a_.difference(left_, reach_, t_);
        a_.round(reach_, left_);
        a_.end();
    }

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
    return WalkWriter("walk", setting, depth).write();
}

MicroProgram leave_program(const MicroSetting& setting, double depth) {
    WalkWriter writer("leave", setting, depth);
    OperatorWriter operators(writer.assembler(), setting);
    return writer.write_leave(operators);
}

MicroProgram run_program(const MicroSetting& setting, bool outwards) {
    const Format depth = setting.formats().depth;
    Assembler a(outwards ? "run outwards" : "run", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const char* name) { return a.reg(name, depth.bits() + 1, depth.fraction_bits()); };
    const RegisterIndex near = reg("near");
    const RegisterIndex far = reg("far");
    const RegisterIndex low = reg("low");
    const RegisterIndex high = reg("high");
    const RegisterIndex most = outwards ? reg("most") : Assembler::none;
    const RegisterIndex meets = a.reg("meets", 3, 0);
    const RegisterIndex no = a.constant("0", 0, 2, 0);
    const RegisterIndex yes = a.constant("1", 1, 2, 0);
    const RegisterIndex none = a.constant("2", 2, 3, 0);
    a.jump_less(high, near, outwards ? "misses" : "none");
    a.jump_less(far, low, outwards ? "others" : "misses");
    a.move(meets, yes);
    a.end();
    if (outwards) {
        a.label("others");
        a.jump_less(most, low, "none");
    }
    a.label("misses");
    a.move(meets, no);
    a.end();
    a.label("none");
    a.move(meets, none);
    a.end();
    return a.finish();
}

MicroProgram order_program(const MicroSetting& setting) {
    const Format depth = setting.formats().depth;
    Assembler a("order", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const char* name) { return a.reg(name, depth.bits() + 1, depth.fraction_bits()); };
    const RegisterIndex near = reg("near");
    const RegisterIndex far = reg("far");
    const RegisterIndex line_near = reg("line near");
    const RegisterIndex most = reg("most");
    const RegisterIndex before = a.reg("before", 2, 0);
    const RegisterIndex no = a.constant("0", 0, 2, 0);
    const RegisterIndex yes = a.constant("1", 1, 2, 0);
    a.jump_less(near, line_near, "before");
    a.move(before, no);
    a.end();
    a.label("before");
    a.most(most, most, far);
    a.move(before, yes);
    a.end();
    return a.finish();
}

}  // namespace raycell
