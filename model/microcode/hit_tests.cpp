// Programs of the rungs' own tests: a voxel's run, plane, mask, edges (tracing/intersect.cpp).
#include <algorithm>
#include <array>
#include <cmath>

#include "model/microcode/operators.hpp"

namespace raycell {
namespace {

std::int64_t raw(double value, const Format& format) { return std::int64_t(value / format.step()); }

/// The test with a voxel's plane, and what the rung `mask` adds to it.
class PlaneWriter {
  public:
    PlaneWriter(Assembler& assembler, const MicroSetting& setting, HitTest rung)
        : f_(setting.formats()), a_(assembler), operators_(assembler, setting), rung_(rung) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string axis(1, "xyz"[i]);
            n_[i] = reg("n" + axis, f_.unit);
            p_[i] = reg(axis, i == 2 ? f_.depth : f_.unit);
            d_[i] = reg("d" + axis, f_.unit);
            point_[i] = reg("p" + axis, i == 2 ? f_.depth : f_.unit);
        }
        near_ = reg("near", f_.depth);
        far_ = reg("far", f_.depth);
        end_ = reg("end", f_.distance);
        leaves_ = a_.reg("leaves", 2, 0);
        hit_ = a_.reg("hit", 2, 0);
        t_ = reg("t", f_.distance);
        along_ = reg("along", f_.accumulator);
        // The hair, 4 last bits of a unit word, grows with 1/along from 1 to 1024 times.
        room_ = a_.reg("room", f_.word_bits + 1 + most_growth, f_.unit.fraction_bits() + f_.word_bits - 3);
        no_ = a_.constant("no", 0, 2, 0);
        yes_ = a_.constant("yes", 1, 2, 0);
    }

    void write() {
        a_.move(hit_, no_);
        meet();
        limit();
        for (std::size_t i = 0; i < 3; ++i) a_.sum(point_[i], p_[i], {{t_, d_[i]}});
        a_.jump_sum_negative({{point_[2]}, {room_}, {near_, true}}, "misses");
        a_.jump_sum_negative({{far_}, {room_}, {point_[2], true}}, "misses");
        if (rung_ == HitTest::mask) mask();
        const RegisterIndex zero = a_.constant("0", 0, 2, f_.distance.fraction_bits());
        a_.most(t_, t_, zero);
        a_.move(hit_, yes_);
        a_.label("misses");
        a_.end();
    }

  private:
    static constexpr int most_growth = 10;  // bits
    RegisterIndex reg(const std::string& name, const Format& format, int more = 0) {
        return a_.reg(name, format.bits() + more, format.fraction_bits());
    }

    /// Where the ray meets the plane: t, along, room.
    void meet() {
        const int word = f_.word_bits;
        const int mantissa = word - 1;
        const RegisterIndex c = reg("c", f_.offset);
        const RegisterIndex base = reg("base", f_.depth);
        const RegisterIndex size = reg("size", f_.accumulator, 1);
        const RegisterIndex inside = reg("z in the run", f_.depth, 1);
        const RegisterIndex off = reg("off", f_.depth);
        const RegisterIndex growth = a_.reg("growth", word + 1, mantissa);
        const RegisterIndex exponent = a_.reg("exponent", 8, 0);
        const auto flat = std::int64_t(std::ceil(1e-12 / f_.accumulator.step()));
        const RegisterIndex in_plane =
            a_.constant("in the plane", flat, f_.accumulator.bits(), f_.accumulator.fraction_bits());
        const RegisterIndex one = a_.constant("1", std::int64_t(1) << mantissa, word + 1, mantissa);
        const RegisterIndex none = a_.constant("e 0", 0, 8, 0);
        const RegisterIndex all = a_.constant("e 10", most_growth, 8, 0);
        a_.sum_to_nearest(along_, Assembler::none, {{n_[0], d_[0]}, {n_[1], d_[1]}, {n_[2], d_[2]}});
        a_.absolute(size, along_);
        a_.jump_less(size, in_plane, "misses");
        a_.subtract(inside, p_[2], base);
        a_.sum(off, c, {{p_[0], n_[0], true}, {p_[1], n_[1], true}, {inside, n_[2], true}});
        const OperatorWriter::Float inverse =
            operators_.reciprocal("1/along", along_, f_.accumulator.bits(), f_.accumulator.fraction_bits());
        a_.jump_negative(along_, "from behind");
        a_.sum(t_, Assembler::none, {{off, inverse.mantissa}}, inverse.exponent);
        a_.jump("met");
        a_.label("from behind");
        a_.sum(t_, Assembler::none, {{off, inverse.mantissa, true}}, inverse.exponent);
        a_.label("met");
        a_.move(growth, inverse.mantissa);
        a_.move(exponent, inverse.exponent);
        a_.jump_less(none, exponent, "grows");
        a_.move(growth, one);
        a_.move(exponent, none);
        a_.label("grows");
        a_.jump_less(exponent, all, "grows little");
        a_.jump_less(all, exponent, "grows most");
        a_.jump("grows little");
        a_.label("grows most");
        a_.move(growth, one);
        a_.move(exponent, all);
        a_.label("grows little");
        a_.scale(room_, growth, exponent, 0);
    }

    /// Whether t is in the cell, and behind what the ray leaves.
    void limit() {
        const RegisterIndex fresh = a_.constant("least fresh", raw(64 * f_.unit.step(), f_.distance),
                                                f_.distance.bits(), f_.distance.fraction_bits());
        a_.jump_zero(leaves_, "stays");
        a_.jump_less(t_, fresh, "misses");
        if (rung_ != HitTest::edge) {  // overruns: the polygon's plane continues over its neighbours
            const RegisterIndex front = a_.reg("front", 2, 0);
            a_.jump_negative(along_, "sees the front");
            a_.jump_zero(front, "side");
            a_.jump("misses");
            a_.label("sees the front");
            a_.jump_zero(front, "misses");
        }
        a_.jump("side");
        a_.label("stays");
        a_.jump_sum_negative({{room_}, {t_}}, "misses");
        a_.label("side");
        a_.jump_sum_negative({{end_}, {room_}, {t_, true}}, "misses");
    }

    void mask();
    void window(const std::string& axis, RegisterIndex place, RegisterIndex room, RegisterIndex run_room,
                RegisterIndex bit);

    Formats f_;
    Assembler& a_;
    OperatorWriter operators_;
    HitTest rung_;
    std::array<RegisterIndex, 3> n_{}, p_{}, d_{}, point_{};
    RegisterIndex near_, far_, end_, leaves_, hit_, t_, along_, room_, no_, yes_, drop_x_, drop_z_;
};

/// Whether the mask's bit at the point is set. Places are in 32nds of the cell, or of the run.
void PlaneWriter::mask() {
    const Format& field = f_.field;
    const int in_32nds = field.fraction_bits() - 5;
    const RegisterIndex bits = a_.reg("mask", 64, 0);
    drop_x_ = a_.reg("drop x", 2, 0);
    drop_z_ = a_.reg("drop z", 2, 0);
    const RegisterIndex u = a_.reg("u", field.bits(), in_32nds);
    const RegisterIndex v = a_.reg("v", field.bits(), in_32nds);
    const RegisterIndex room =
        a_.reg("room in 32nds", f_.word_bits + 1 + most_growth, f_.unit.fraction_bits() + f_.word_bits - 8);
    const RegisterIndex run_room = a_.reg("room in 32nds of the run", field.bits(), in_32nds);
    const RegisterIndex column = a_.reg("column", 4, 0);
    const RegisterIndex row = a_.reg("row", 4, 0);
    const RegisterIndex number = a_.reg("number", 7, 0);
    const RegisterIndex set = a_.reg("set", 2, 0);
    const auto in_cell = [&](RegisterIndex target, std::size_t axis, const std::string& name) {
        const RegisterIndex scaled = a_.reg(name, f_.unit.bits(), f_.unit.fraction_bits() - 5);
        a_.reinterpret(scaled, point_[axis]);
        a_.round(target, scaled);
    };
    a_.reinterpret(room, room_);
    a_.jump_zero(drop_z_, "in the run");
    in_cell(u, 0, "32 x");
    in_cell(v, 1, "32 y");
    a_.jump("window");
    a_.label("in the run");
    const RegisterIndex length = reg("length", f_.depth, 1);
    const RegisterIndex above = reg("above", f_.depth, 1);
    const RegisterIndex share = reg("share", field);
    a_.subtract(length, far_, near_);
    a_.subtract(above, point_[2], near_);
    const OperatorWriter::Float per_run =
        operators_.reciprocal("1/run", length, f_.depth.bits() + 1, f_.depth.fraction_bits());
    a_.sum(share, Assembler::none, {{above, per_run.mantissa}}, per_run.exponent);
    a_.reinterpret(v, share);
    a_.sum(share, Assembler::none, {{room_, per_run.mantissa}}, per_run.exponent);
    a_.reinterpret(run_room, share);
    a_.jump_zero(drop_x_, "drop y");
    in_cell(u, 1, "32 y, x dropped");
    a_.jump("window");
    a_.label("drop y");
    in_cell(u, 0, "32 x, y dropped");
    a_.label("window");
    window("u", u, room, Assembler::none, column);
    window("v", v, room, run_room, row);
    a_.join(number, row, 3, column);
    a_.bit(set, bits, number);
    a_.jump_zero(set, "misses");
}

/// Where a place lies in one axis of the window: the column or row of the mask. `run_room`: the tolerance
/// where z is not dropped.
void PlaneWriter::window(const std::string& axis, RegisterIndex place, RegisterIndex room,
                         RegisterIndex run_room, RegisterIndex bit) {
    const Format& field = f_.field;
    const RegisterIndex low = a_.reg(axis + " from", 8, 0);
    const RegisterIndex high = a_.reg(axis + " to", 8, 0);
    const RegisterIndex size = a_.reg(axis + " size", 8, 0);
    const RegisterIndex way = a_.reg(axis + " way", field.bits() + 2, field.fraction_bits() - 5);
    const RegisterIndex share = reg(axis + " share", field);
    const RegisterIndex rounding = reg(axis + " rounding", field);
    const RegisterIndex eighths = a_.reg(axis + " eighths", field.integer_bits() + 3, 0);
    const RegisterIndex one = a_.constant(axis + " 1", std::int64_t(1) << field.fraction_bits(), field.bits(),
                                          field.fraction_bits());
    const RegisterIndex least = a_.constant(axis + " 0", 0, 4, 0);
    const RegisterIndex most = a_.constant(axis + " 7", 7, 4, 0);
    a_.subtract(size, high, low);
    const OperatorWriter::Float inverse = operators_.reciprocal("1/" + axis, size, 8, 0);
    a_.difference(way, place, low);
    a_.sum(share, Assembler::none, {{way, inverse.mantissa}}, inverse.exponent);
    if (run_room != Assembler::none) a_.jump_zero(drop_z_, axis + " in the run");
    a_.sum(rounding, Assembler::none, {{room, inverse.mantissa}}, inverse.exponent);
    if (run_room != Assembler::none) {
        a_.jump(axis + " tolerated");
        a_.label(axis + " in the run");
        a_.sum(rounding, Assembler::none, {{run_room, inverse.mantissa}}, inverse.exponent);
        a_.label(axis + " tolerated");
    }
    a_.jump_sum_negative({{share}, {rounding}}, "misses");
    a_.jump_sum_negative({{one}, {rounding}, {share, true}}, "misses");
    a_.high(eighths, share, field.fraction_bits() - 3);
    a_.most(eighths, eighths, least);
    a_.least(bit, eighths, most);
}

}  // namespace

MicroProgram plane_program(const MicroSetting& setting, HitTest rung) {
    const char* const name = rung == HitTest::edge ? "plane" : rung == HitTest::mask ? "mask" : "plane alone";
    Assembler a(name, setting.datapath, setting.numbers.rounding);
    PlaneWriter(a, setting, rung).write();
    return a.finish();
}

MicroProgram enter_program(const MicroSetting& setting, HitTest rung) {
    const Formats f = setting.formats();
    Assembler a(rung == HitTest::depth ? "depth" : "interval", setting.datapath, setting.numbers.rounding);
    OperatorWriter operators(a, setting);
    const auto reg = [&](const char* name, const Format& format, int more = 0) {
        return a.reg(name, format.bits() + more, format.fraction_bits());
    };
    const RegisterIndex z = reg("z", f.depth);
    const RegisterIndex z_end = reg("z1", f.depth);
    const RegisterIndex dz = reg("dz", f.unit);
    const RegisterIndex near = reg("near", f.depth);
    const RegisterIndex far = reg("far", f.depth);
    const RegisterIndex end = reg("end", f.distance);
    const RegisterIndex hit = a.reg("hit", 2, 0);
    const RegisterIndex t = reg("t", f.distance);
    const RegisterIndex least = reg("least", f.depth);
    const RegisterIndex most = reg("most", f.depth);
    const RegisterIndex way = reg("way", f.depth, 1);
    const RegisterIndex no = a.constant("no", 0, 2, 0);
    const RegisterIndex yes = a.constant("yes", 1, 2, 0);
    const RegisterIndex zero = a.constant("0", 0, 2, f.distance.fraction_bits());
    a.move(hit, no);
    a.move(t, zero);
    a.least(least, z, z_end);
    a.most(most, z, z_end);
    a.jump_less(most, near, "misses");
    if (rung == HitTest::depth) {
        a.jump_less(least, far, "meets");
        a.end();
        a.label("meets");
    } else {
        a.jump_less(far, least, "misses");
    }
    a.jump_less(z, near, "enters");
    a.jump_less(far, z, "enters");
    a.jump("hits");
    a.label("enters");
    const OperatorWriter::Float inverse =
        operators.reciprocal("1/dz", dz, f.unit.bits(), f.unit.fraction_bits());
    a.jump_negative(dz, "from behind");
    a.subtract(way, near, z);
    a.jump("way");
    a.label("from behind");
    a.subtract(way, z, far);
    a.label("way");
    a.sum(t, Assembler::none, {{way, inverse.mantissa}}, inverse.exponent);
    a.most(t, t, zero);
    a.least(t, t, end);
    a.label("hits");
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
    // Either may be a place in the cell or a depth.
    const int place = std::max(f.unit.fraction_bits(), f.depth.fraction_bits());
    const int place_bits = f.depth.bits() + 1 + place - f.depth.fraction_bits();
    const RegisterIndex u = a.reg("u", place_bits, place);
    const RegisterIndex v = a.reg("v", place_bits, place);
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
