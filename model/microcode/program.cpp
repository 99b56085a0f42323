#include "model/microcode/program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/numbers/bits.hpp"
#include "model/numbers/fixed.hpp"

namespace raycell {
namespace {

using Op = MicroInstruction::Op;

constexpr const char* op_names[] = {"constant",  "move",          "add",       "subtract",   "least",
                                    "most",      "load",          "add to",    "clear",      "absolute",
                                    "count",     "low",           "high",      "bit",        "fetch",
                                    "store",     "table",         "multiply",  "round",      "jump",
                                    "jump less", "jump negative", "jump zero", "jump minus", "end"};

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

int MicroProgram::words() const {
    return int(std::count_if(instructions.begin(), instructions.end(),
                             [](const MicroInstruction& i) { return i.op != Op::constant; }));
}

int MicroProgram::instruction_bits() const {
    const int operation = 5;
    const int address = bits_for(std::int64_t(registers.size()));
    const int shift = 7;
    const int variants = 2;  // shifted by a register, the rounding that is not the machine's
    const int jump = bits_for(words());
    // A target or the place of a jump, two operands of each multiplier, which parts of them and the sign.
    return operation + std::max(address, jump) + datapath.multipliers * (2 * (address + 2) + 1) + shift +
           variants;
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
            case Op::high:
                text += " " + reg(i.target) + " = " + reg(i.a) + " >> " + std::to_string(i.shift);
                break;
            case Op::bit:
                text += " " + reg(i.target) + " = bit " + reg(i.b) + " of " + reg(i.a);
                break;
            case Op::fetch:
            case Op::store:
                text += " " + reg(i.target) + ", " + reg(i.a) + " + " + reg(i.b);
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
    for (RegisterIndex i = 0; i < program.registers.size(); ++i) {
        names_.emplace(program.registers[i].name, i);
        most_.push_back((Value(1) << (program.registers[i].bits - 1)) - 1);
    }
    for (const MicroInstruction& i : program.instructions) {
        if (i.op == Op::constant) set(i.target, i.value);
    }
}

MicroMachine::Value MicroMachine::checked(RegisterIndex index, Value value) const {
    if (value > most_[index] || ~value > most_[index]) {
        const MicroRegister& r = program_.registers[index];
        throw std::logic_error("microprogram " + program_.name + ": " + std::to_string(double(value)) +
                               " does not fit the " + std::to_string(r.bits) + " bits of " + r.name);
    }
    return value;
}

int MicroMachine::accumulator_bits() const { return bits_of(accumulator_used_); }

void MicroMachine::put(const std::string& name, double value) {
    const RegisterIndex index = names_.at(name);
    const double word = scale_by(value, program_.registers[index].fraction);
    if (word != std::floor(word))
        throw std::logic_error("microprogram " + program_.name + ": no word for " + name);
    set(index, std::int64_t(word));
}

double MicroMachine::take(const std::string& name) const {
    const RegisterIndex index = names_.at(name);
    return scale_by(double(values_[index]), -program_.registers[index].fraction);
}

MicroMachine::Value MicroMachine::part(RegisterIndex index, int number, int width) const {
    const int step = width - 1;
    const bool last = number + 1 == parts_of(program_.registers[index].bits, width);
    const Value rest = values_[index] >> (number * step);
    return last ? rest : rest & ((Value(1) << step) - 1);
}

/// The accumulator / 2^shift, to the nearest (ties to even) or cut off, saturated to `bits` bits.
MicroMachine::Value MicroMachine::rounded(int shift, int bits, bool nearest) const {
    const __int128 most = (__int128(1) << (bits - 1)) - 1;
    __int128 value = accumulator_;
    if (shift < 0) {
        // Beyond every register: saturates, whatever is shifted in.
        if (value != 0 && bits_of(value) - shift > 120) return value > 0 ? most : -most - 1;
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
    return std::clamp(value, -most - 1, most);
}

/// The register that a fetch or a store selects.
RegisterIndex MicroMachine::element(const MicroInstruction& instruction) const {
    const Value number = values_[instruction.b];
    if (number < 0 || number >= Value(program_.arrays.at(instruction.a)))
        throw std::logic_error("microprogram " + program_.name + ": " +
                               program_.registers[instruction.a].name + " has no register " +
                               std::to_string(std::int64_t(number)) + " after it");
    return instruction.a + RegisterIndex(number);
}

int MicroMachine::run(int limit) {
    const auto write = [this](RegisterIndex index, Value value) { values_[index] = checked(index, value); };
    std::size_t at = 0;
    for (int cycles = 1; cycles <= limit; ++cycles) {
        const MicroInstruction& i = program_.instructions.at(at++);
        switch (i.op) {
            case Op::constant:  // held since the machine was made: no cycle
                --cycles;
                break;
            case Op::move:
                write(i.target, values_[i.a]);
                break;
            case Op::add:
                write(i.target, values_[i.a] + values_[i.b]);
                break;
            case Op::subtract:
                write(i.target, values_[i.a] - values_[i.b]);
                break;
            case Op::least:
                write(i.target, std::min(values_[i.a], values_[i.b]));
                break;
            case Op::most:
                write(i.target, std::max(values_[i.a], values_[i.b]));
                break;
            case Op::load:
                accumulator_ = values_[i.a] * (__int128(1) << i.shift);
                break;
            case Op::take_off:
                accumulator_ += Value(i.value) * values_[i.a] * (__int128(1) << i.shift);
                break;
            case Op::clear:
                accumulator_ = 0;
                break;
            case Op::absolute:
                write(i.target, values_[i.a] < 0 ? -values_[i.a] : values_[i.a]);
                break;
            case Op::count:
                if (values_[i.a] <= 0)
                    throw std::logic_error("microprogram " + program_.name + ": log2 of no number");
                write(i.target, 2 - bits_of(values_[i.a]));
                break;
            case Op::low:
                write(i.target, values_[i.a] & ((Value(1) << i.shift) - 1));
                break;
            case Op::high:
                write(i.target, values_[i.a] >> i.shift);
                break;
            case Op::bit:
                write(i.target, values_[i.a] >> int(values_[i.b]) & 1);
                break;
            case Op::fetch:
                write(i.target, values_[element(i)]);
                break;
            case Op::store:
                write(element(i), values_[i.target]);
                break;
            case Op::table: {
                const auto& line =
                    program_.tables[i.table_index].lines.at(std::size_t(values_[i.a] >> i.shift));
                write(i.target, line.start);
                write(i.b, line.rise);
                break;
            }
            case Op::multiply:
                for (const auto& p : i.products) {
                    const Value product = part(p.a, p.a_part, program_.datapath.first_bits) *
                                          part(p.b, p.b_part, program_.datapath.second_bits) *
                                          (Value(1) << p.shift);
                    accumulator_ += p.negative ? -product : product;
                }
                break;
            case Op::round:
                write(i.target, rounded(i.shift - (i.shifts_by ? int(values_[i.b]) : 0),
                                        program_.registers[i.target].bits,
                                        !i.down && (i.nearest || program_.rounding == Rounding::nearest)));
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
                return cycles - 1;  // fetched while the last instruction runs
        }
        accumulator_used_ |= accumulator_ < 0 ? ~accumulator_ : accumulator_;
    }
    throw std::logic_error("microprogram " + program_.name + " does not end");
}

}  // namespace raycell
