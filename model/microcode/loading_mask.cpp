// Loading: the window of a voxel's mask, and the mask (loading/coverage.cpp).
#include <cmath>

#include "model/microcode/loading.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {
namespace {

constexpr int window_bits = 5;  // 32nds
constexpr int mask_bits = 3;    // eighths

}  // namespace

/// The lowest and highest u and v of a part.
void LoadingWriter::take_bounds() {
    low_ = corner("low");
    high_ = corner("high");
}

/// off / size in 32nds, down or up, from 0 on and up to the last one that an end may have.
void LoadingWriter::window_end(const std::string& name, const MaskAxis& m, RegisterIndex off,
                               RegisterIndex end, bool upwards) {
    const int steps = 1 << window_bits;
    const RegisterIndex last = a_.constant(name + " at most", upwards ? steps : steps - 1, 7, 0);
    a_.move(end, zero_);
    a_.jump_negative(off, name + " known");
    a_.move(end, last);
    a_.jump_less(off, m.size, name + " inside");
    a_.jump(name + " known");
    a_.label(name + " inside");
    a_.divide(name, end, off, m.size, window_bits, one_);
    if (upwards) {
        a_.jump_zero(off, name + " known");  // the division leaves its rest there
        a_.add(end, end, one_);
    }
    a_.label(name + " known");
}

/// One axis of the window: the part's bounds, rounded outwards to 32nds of the run's rectangle.
void LoadingWriter::window(const std::string& axis, const MaskAxis& m) {
    const RegisterIndex off = a_.reg(axis + " off", v_bits_ + 2, f_);
    const RegisterIndex least = number_of(axis + " least", 7);
    a_.subtract(m.size, m.to, m.from);
    a_.subtract(off, m.low, hair_);
    a_.subtract(off, off, m.from);
    window_end(axis + " from", m, off, m.first, false);
    a_.add(off, m.high, hair_);
    a_.subtract(off, off, m.from);
    window_end(axis + " to", m, off, m.last, true);
    a_.add(least, m.first, one_);
    a_.most(m.last, m.last, least);
}

/// Where the window's eighths begin and end.
void LoadingWriter::borders(const std::string& axis, const MaskAxis& m) {
    const RegisterIndex steps = a_.reg(axis + " window steps", 7, window_bits);
    const RegisterIndex low = a_.reg(axis + " window low", v_bits_ + 1, f_);
    const RegisterIndex size = a_.reg(axis + " window size", v_bits_ + 1, f_);
    a_.reinterpret(steps, m.first);
    a_.sum_down(low, m.from, {{m.size, steps}});
    a_.move(m.border, low);
    a_.reinterpret(steps, m.last);
    a_.sum_down(size, m.from, {{m.size, steps}});
    a_.move(m.border + 8, size);
    a_.subtract(size, size, low);
    for (std::size_t i = 1; i < 8; ++i) {
        const RegisterIndex eighths =
            a_.constant(axis + " eighths " + std::to_string(i), std::int64_t(i), 5, mask_bits);
        a_.sum_down(m.border + i, low, {{size, eighths}});
    }
}

/// The eighths of the window that the part's bounds touch.
void LoadingWriter::touched(const std::string& axis, const MaskAxis& m) {
    const RegisterIndex at = a_.reg(axis + " border", v_bits_ + 1, f_);
    const RegisterIndex bound = a_.reg(axis + " bound", v_bits_ + 1, f_);
    const RegisterIndex next = number(axis + " next");
    a_.subtract(bound, m.low, hair_);
    a_.move(next, zero_);
    a_.label(axis + " first");
    a_.move(m.first_touched, next);
    a_.add(next, next, one_);
    a_.fetch(at, m.border, next);
    a_.jump_less(at, bound, axis + " first");
    a_.add(bound, m.high, hair_);
    a_.move(next, eight_);
    a_.label(axis + " last");
    a_.subtract(next, next, one_);
    a_.fetch(at, m.border, next);
    a_.jump_less(bound, at, axis + " last");
    a_.move(m.last_touched, next);
}

LoadingWriter::MaskAxis LoadingWriter::mask_axis(const std::string& axis, RegisterIndex from,
                                                 RegisterIndex to, RegisterIndex low, RegisterIndex high) {
    MaskAxis m;
    m.from = from;
    m.to = to;
    m.low = low;
    m.high = high;
    m.size = a_.reg(axis + " size", v_bits_ + 1, f_);
    m.first = number_of(axis + " window from", 7);
    m.last = number_of(axis + " window to", 7);
    m.first_touched = number(axis + " first touched");
    m.last_touched = number(axis + " last touched");
    m.border = a_.array(axis + " border", 9, v_bits_ + 1, f_);
    window(axis, m);
    borders(axis, m);
    touched(axis, m);
    return m;
}

/// Along a row of the mask an edge keeps all columns from one on, or all up to one: it rises or falls.
void LoadingWriter::narrow(const MaskAxis& u, const MaskAxis& v) {
    const int fraction = std::max(2 * f_, f_);
    const RegisterIndex base = a_.reg("edge on row", std::max(loading_, v_bits_) + f_ + 4, fraction);
    const RegisterIndex at = length("cell at", 2);
    const RegisterIndex along = a_.reg("cell u", v_bits_ + 1, f_);
    const RegisterIndex across = a_.reg("cell v", v_bits_ + 1, f_);
    const RegisterIndex index = number("cell border");
    a_.move(index, row_);
    a_.jump_less(line_.b, one_bit_, "row chosen");
    a_.add(index, row_, one_);
    a_.label("row chosen");
    a_.fetch(across, v.border, index);
    a_.sum(base, line_.c, {{line_.b, across}});
    a_.jump_less(line_.a, one_bit_, "falls");
    a_.label("rises");
    a_.jump_less(to_column_, from_column_, "row known");
    a_.add(index, from_column_, one_);
    a_.fetch(along, u.border, index);
    a_.sum_down(at, base, {{line_.a, along}});
    a_.jump_less(at, minus_hair_, "behind");
    a_.jump("edge on row done");
    a_.label("behind");
    a_.move(from_column_, index);
    a_.jump("rises");
    a_.label("falls");
    a_.jump_less(to_column_, from_column_, "row known");
    a_.fetch(along, u.border, to_column_);
    a_.sum_down(at, base, {{line_.a, along}});
    a_.jump_less(at, minus_hair_, "before");
    a_.jump("edge on row done");
    a_.label("before");
    a_.subtract(to_column_, to_column_, one_);
    a_.jump("falls");
    a_.label("edge on row done");
}

void LoadingWriter::mask() {
    eight_ = a_.constant("8", 8, 6, 0);
    hair_ =
        a_.constant("mask hair", std::int64_t(std::floor(scale_by(4 * formats_.unit.step(), f_))), 24, f_);
    one_bit_ = a_.constant("last bit", 1, 4, f_);
    const MaskAxis u = mask_axis("mask u", no_length_, one_length_, low_.u, high_.u);
    const MaskAxis v = mask_axis("mask v", from_v_, to_v_, low_.v, high_.v);
    const RegisterIndex rows = a_.array("mask row", 8, 9, 0);
    const RegisterIndex bits = number_of("row's bits", 9);
    const RegisterIndex below = number_of("bits below", 9);
    const RegisterIndex which = number("edge of mask");
    const RegisterIndex edge = number("number of edge");
    std::vector<std::int64_t> values;
    for (int i = 0; i <= 8; ++i) values.push_back((1 << i) - 1);
    const RegisterIndex up_to = a_.constants("bits up to", values, 9, 0);
    row_ = number("row");
    from_column_ = number("from column");
    to_column_ = number("to column");
    a_.move(row_, zero_);
    a_.label("next row");
    a_.move(from_column_, one_);  // none: from 1 to 0
    a_.move(to_column_, zero_);
    a_.jump_less(row_, v.first_touched, "row known");
    a_.jump_less(v.last_touched, row_, "row known");
    a_.move(from_column_, u.first_touched);
    a_.move(to_column_, u.last_touched);
    a_.move(which, zero_);
    a_.jump("edges of mask left");
    a_.label("next edge of mask");
    a_.fetch(edge, crossing_edges_, which);
    fetch_line(edge);
    narrow(u, v);
    a_.add(which, which, one_);
    a_.label("edges of mask left");
    a_.jump_less(which, crossings_, "next edge of mask");
    a_.label("row known");
    a_.add(to_column_, to_column_, one_);
    a_.most(to_column_, to_column_, from_column_);
    a_.fetch(bits, up_to, to_column_);
    a_.fetch(below, up_to, from_column_);
    a_.subtract(bits, bits, below);
    a_.store(rows, row_, bits);
    a_.add(row_, row_, one_);
    a_.jump_less(row_, eight_, "next row");
}

}  // namespace raycell
