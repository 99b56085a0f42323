#include "model/microcode/program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/numbers/bits.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {
namespace {

using Op = MicroInstruction::Op;

constexpr const char* op_names[] = {
    "constant", "move",  "add",       "subtract",      "least",     "most",       "load",
    "add to",   "clear", "absolute",  "count",         "low",       "table",      "multiply",
    "round",    "jump",  "jump less", "jump negative", "jump zero", "jump minus", "end"};

/// Bits of a two's complement word that holds the value.
int bits_of(__int128 value) {
    int bits = 1;
    for (__int128 rest = value < 0 ? ~value : value; rest > 0; rest >>= 1) ++bits;
    return bits;
}

}  // namespace

RegisterIndex MicroProgram::find(const std::string& wanted) const {
    for (RegisterIndex i = 0; i < registers.size(); ++i) {
        if (registers[i].name == wanted) return i;
    }
    throw std::out_of_range("the program " + name + " has no register " + wanted);
}

int MicroProgram::register_bits() const {
    int bits = 0;
    for (const MicroRegister& r : registers) bits += r.bits;
    return bits;
}

int MicroProgram::instruction_bits() const {
    const int operation = 4;
    const int address = bits_for(std::int64_t(registers.size()));
    const int shift = 7;
    const int jump = bits_for(std::int64_t(instructions.size()));
    // A target or the place of a jump, two operands of each multiplier and which parts of them, a shift.
    return operation + std::max(address, jump) + datapath.multipliers * (2 * (address + 2) + 1) + shift;
}

std::string MicroProgram::listing() const {
    std::string text;
    const auto reg = [&](RegisterIndex i) { return registers[i].name; };
    for (std::size_t at = 0; at < instructions.size(); ++at) {
        const MicroInstruction& i = instructions[at];
        text += std::to_string(at) + "  " + op_names[std::size_t(i.op)];
        switch (i.op) {
            case Op::constant:
                text += " " + reg(i.target) + " = " + std::to_string(i.value);
                break;
            case Op::absolute:
                text += " " + reg(i.target) + " = |" + reg(i.a) + "|";
                break;
            case Op::move:
                text += " " + reg(i.target) + " = " + reg(i.a);
                break;
            case Op::add:
            case Op::subtract:
            case Op::least:
            case Op::most:
                text += " " + reg(i.target) + " = " + reg(i.a) + ", " + reg(i.b);
                break;
            case Op::load:
            case Op::take_off:
                text += " " + reg(i.a) + " << " + std::to_string(i.shift);
                break;
            case Op::count:
                text += " " + reg(i.target) + " = -log2 " + reg(i.a);
                break;
            case Op::low:
                text += " " + reg(i.target) + " = " + reg(i.a) + " below 2^" + std::to_string(i.shift);
                break;
            case Op::table:
                text += " " + reg(i.target) + ", " + reg(i.b) + " = " + tables[i.table_index].name + " at " +
                        reg(i.a) + " >> " + std::to_string(i.shift);
                break;
            case Op::multiply:
                for (const auto& p : i.products) {
                    text += std::string(p.negative ? " -" : " +") + reg(p.a) + "." +
                            std::to_string(p.a_part) + "*" + reg(p.b) + "." + std::to_string(p.b_part) +
                            "<<" + std::to_string(p.shift);
                }
                break;
            case Op::round:
                text += " " + reg(i.target) + " >> " + std::to_string(i.shift) +
                        (i.shifts_by ? " - " + reg(i.b) : "");
                break;
            case Op::jump_less:
                text += " " + reg(i.a) + " < " + reg(i.b) + " to " + std::to_string(i.to);
                break;
            case Op::jump_negative:
            case Op::jump_zero:
                text += " " + reg(i.a) + " to " + std::to_string(i.to);
                break;
            case Op::jump_minus:
            case Op::jump:
                text += " to " + std::to_string(i.to);
                break;
            case Op::clear:
            case Op::end:
                break;
        }
        text += "\n";
    }
    return text;
}

MicroMachine::MicroMachine(const MicroProgram& program)
    : program_(program), values_(program.registers.size(), 0) {
    for (const MicroInstruction& i : program.instructions) {
        if (i.op == Op::constant) set(i.target, i.value);
    }
}

void MicroMachine::set(RegisterIndex index, std::int64_t value) {
    const MicroRegister& r = program_.registers[index];
    if (bits_of(value) > r.bits)
        throw std::logic_error("microprogram " + program_.name + ": " + std::to_string(value) +
                               " does not fit the " + std::to_string(r.bits) + " bits of " + r.name);
    values_[index] = value;
}

void MicroMachine::put(const std::string& name, double value) {
    const RegisterIndex index = program_.find(name);
    const double word = scale_by(value, program_.registers[index].fraction);
    if (word != std::floor(word))
        throw std::logic_error("microprogram " + program_.name + ": no word for " + name);
    set(index, std::int64_t(word));
}

double MicroMachine::take(const std::string& name) const {
    const RegisterIndex index = program_.find(name);
    return scale_by(double(values_[index]), -program_.registers[index].fraction);
}

std::int64_t MicroMachine::part(RegisterIndex index, int number, int width) const {
    const int step = width - 1;
    const bool last = number + 1 == parts_of(program_.registers[index].bits, width);
    const std::int64_t rest = values_[index] >> (number * step);
    return last ? rest : rest & ((std::int64_t(1) << step) - 1);
}

/// The accumulator / 2^shift, to the nearest (ties to even) or cut off, saturated to `bits` bits.
std::int64_t MicroMachine::rounded(int shift, int bits, bool nearest) const {
    const __int128 most = (__int128(1) << (bits - 1)) - 1;
    __int128 value = accumulator_;
    if (shift < 0) {
        // Beyond every register: saturates, whatever is shifted in.
        if (value != 0 && bits_of(value) - shift > 120) return std::int64_t(value > 0 ? most : -most - 1);
        value *= __int128(1) << -shift;
    } else if (shift > 125) {
        value = value < 0 && !nearest ? -1 : 0;
    } else if (shift > 0) {
        const __int128 down = value >> shift;
        const __int128 rest = value - down * (__int128(1) << shift);
        const __int128 half = __int128(1) << (shift - 1);
        const bool up = nearest && (rest > half || (rest == half && (down & 1)));
        value = down + (up ? 1 : 0);
    }
    return std::int64_t(std::clamp(value, -most - 1, most));
}

int MicroMachine::run(int limit) {
    std::size_t at = 0;
    for (int cycles = 1; cycles <= limit; ++cycles) {
        const MicroInstruction& i = program_.instructions.at(at++);
        switch (i.op) {
            case Op::constant:  // held since the machine was made: no cycle
                --cycles;
                break;
            case Op::move:
                set(i.target, values_[i.a]);
                break;
            case Op::add:
                set(i.target, values_[i.a] + values_[i.b]);
                break;
            case Op::subtract:
                set(i.target, values_[i.a] - values_[i.b]);
                break;
            case Op::least:
                set(i.target, std::min(values_[i.a], values_[i.b]));
                break;
            case Op::most:
                set(i.target, std::max(values_[i.a], values_[i.b]));
                break;
            case Op::load:
                accumulator_ = __int128(values_[i.a]) * (__int128(1) << i.shift);
                break;
            case Op::take_off:
                accumulator_ += __int128(i.value) * values_[i.a] * (__int128(1) << i.shift);
                break;
            case Op::clear:
                accumulator_ = 0;
                break;
            case Op::absolute:
                set(i.target, values_[i.a] < 0 ? -values_[i.a] : values_[i.a]);
                break;
            case Op::count:
                if (values_[i.a] <= 0)
                    throw std::logic_error("microprogram " + program_.name + ": log2 of no number");
                set(i.target, __builtin_clzll(std::uint64_t(values_[i.a])) - 63);
                break;
            case Op::low:
                set(i.target, values_[i.a] & ((std::int64_t(1) << i.shift) - 1));
                break;
            case Op::table: {
                const auto& line =
                    program_.tables[i.table_index].lines.at(std::size_t(values_[i.a] >> i.shift));
                set(i.target, line.start);
                set(i.b, line.rise);
                break;
            }
            case Op::multiply:
                for (const auto& p : i.products) {
                    const __int128 product = __int128(part(p.a, p.a_part, program_.datapath.first_bits)) *
                                             part(p.b, p.b_part, program_.datapath.second_bits) *
                                             (__int128(1) << p.shift);
                    accumulator_ += p.negative ? -product : product;
                }
                break;
            case Op::round:
                set(i.target, rounded(i.shift - (i.shifts_by ? int(values_[i.b]) : 0),
                                      program_.registers[i.target].bits,
                                      i.nearest || program_.rounding == Rounding::nearest));
                break;
            case Op::jump:
                at = i.to;
                break;
            case Op::jump_less:
                if (values_[i.a] < values_[i.b]) at = i.to;
                break;
            case Op::jump_negative:
                if (values_[i.a] < 0) at = i.to;
                break;
            case Op::jump_minus:
                if (accumulator_ < 0) at = i.to;
                break;
            case Op::jump_zero:
                if (values_[i.a] == 0) at = i.to;
                break;
            case Op::end:
                return cycles - 1;  // the last instruction's successor is told by a bit of its own
        }
        accumulator_bits_ = std::max(accumulator_bits_, bits_of(accumulator_));
    }
    throw std::logic_error("microprogram " + program_.name + " does not end");
}

Assembler::Assembler(std::string name, const Datapath& datapath, Rounding rounding) {
    program_.name = std::move(name);
    program_.datapath = datapath;
    program_.rounding = rounding;
}

MicroInstruction& Assembler::emit(Op op) {
    program_.instructions.emplace_back();
    program_.instructions.back().op = op;
    return program_.instructions.back();
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

void Assembler::same_fraction(RegisterIndex a, RegisterIndex b) const {
    const MicroRegister& x = program_.registers[a];
    const MicroRegister& y = program_.registers[b];
    if (x.fraction != y.fraction)
        throw std::logic_error("microprogram " + program_.name + ": " + x.name + " and " + y.name +
                               " have other last bits");
}

void Assembler::sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products,
                    RegisterIndex by) {
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
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = fraction - r[target].fraction;
    out.shifts_by = by != none;
    if (out.shifts_by) out.b = by;
}

void Assembler::sum_to_nearest(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products) {
    sum(target, c, products);
    program_.instructions.back().nearest = true;
}

void Assembler::half_sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products) {
    sum(target, c, products);
    ++program_.instructions.back().shift;
}

void Assembler::halve(RegisterIndex target, RegisterIndex a) {
    MicroInstruction& load = emit(Op::load);
    load.a = a;
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = 1;
}

void Assembler::reinterpret(RegisterIndex target, RegisterIndex a) {
    MicroInstruction& i = emit(Op::move);
    i.target = target;
    i.a = a;
}

void Assembler::absolute_of(RegisterIndex target, RegisterIndex a) {
    MicroInstruction& i = emit(Op::absolute);
    i.target = target;
    i.a = a;
}

void Assembler::move(RegisterIndex target, RegisterIndex a) {
    same_fraction(target, a);
    MicroInstruction& i = emit(Op::move);
    i.target = target;
    i.a = a;
}

void Assembler::add(RegisterIndex target, RegisterIndex a, RegisterIndex b) {
    same_fraction(a, b);
    same_fraction(target, a);
    MicroInstruction& i = emit(Op::add);
    i.target = target;
    i.a = a;
    i.b = b;
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
    MicroInstruction& load = emit(Op::load);
    load.a = a;
    MicroInstruction& out = emit(Op::round);
    out.target = target;
    out.shift = program_.registers[a].fraction - program_.registers[target].fraction;
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

void Assembler::count(RegisterIndex target, RegisterIndex a) {
    MicroInstruction& i = emit(Op::count);
    i.target = target;
    i.a = a;
}

void Assembler::low(RegisterIndex target, RegisterIndex a, int bits) {
    MicroInstruction& i = emit(Op::low);
    i.target = target;
    i.a = a;
    i.shift = bits;
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

void Assembler::label(const std::string& name) {
    if (!labels_.emplace(name, program_.instructions.size()).second)
        throw std::logic_error("microprogram " + program_.name + " has two labels " + name);
}

void Assembler::jump_to(Op op, RegisterIndex a, RegisterIndex b, const std::string& to) {
    jumps_.emplace_back(program_.instructions.size(), to);
    MicroInstruction& i = emit(op);
    i.a = a;
    i.b = b;
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
        part.shift = fraction - r[order[i].a].fraction;
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
