// Loading: the depth run of a voxel, the edges that cross it, its point, plane and normals.
#include <algorithm>
#include <cmath>

#include "model/microcode/loading.hpp"
#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {

void LoadingWriter::take_run() {
    near_level_ = number_of("near level", 20);
    far_level_ = number_of("far level", 20);
    near_ = a_.reg("near", formats_.depth.bits() + 1, formats_.depth.fraction_bits());
    far_ = a_.reg("far", formats_.depth.bits() + 1, formats_.depth.fraction_bits());
}

/// The level of a depth: floor(depth / level), from the first to the last one.
void LoadingWriter::level_of(const std::string& name, RegisterIndex depth, RegisterIndex level) {
    a_.move(level, zero_);
    a_.jump_negative(depth, name + " known");
    a_.move(level, last_level_);
    a_.jump_less(depth, cube_end_, name + " inside");
    a_.jump(name + " known");
    a_.label(name + " inside");
    a_.divide(name, level, depth, level_step_, bits_for(levels_.count), one_);
    a_.label(name + " known");
}

void LoadingWriter::run(bool with_room) {
    const int level_fraction = field::level_mantissa - 1 - exponent_of(levels_.level);
    const int unit = formats_.unit.fraction_bits();
    const int fraction = std::max({f_, unit, level_fraction});
    const int bits = loading_ + 4 + fraction - f_;
    const auto depth_constant = [&](const std::string& name, double value) {
        return a_.constant(name, std::int64_t(scale_by(value, fraction)), bits, fraction);
    };
    cube_end_ = depth_constant("cube's end", levels_.level * levels_.count);
    level_step_ = depth_constant("levels' step", scale_by(levels_.level, bits_for(levels_.count)));
    last_level_ = a_.constant("last level", levels_.count - 1, 20, 0);
    const RegisterIndex low = a_.reg("run from", bits, fraction);
    const RegisterIndex high = a_.reg("run to", bits, fraction);
    convert(low, z_low_);
    convert(high, z_high_);
    if (with_room) {
        const RegisterIndex hair = depth_constant("hair", 4 * formats_.unit.step());
        const RegisterIndex slack = a_.reg("room", bits, fraction);
        a_.subtract(low, low, hair);
        a_.add(high, high, hair);
        a_.jump_zero(drop_z_, "no slack");
        convert(slack, slack_);
        a_.subtract(low, low, slack);
        a_.add(high, high, slack);
        a_.label("no slack");
    }
    level_of("near of", low, near_level_);
    level_of("far of", high, far_level_);
    a_.add(far_level_, far_level_, one_);
    ends();
}

/// The run's ends from its levels. Levels may be finer than a depth's last bit, but a run is never empty.
void LoadingWriter::ends() {
    const int fraction = field::level_mantissa - 1 - exponent_of(levels_.level);
    const RegisterIndex level = a_.constant("level", std::int64_t(scale_by(levels_.level, fraction)),
                                            field::level_mantissa + 1, fraction);
    const RegisterIndex step = a_.constant("a bit", 1, 2, formats_.depth.fraction_bits());
    const RegisterIndex least = a_.reg("least far", far_bits(), formats_.depth.fraction_bits());
    a_.sum(near_, Assembler::none, {{level, near_level_}});
    a_.sum(far_, Assembler::none, {{level, far_level_}});
    a_.add(least, near_, step);
    a_.most(far_, far_, least);
}

int LoadingWriter::far_bits() const { return formats_.depth.bits() + 1; }

/// target = a, nothing lost.
void LoadingWriter::convert(RegisterIndex target, RegisterIndex a) {
    if (a_.fraction(target) == a_.fraction(a)) {
        a_.move(target, a);
    } else {
        a_.round(target, a);
    }
}

void LoadingWriter::take_edges() {
    crossings_ = number("crossings");
    held_a_ = a_.reg("held a", formats_.word_bits, formats_.unit.fraction_bits());
    held_b_ = a_.reg("held b", formats_.word_bits, formats_.unit.fraction_bits());
    held_c_ = a_.reg("held c", formats_.depth.bits(), formats_.depth.fraction_bits());
}

/// Only the corner where an edge is largest tells whether it reaches the run's rectangle, only the one where
/// it is least whether it crosses it.
void LoadingWriter::cross(HitTest rung) {
    const bool held = rung == HitTest::edge;
    const RegisterIndex index = number("crossing");
    const Corner most = corner("most");
    const Corner least = corner("least");
    const RegisterIndex at = length("crossing at", 2);
    from_v_ = a_.reg("from v", v_bits_, f_);
    to_v_ = a_.reg("to v", v_bits_, f_);
    const std::int64_t hair = std::int64_t(std::floor(scale_by(4 * formats_.unit.step(), f_)));
    minus_hair_ = a_.constant("minus hair", -hair, 24, f_);
    std::array<RegisterIndex, 3> kept{};
    if (held) {
        kept = {a_.array("kept a", 4, formats_.word_bits, formats_.unit.fraction_bits()),
                a_.array("kept b", 4, formats_.word_bits, formats_.unit.fraction_bits()),
                a_.array("kept c", 4, formats_.depth.bits(), formats_.depth.fraction_bits())};
    }
    if (rung == HitTest::mask) crossing_edges_ = a_.array("crossing edge", 4, 6, 0);
    a_.move(from_v_, no_length_);
    a_.move(to_v_, one_length_);
    a_.jump_less(zero_, drop_z_, "rectangle");
    a_.round_down(from_v_, near_);
    a_.round_down(to_v_, far_);
    a_.label("rectangle");
    a_.move(index, zero_);
    a_.move(crossings_, zero_);
    a_.jump("edges left");
    a_.label("next edge");
    fetch_line(index);
    for (const bool v : {false, true}) {
        const std::string axis = v ? " v" : " u";
        const RegisterIndex from = v ? from_v_ : no_length_;
        const RegisterIndex to = v ? to_v_ : one_length_;
        a_.move(v ? most.v : most.u, to);
        a_.move(v ? least.v : least.u, from);
        a_.jump_less(no_length_, v ? line_.b : line_.a, "rises" + axis);
        a_.move(v ? most.v : most.u, from);
        a_.move(v ? least.v : least.u, to);
        a_.label("rises" + axis);
    }
    value(at, line_, most);
    a_.jump_less(at, minus_hair_, "none");
    if (held || rung == HitTest::mask) {
        value(at, line_, least);
        a_.jump_less(at, minus_hair_, "crosses");
        a_.jump("edge done");
        a_.label("crosses");
        if (held) {
            edge();
            a_.store(kept[0], crossings_, held_a_);
            a_.store(kept[1], crossings_, held_b_);
            a_.store(kept[2], crossings_, held_c_);
        } else {
            a_.store(crossing_edges_, crossings_, index);
        }
        a_.add(crossings_, crossings_, one_);
        a_.label("edge done");
    }
    a_.add(index, index, one_);
    a_.label("edges left");
    a_.jump_less(index, edges_, "next edge");
}

/// Right at its foot, the point of the edge next to the run's middle.
void LoadingWriter::edge() {
    const int fraction = formats_.depth.fraction_bits() + 1;  // half a last bit
    const RegisterIndex half = a_.constant("half", std::int64_t(1) << (fraction - 1), fraction + 1, fraction);
    const RegisterIndex height = a_.reg("run", far_bits() + 1, fraction - 1);
    const RegisterIndex middle_v = a_.reg("half v", far_bits() + 1, fraction);
    const RegisterIndex c = length("line c at near", 1);
    const RegisterIndex moved = length("moved c");
    const RegisterIndex off = length("off");
    const RegisterIndex foot_u = length("foot u");
    const RegisterIndex foot_v = length("foot v");
    a_.move(c, line_.c);
    a_.move(middle_v, half);
    a_.jump_less(zero_, drop_z_, "edge here");
    a_.sum_to_nearest(moved, line_.c, {{line_.b, near_}});
    a_.move(c, moved);
    a_.subtract(height, far_, near_);
    a_.reinterpret(middle_v, height);
    a_.label("edge here");
    a_.sum_to_nearest(off, c, {{line_.a, half}, {line_.b, middle_v}});
    a_.sum_to_nearest(foot_u, half, {{line_.a, off, true}});
    a_.sum_to_nearest(foot_v, middle_v, {{line_.b, off, true}});
    a_.round(held_a_, line_.a);
    a_.round(held_b_, line_.b);
    a_.sum(held_c_, Assembler::none, {{held_a_, foot_u, true}, {held_b_, foot_v, true}});
}

void LoadingWriter::take_anchor() {
    const Format& unit = formats_.unit;
    const int v_bits = formats_.depth.integer_bits() + 1 + unit.fraction_bits();
    held_u_ = a_.reg("point u", unit.bits(), unit.fraction_bits());
    held_v_ = a_.reg("point v", v_bits, unit.fraction_bits());
    anchor_v_ = a_.reg("anchor v", v_bits, unit.fraction_bits());
}

/// The middle in words: the voxel's point, and the same from the run's beginning.
void LoadingWriter::anchor() {
    const Format& unit = formats_.unit;
    const Format& depth = formats_.depth;
    const RegisterIndex v = a_.reg("held v", unit.bits(), unit.fraction_bits());
    const RegisterIndex z = a_.reg("held z", depth.bits(), depth.fraction_bits());
    a_.most(middle_u_, middle_u_, no_length_);
    a_.least(middle_u_, middle_u_, one_length_);
    a_.round(held_u_, middle_u_);
    a_.jump_less(zero_, drop_z_, "v in the cell");
    a_.round(z, middle_v_);
    convert(held_v_, z);
    if (unit.fraction_bits() == depth.fraction_bits()) {
        a_.subtract(anchor_v_, z, near_);
    } else {
        a_.difference(anchor_v_, z, near_);
    }
    a_.jump("anchored");
    a_.label("v in the cell");
    a_.most(middle_v_, middle_v_, no_length_);
    a_.least(middle_v_, middle_v_, one_length_);
    a_.round(v, middle_v_);
    a_.move(held_v_, v);
    a_.move(anchor_v_, v);
    a_.label("anchored");
}

/// The plane's slopes in words.
void LoadingWriter::slopes() {
    plane_u_ = a_.reg("plane u", formats_.unit.bits(), formats_.unit.fraction_bits());
    plane_v_ = a_.reg("plane v", formats_.unit.bits(), formats_.unit.fraction_bits());
    a_.round(plane_u_, nu_);
    a_.round(plane_v_, nv_);
}

/// The plane's slopes and offset in words; the offset is right at the anchor.
void LoadingWriter::plane() {
    const Format& unit = formats_.unit;
    const int fraction = std::max(f_, unit.fraction_bits());
    const int bits = std::max(fraction - unit.fraction_bits() + 2, 4);
    const RegisterIndex offset = a_.reg("plane c", formats_.offset.bits(), formats_.offset.fraction_bits());
    const RegisterIndex nz = slope("nz");
    const RegisterIndex lost_u = a_.reg("lost u", bits, fraction);
    const RegisterIndex lost_v = a_.reg("lost v", bits, fraction);
    slopes();
    a_.difference(lost_u, plane_u_, nu_);
    a_.difference(lost_v, plane_v_, nv_);
    a_.move(nz, nv_);
    a_.jump_zero(drop_z_, "nz");
    a_.move(nz, one_length_);
    a_.jump_zero(negative_, "nz");
    a_.subtract(nz, no_length_, one_length_);
    a_.label("nz");
    a_.sum(offset, c_, {{nz, near_, true}, {held_u_, lost_u}, {anchor_v_, lost_v}});
}

/// size = the largest of some words, without signs.
void LoadingWriter::largest(const std::vector<RegisterIndex>& of, RegisterIndex size, RegisterIndex other) {
    a_.absolute(size, of.front());
    for (std::size_t i = 1; i < of.size(); ++i) {
        a_.absolute(other, of[i]);
        a_.most(size, size, other);
    }
}

void LoadingWriter::normal(Normals normals, HitTest rung) {
    const int word = formats_.word_bits;
    normal_base_ = vector("normal b", word, word - 4);
    normal_du_ = vector("normal u", word, word - 4);
    normal_dv_ = vector("normal v", word, word - 4);
    size_ = length("size", 1);
    other_size_ = length("other size", 1);
    scale_ = a_.reg("scale", 8, 0);
    to_normal_ = a_.constant("to a normal", f_ + 2, 8, 0);
    if (normals == Normals::voxel) {
        const Vector own = vector("own ", loading_, f_);
        for (std::size_t i = 0; i < 3; ++i) {
            if (rung == HitTest::depth) {
                a_.move(own[i], n_[i]);
            } else {
                a_.sum_to_nearest(own[i], base_[i], {{du_[i], held_u_}, {dv_[i], held_v_}});
            }
        }
        flat_normal(own);
        return;
    }
    near_base_ = vector("near b", loading_, f_);
    for (std::size_t i = 0; i < 3; ++i) a_.move(near_base_[i], base_[i]);
    largest({du_[0], du_[1], du_[2], dv_[0], dv_[1], dv_[2]}, size_, other_size_);
    a_.jump_zero(size_, "flat");
    steep_normal();
    a_.label("flat");
    flat_normal(near_base_);
    a_.label("normal done");
}

/// One normal for the whole voxel: as large as words hold.
void LoadingWriter::flat_normal(const Vector& base) {
    const RegisterIndex count = a_.reg("flat count", 8, 0);
    const RegisterIndex none = a_.constant("no normal", 0, 2, formats_.word_bits - 4);
    for (std::size_t i = 0; i < 3; ++i) {
        a_.move(normal_du_[i], none);
        a_.move(normal_dv_[i], none);
        a_.move(normal_base_[i], none);
    }
    largest({base[0], base[1], base[2]}, size_, other_size_);
    a_.jump_zero(size_, "no length");
    a_.count(count, size_);
    a_.add(scale_, count, to_normal_);
    for (std::size_t i = 0; i < 3; ++i)
        a_.scale(normal_base_[i], base[i], scale_, f_ - (formats_.word_bits - 4));
    a_.label("no length");
}

/// A field that turns: right at the anchor. If it turns so fast that words would leave too little of its
/// value there, that value is the voxel's only normal.
void LoadingWriter::steep_normal() {
    const int word = formats_.word_bits;
    const Vector& base = near_base_;
    const Vector middle = vector("middle n", loading_, f_);
    const RegisterIndex count = a_.reg("count", 8, 0);
    const RegisterIndex most = a_.reg("most count", 8, 0);
    const RegisterIndex unit = a_.reg("field size", 8, 0);
    const RegisterIndex room = a_.constant("bits of a normal", word - 8, 8, 0);
    a_.jump_less(zero_, drop_z_, "base here");
    for (std::size_t i = 0; i < 3; ++i) a_.sum_to_nearest(base[i], base_[i], {{dv_[i], near_}});
    a_.label("base here");
    for (std::size_t i = 0; i < 3; ++i)
        a_.sum_to_nearest(middle[i], base[i], {{du_[i], held_u_}, {dv_[i], anchor_v_}});
    for (std::size_t i = 0; i < 3; ++i) {
        a_.absolute(other_size_, base[i]);
        a_.most(size_, size_, other_size_);
    }
    a_.count(count, size_);
    a_.add(scale_, count, to_normal_);
    largest({middle[0], middle[1], middle[2]}, size_, other_size_);
    a_.jump_zero(size_, "single");
    a_.count(unit, size_);
    a_.add(most, count, room);
    a_.jump_less(most, unit, "single");
    const RegisterIndex back = a_.reg("back", 8, 0);
    a_.subtract(back, zero_, count);
    const int lost_bits = loading_ - word + 4;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        std::array<RegisterIndex, 2> lost{};
        for (const bool v : {false, true}) {
            const RegisterIndex held = v ? normal_dv_[i] : normal_du_[i];
            const RegisterIndex wide = v ? dv_[i] : du_[i];
            const RegisterIndex kept = length((v ? "kept v" : "kept u") + axis, 1);
            lost[v] = a_.reg((v ? "lost v" : "lost u") + axis, lost_bits, f_);
            a_.scale(held, wide, scale_, f_ - (word - 4));
            a_.scale(kept, held, back, word - 2);
            a_.subtract(lost[v], wide, kept);
        }
        a_.sum(normal_base_[i], base[i], {{lost[0], held_u_}, {lost[1], anchor_v_}}, scale_);
    }
    a_.jump("normal done");
    a_.label("single");
    for (std::size_t i = 0; i < 3; ++i) a_.move(base[i], middle[i]);
}

}  // namespace raycell
