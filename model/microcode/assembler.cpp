// Writes microprograms.
#include <algorithm>
#include <stdexcept>

#include "model/microcode/program.hpp"

namespace raycell {

namespace {
using Op = MicroInstruction::Op;
}  // namespace

Assembler::Assembler(std::string name, const Datapath& datapath, Rounding rounding) {
    program_.name = std::move(name);
    program_.datapath = datapath;
    program_.rounding = rounding;
}

MicroInstruction& Assembler::emit(Op op, RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    program_.instructions.emplace_back();
    MicroInstruction& i = program_.instructions.back();
    i.op = op;
    i.target = target;
    i.a = a;
    i.b = b;
    return i;
}

RegisterIndex Assembler::reg(const std::string& name, int bits, int fraction) {
    program_.registers.push_back({name, bits, fraction});
    return program_.registers.size() - 1;
}

RegisterIndex Assembler::constant(const std::string& name, std::int64_t value, int bits, int fraction) {
    const RegisterIndex index = reg(name, bits, fraction);
    MicroInstruction& i = emit(Op::constant);
    i.target = index;
    i.value = value;
    return index;
}

RegisterIndex Assembler::array(const std::string& name, std::size_t count, int bits, int fraction) {
    const RegisterIndex first = program_.registers.size();
    for (std::size_t i = 0; i < count; ++i) reg(name + " " + std::to_string(i), bits, fraction);
    program_.arrays[first] = count;
    return first;
}

RegisterIndex Assembler::constants(const std::string& name, const std::vector<std::int64_t>& values, int bits,
                                   int fraction) {
    const RegisterIndex first = program_.registers.size();
    for (std::size_t i = 0; i < values.size(); ++i)
        constant(name + " " + std::to_string(i), values[i], bits, fraction);
    program_.arrays[first] = values.size();
    return first;
}

void Assembler::fetch(RegisterIndex target, RegisterIndex array, RegisterIndex number) {
    same_fraction(target, array);
    emit(Op::fetch, target, array, number);
}

void Assembler::store(RegisterIndex array, RegisterIndex number, RegisterIndex a) {
    fetch(a, array, number);
    program_.instructions.back().op = Op::store;
}

void Assembler::same_fraction(RegisterIndex a, RegisterIndex b) const {
    const MicroRegister& x = program_.registers[a];
    const MicroRegister& y = program_.registers[b];
    if (x.fraction != y.fraction)
        throw std::logic_error("microprogram " + program_.name + ": " + x.name + " and " + y.name +
                               " have other last bits");
}

int Assembler::accumulate(RegisterIndex c, const std::vector<Factor>& products) {
    const auto& r = program_.registers;
    int fraction = c == none ? r[products[0].a].fraction + r[products[0].b].fraction : r[c].fraction;
    for (const Factor& f : products) fraction = std::max(fraction, r[f.a].fraction + r[f.b].fraction);
    if (c == none) {
        emit(Op::clear);
    } else {
        MicroInstruction& load = emit(Op::load);
        load.a = c;
        load.shift = fraction - r[c].fraction;
    }
    const Datapath& path = program_.datapath;
    std::vector<MicroInstruction::Product> all;
    for (const Factor& f : products) {
        const int align = fraction - r[f.a].fraction - r[f.b].fraction;
        for (int i = 0; i < parts_of(r[f.a].bits, path.first_bits); ++i) {
            for (int j = 0; j < parts_of(r[f.b].bits, path.second_bits); ++j) {
                const int shift = align + i * (path.first_bits - 1) + j * (path.second_bits - 1);
                all.push_back({f.a, i, f.b, j, shift, f.negative});
            }
        }
    }
    for (std::size_t i = 0; i < all.size(); i += std::size_t(path.multipliers)) {
        const std::size_t stop = std::min(all.size(), i + std::size_t(path.multipliers));
        emit(Op::multiply).products = {all.begin() + std::ptrdiff_t(i), all.begin() + std::ptrdiff_t(stop)};
    }
    return fraction;
}

void Assembler::sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products,
                    RegisterIndex by) {
    const int fraction = accumulate(c, products);
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = fraction - program_.registers[target].fraction;
    out.shifts_by = by != none;
    if (out.shifts_by) out.b = by;
}

void Assembler::sum_to_nearest(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products) {
    sum(target, c, products);
    program_.instructions.back().nearest = true;
}

void Assembler::sum_down(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products) {
    sum(target, c, products);
    program_.instructions.back().down = true;
}

void Assembler::half_sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products) {
    sum(target, c, products);
    ++program_.instructions.back().shift;
}

void Assembler::halve(RegisterIndex target, RegisterIndex a) {
    emit(Op::load, 0, a);
    emit(Op::round, target).shift = 1;
}

void Assembler::reinterpret(RegisterIndex target, RegisterIndex a) { emit(Op::move, target, a); }

void Assembler::absolute_of(RegisterIndex target, RegisterIndex a) { emit(Op::absolute, target, a); }

void Assembler::move(RegisterIndex target, RegisterIndex a) {
    same_fraction(target, a);
    emit(Op::move, target, a);
}

void Assembler::add(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    same_fraction(a, b);
    same_fraction(target, a);
    emit(Op::add, target, a, b);
}

void Assembler::subtract(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    add(target, a, b);
    program_.instructions.back().op = Op::subtract;
}

void Assembler::least(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    add(target, a, b);
    program_.instructions.back().op = Op::least;
}

void Assembler::most(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    add(target, a, b);
    program_.instructions.back().op = Op::most;
}

void Assembler::round(RegisterIndex target, RegisterIndex a) {
    emit(Op::load, 0, a);
    emit(Op::round, target).shift = program_.registers[a].fraction - program_.registers[target].fraction;
}

void Assembler::round_down(RegisterIndex target, RegisterIndex a) {
    round(target, a);
    program_.instructions.back().down = true;
}

void Assembler::difference(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    const auto& r = program_.registers;
    const int fraction = std::max(r[a].fraction, r[b].fraction);
    MicroInstruction& load = emit(Op::load);
    load.a = a;
    load.shift = fraction - r[a].fraction;
    MicroInstruction& off = emit(Op::take_off);
    off.a = b;
    off.value = -1;
    off.shift = fraction - r[b].fraction;
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = fraction - r[target].fraction;
}

void Assembler::scale(RegisterIndex target, RegisterIndex a, RegisterIndex by, int shift) {
    MicroInstruction& load = emit(Op::load);
    load.a = a;
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = shift;
    out.shifts_by = true;
    out.b = by;
}

void Assembler::absolute(RegisterIndex target, RegisterIndex a) {
    move(target, a);
    program_.instructions.back().op = Op::absolute;
}

void Assembler::count(RegisterIndex target, RegisterIndex a) { emit(Op::count, target, a); }

void Assembler::low(RegisterIndex target, RegisterIndex a, int bits) {
    emit(Op::low, target, a).shift = bits;
}

void Assembler::high(RegisterIndex target, RegisterIndex a, int shift) {
    low(target, a, shift);
    program_.instructions.back().op = Op::high;
}

void Assembler::bit(RegisterIndex target, RegisterIndex a, RegisterIndex number) {
    emit(Op::bit, target, a, number);
}

void Assembler::join(RegisterIndex target, RegisterIndex a, int shift, RegisterIndex b) {
    MicroInstruction& load = emit(Op::load);
    load.a = a;
    load.shift = shift;
    MicroInstruction& add = emit(Op::take_off);
    add.a = b;
    add.value = 1;
    emit(Op::round, target);
}

void Assembler::keep(RegisterIndex target) { emit(Op::round, target); }

void Assembler::scale_sum(RegisterIndex target, RegisterIndex whole, RegisterIndex part, RegisterIndex by) {
    const auto& r = program_.registers;
    join(target, whole, r[part].fraction - r[whole].fraction, part);
    MicroInstruction& out = program_.instructions.back();
    out.shift = r[part].fraction - r[target].fraction;
    out.shifts_by = true;
    out.b = by;
}

void Assembler::jump_product_negative(RegisterIndex c, RegisterIndex a, RegisterIndex b,
                                      const std::string& to) {
    accumulate(c, {{a, b}});
    jump_to(Op::jump_minus, 0, 0, to);
}

void Assembler::table(RegisterIndex start, RegisterIndex rise, const MicroTable& lines, RegisterIndex a,
                      int shift) {
    auto known = std::find_if(program_.tables.begin(), program_.tables.end(),
                              [&](const MicroTable& t) { return t.name == lines.name; });
    if (known == program_.tables.end()) known = program_.tables.insert(known, lines);
    MicroInstruction& i = emit(Op::table);
    i.target = start;
    i.b = rise;
    i.a = a;
    i.shift = shift;
    i.table_index = std::size_t(known - program_.tables.begin());
}

void Assembler::divide(const std::string& name, RegisterIndex target, RegisterIndex rest, RegisterIndex by,
                       int digits, RegisterIndex one) {
    emit(Op::clear);
    for (int digit = digits - 1; digit >= 0; --digit) {
        const std::string next = name + " digit " + std::to_string(digit);
        emit(Op::add, rest, rest, rest);
        jump_to(Op::jump_less, rest, by, next);
        emit(Op::subtract, rest, rest, by);
        MicroInstruction& set = emit(Op::take_off, 0, one);
        set.value = 1;
        set.shift = digit;
        label(next);
    }
    keep(target);
}

void Assembler::label(const std::string& name) {
    if (!labels_.emplace(name, program_.instructions.size()).second)
        throw std::logic_error("microprogram " + program_.name + " has two labels " + name);
}

void Assembler::jump_to(Op op, RegisterIndex a, RegisterIndex b, const std::string& to) {
    jumps_.emplace_back(program_.instructions.size(), to);
    emit(op, 0, a, b);
}

void Assembler::jump(const std::string& to) { jump_to(Op::jump, 0, 0, to); }

void Assembler::jump_less(RegisterIndex a, RegisterIndex b, const std::string& to) {
    same_fraction(a, b);
    jump_to(Op::jump_less, a, b, to);
}

void Assembler::jump_negative(RegisterIndex a, const std::string& to) {
    jump_to(Op::jump_negative, a, 0, to);
}

void Assembler::jump_zero(RegisterIndex a, const std::string& to) { jump_to(Op::jump_zero, a, 0, to); }

void Assembler::jump_sum_negative(const std::vector<Term>& terms, const std::string& to) {
    const auto& r = program_.registers;
    int fraction = r[terms.front().a].fraction;
    for (const Term& term : terms) fraction = std::max(fraction, r[term.a].fraction);
    // The accumulator is loaded with a term that is not subtracted.
    std::vector<Term> order = terms;
    std::stable_sort(order.begin(), order.end(),
                     [](const Term& x, const Term& y) { return x.negative < y.negative; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        MicroInstruction& part = emit(i == 0 ? Op::load : Op::take_off);
        part.a = order[i].a;
        part.value = order[i].negative ? -1 : 1;
        part.shift = fraction - r[order[i].a].fraction + order[i].shift;
    }
    jump_to(Op::jump_minus, 0, 0, to);
}

void Assembler::end() { emit(Op::end); }

MicroProgram Assembler::finish() {
    for (const auto& [at, to] : jumps_) {
        const auto found = labels_.find(to);
        if (found == labels_.end())
            throw std::logic_error("microprogram " + program_.name + " has no label " + to);
        program_.instructions[at].to = found->second;
    }
    return std::move(program_);
}

}  // namespace raycell
