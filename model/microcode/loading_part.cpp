// Loading: the part of a polygon that lies over a cell, cut from the cell's rectangle line by line.
#include <cmath>

#include "model/microcode/loading.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {
namespace {

constexpr std::size_t bank = 10;  ///< corners that a part may have
constexpr int most_lines = 6;     ///< four edges, two bounds of the dropped axis
constexpr int share_bits = 32;

}  // namespace

LoadingWriter::LoadingWriter(Assembler& assembler, const MicroSetting& setting, const DepthLevels& levels)
    : a_(assembler),
      formats_(setting.formats()),
      levels_(levels),
      loading_(formats_.loading.bits()),
      f_(formats_.loading.fraction_bits()),
      v_bits_(formats_.depth_bits + 2 + f_) {
    zero_ = a_.constant("0", 0, 6, 0);
    one_ = a_.constant("1", 1, 6, 0);
    no_length_ = loading_constant("no length", 0, f_ + 2);
    one_length_ = loading_constant("a cell", 1, f_ + 2);
}

RegisterIndex LoadingWriter::loading_constant(const std::string& name, double value, int bits) {
    return a_.constant(name, std::int64_t(std::floor(scale_by(value, f_))), bits, f_);
}

LoadingWriter::Vector LoadingWriter::vector(const std::string& name, int bits, int fraction) {
    return {a_.reg(name + "x", bits, fraction), a_.reg(name + "y", bits, fraction),
            a_.reg(name + "z", bits, fraction)};
}

LoadingWriter::Corner LoadingWriter::corner(const std::string& name) {
    return {slope(name + " u"), a_.reg(name + " v", v_bits_, f_)};
}

void LoadingWriter::copy(const Corner& to, const Corner& from) {
    a_.move(to.u, from.u);
    a_.move(to.v, from.v);
}

/// Which side of a line a corner is on: c + a·u + b·v, cut off.
void LoadingWriter::value(RegisterIndex target, const Line& line, const Corner& at) {
    a_.sum_down(target, line.c, {{line.a, at.u}, {line.b, at.v}});
}

void LoadingWriter::fetch_line(RegisterIndex number) {
    a_.fetch(line_.a, edge_a_, number);
    a_.fetch(line_.b, edge_b_, number);
    a_.fetch(line_.c, edge_c_, number);
}

void LoadingWriter::take_span() {
    drop_z_ = number("drop z");
    drop_x_ = number("drop x");
    negative_ = number("negative");
    nu_ = slope("nu");
    nv_ = slope("nv");
    c_ = length("c");
    slack_ = length("slack");
    edges_ = number("edges");
    edge_a_ = a_.array("edge a", most_lines, f_ + 2, f_);
    edge_b_ = a_.array("edge b", most_lines, f_ + 2, f_);
    edge_c_ = a_.array("edge c", most_lines, loading_ + 1, f_);
}

void LoadingWriter::take_depth_span() {
    drop_z_ = number("drop z");
    drop_x_ = number("drop x");
    z_ = length("z");
    dz_ = length("dz");
    n_ = vector("n", loading_, f_);
    dn_ = vector("dn", loading_, f_);
}

void LoadingWriter::take_normals() {
    base_ = vector("b", loading_, f_);
    du_ = vector("u", loading_, f_);
    dv_ = vector("v", loading_, f_);
}

void LoadingWriter::take_corners() {
    u_ = a_.array("u", 2 * bank, f_ + 2, f_);
    v_ = a_.array("v", 2 * bank, v_bits_, f_);
    begin_ = number("begin");
    other_ = number("other");
    count_ = number("corners");
}

void LoadingWriter::take_line() { line_ = {slope("line a"), slope("line b"), length("line c", 1)}; }

/// The inner end of a side that a line cuts, the way to the outer one, and what tells how far to go.
void LoadingWriter::side_of(const std::string& name, const Corner& from, const Corner& to,
                            RegisterIndex from_at, RegisterIndex to_at) {
    a_.label(name);
    a_.subtract(way_.u, to.u, from.u);
    a_.subtract(way_.v, to.v, from.v);
    copy(from_, from);
    a_.move(rest_, from_at);
    a_.subtract(by_, from_at, to_at);
}

/// Where the line cuts the side.
void LoadingWriter::add_cut_point() {
    a_.divide("share", quotient_, rest_, by_, loading_ - 1, one_);
    a_.sum_down(from_.u, from_.u, {{way_.u, quotient_}});
    a_.sum_down(from_.v, from_.v, {{way_.v, quotient_}});
    a_.store(u_, out_, from_.u);
    a_.store(v_, out_, from_.v);
    a_.add(out_, out_, one_);
}

void LoadingWriter::cut() {
    const RegisterIndex index = number("corner");
    const RegisterIndex end = number("end");
    const RegisterIndex outside = number("outside");
    const RegisterIndex three = a_.constant("3", 3, 6, 0);
    const RegisterIndex both = a_.constant("both banks", bank, 6, 0);
    out_ = number("out");
    p_ = corner("p");
    q_ = corner("q");
    first_ = corner("first");
    way_ = corner("way");
    from_ = corner("from");
    p_at_ = length("p at", 2);
    q_at_ = length("q at", 2);
    first_at_ = length("first at", 2);
    rest_ = length("rest", 4);
    by_ = length("by", 3);
    quotient_ = a_.reg("quotient", loading_, loading_ - 1);
    a_.move(index, begin_);
    a_.add(end, begin_, count_);
    a_.move(out_, other_);
    a_.move(outside, zero_);
    a_.fetch(p_.u, u_, index);
    a_.fetch(p_.v, v_, index);
    value(p_at_, line_, p_);
    copy(first_, p_);
    a_.move(first_at_, p_at_);
    a_.label("next side");
    a_.add(index, index, one_);
    a_.jump_less(index, end, "next corner");
    copy(q_, first_);
    a_.move(q_at_, first_at_);
    a_.jump("side");
    a_.label("next corner");
    a_.fetch(q_.u, u_, index);
    a_.fetch(q_.v, v_, index);
    value(q_at_, line_, q_);
    a_.label("side");
    a_.jump_negative(p_at_, "outside");
    a_.store(u_, out_, p_.u);
    a_.store(v_, out_, p_.v);
    a_.add(out_, out_, one_);
    a_.jump_negative(q_at_, "leaves");
    a_.label("side done");
    a_.jump_less(index, end, "again");
    a_.jump_zero(outside, "line done");  // it cuts nothing: the part stays in its bank
    a_.subtract(count_, out_, other_);
    a_.subtract(begin_, both, begin_);
    a_.subtract(other_, both, other_);
    a_.jump_less(count_, three, "nothing left");
    a_.jump("line done");
    a_.label("nothing left");
    a_.move(count_, zero_);
    a_.jump("line done");
    a_.label("again");
    copy(p_, q_);
    a_.move(p_at_, q_at_);
    a_.jump("next side");
    a_.label("outside");
    a_.move(outside, one_);
    a_.jump_negative(q_at_, "side done");
    a_.jump_zero(q_at_, "side done");
    side_of("enters", q_, p_, q_at_, p_at_);
    a_.jump("cut side");
    a_.label("leaves");
    a_.jump_zero(p_at_, "side done");
    side_of("leaves there", p_, q_, p_at_, q_at_);
    a_.label("cut side");
    add_cut_point();
    a_.jump("side done");
    a_.label("line done");
}

void LoadingWriter::rectangle() {
    const RegisterIndex four = a_.constant("4", 4, 6, 0);
    const RegisterIndex depth = loading_constant("depth", levels_.level * levels_.count, v_bits_);
    const RegisterIndex high_v = a_.reg("high v", v_bits_, f_);
    const RegisterIndex both = a_.constant("other bank", bank, 6, 0);
    a_.move(high_v, depth);
    a_.jump_zero(drop_z_, "corners");
    a_.move(high_v, one_length_);
    a_.label("corners");
    for (const RegisterIndex corner : {0, 1, 2, 3}) {
        a_.move(u_ + corner, corner == 1 || corner == 2 ? one_length_ : no_length_);
        a_.move(v_ + corner, corner >= 2 ? high_v : no_length_);
    }
    a_.move(count_, four);
    a_.move(begin_, zero_);
    a_.move(other_, both);
}

/// The dropped axis as a function of the other two, and, where it is not z, the cell's bounds in it as two
/// more lines after the edges. Lines are later moved outwards by `room`, bounds are not: they are moved
/// inwards before.
void LoadingWriter::add_bounds() {
    const RegisterIndex offset = length("bound", 1);
    height_ = {slope("height a"), slope("height b"), length("height c", 1)};
    a_.move(height_.a, nu_);
    a_.move(height_.b, nv_);
    a_.subtract(height_.c, no_length_, c_);
    a_.jump_less(zero_, negative_, "height");
    a_.subtract(height_.a, no_length_, nu_);
    a_.subtract(height_.b, no_length_, nv_);
    a_.move(height_.c, c_);
    a_.label("height");
    a_.move(lines_, edges_);
    a_.jump_less(zero_, drop_z_, "bounds done");
    const auto add = [&] {
        a_.store(edge_a_, lines_, line_.a);
        a_.store(edge_b_, lines_, line_.b);
        a_.store(edge_c_, lines_, line_.c);
        a_.add(lines_, lines_, one_);
    };
    a_.subtract(offset, slack_, room_);
    a_.move(line_.a, height_.a);
    a_.move(line_.b, height_.b);
    a_.add(line_.c, offset, height_.c);
    add();
    a_.subtract(line_.a, no_length_, height_.a);
    a_.subtract(line_.b, no_length_, height_.b);
    a_.add(offset, offset, one_length_);
    a_.subtract(line_.c, offset, height_.c);
    add();
    a_.label("bounds done");
}

void LoadingWriter::take_measures() {
    middle_u_ = slope("middle u");
    middle_v_ = a_.reg("middle v", v_bits_, f_);
    area_ = length("twice area", 1);
    z_low_ = length("z low", 2);
    z_high_ = length("z high", 2);
}

void LoadingWriter::part() {
    const RegisterIndex line = number("line");
    room_ = loading_constant("room", std::max(formats_.unit.step(), formats_.loading.step()), loading_);
    lines_ = number("lines");
    rectangle();
    add_bounds();
    a_.move(line, zero_);
    a_.jump("lines left");
    a_.label("next line");
    fetch_line(line);
    a_.add(line_.c, line_.c, room_);
    cut();
    a_.jump_zero(count_, "none");
    a_.add(line, line, one_);
    a_.label("lines left");
    a_.jump_less(line, lines_, "next line");
    measure();
}

void LoadingWriter::measure() {
    const RegisterIndex index = number("measured");
    const RegisterIndex end = number("measured end");
    const RegisterIndex three = a_.constant("least corners", 3, 6, 0);
    const RegisterIndex share = a_.reg("share", share_bits + 1, share_bits);
    const RegisterIndex sum_u = a_.reg("sum u", f_ + 6, f_);
    const RegisterIndex sum_v = a_.reg("sum v", v_bits_ + 4, f_);
    const RegisterIndex at = length("height", 2);
    const RegisterIndex product = length("product", 1);
    const Corner before = corner("before");
    const Corner here = corner("here");
    const std::int64_t most = (std::int64_t(1) << (loading_ + 1)) - 1;
    const RegisterIndex highest = a_.constant("highest", most, loading_ + 2, f_);
    const RegisterIndex lowest = a_.constant("lowest", -most - 1, loading_ + 2, f_);
    std::vector<std::int64_t> values;
    for (std::int64_t n = 3; n <= std::int64_t(bank); ++n)
        values.push_back((std::int64_t(1) << share_bits) / n);
    const RegisterIndex shares = a_.constants("share of", values, share_bits + 1, share_bits);
    a_.move(index, begin_);
    a_.add(end, begin_, count_);
    a_.fetch(first_.u, u_, index);
    a_.fetch(first_.v, v_, index);
    a_.subtract(sum_u, sum_u, sum_u);
    a_.subtract(sum_v, sum_v, sum_v);
    a_.subtract(area_, area_, area_);
    a_.move(before.u, no_length_);
    a_.move(before.v, no_length_);
    a_.move(z_low_, highest);
    a_.move(z_high_, lowest);
    const bool bounds = low_.u != Assembler::none;
    if (bounds) {
        copy(low_, first_);
        copy(high_, first_);
    }
    a_.label("measure");
    a_.fetch(p_.u, u_, index);
    a_.fetch(p_.v, v_, index);
    a_.add(sum_u, sum_u, p_.u);
    a_.add(sum_v, sum_v, p_.v);
    if (bounds) {
        a_.least(low_.u, low_.u, p_.u);
        a_.least(low_.v, low_.v, p_.v);
        a_.most(high_.u, high_.u, p_.u);
        a_.most(high_.v, high_.v, p_.v);
    }
    a_.jump_zero(drop_z_, "v is depth");
    value(at, height_, p_);
    a_.jump("depth");
    a_.label("v is depth");
    a_.move(at, p_.v);
    a_.label("depth");
    a_.least(z_low_, z_low_, at);
    a_.most(z_high_, z_high_, at);
    // Corners from the first one: the area of the triangle with the corner before.
    a_.subtract(here.u, p_.u, first_.u);
    a_.subtract(here.v, p_.v, first_.v);
    a_.sum_down(area_, area_, {{before.u, here.v}});
    a_.sum_down(product, Assembler::none, {{here.u, before.v}});
    a_.subtract(area_, area_, product);
    copy(before, here);
    a_.add(index, index, one_);
    a_.jump_less(index, end, "measure");
    a_.subtract(index, count_, three);
    a_.fetch(share, shares, index);
    a_.sum_down(middle_u_, Assembler::none, {{share, sum_u}});
    a_.sum_down(middle_v_, Assembler::none, {{share, sum_v}});
}

}  // namespace raycell
