#include "testbench/microcode/image.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "model/numbers/bits.hpp"

namespace raycell {
namespace {

using Op = MicroInstruction::Op;
using Value = MicroMachine::Value;

/// The operations by their names in SystemVerilog. Constants are not among them.
const std::vector<std::pair<Op, const char*>> operations = {{Op::end, "END"},
                                                            {Op::move, "MOVE"},
                                                            {Op::add, "ADD"},
                                                            {Op::subtract, "SUBTRACT"},
                                                            {Op::least, "LEAST"},
                                                            {Op::most, "MOST"},
                                                            {Op::load, "LOAD"},
                                                            {Op::take_off, "ADD_TO"},
                                                            {Op::clear, "CLEAR"},
                                                            {Op::absolute, "ABSOLUTE"},
                                                            {Op::count, "COUNT"},
                                                            {Op::low, "LOW"},
                                                            {Op::high, "HIGH"},
                                                            {Op::bit, "BIT"},
                                                            {Op::fetch, "FETCH"},
                                                            {Op::store, "STORE"},
                                                            {Op::table, "TABLE"},
                                                            {Op::multiply, "MULTIPLY"},
                                                            {Op::round, "ROUND"},
                                                            {Op::jump, "JUMP"},
                                                            {Op::jump_less, "JUMP_LESS"},
                                                            {Op::jump_negative, "JUMP_NEGATIVE"},
                                                            {Op::jump_zero, "JUMP_ZERO"},
                                                            {Op::jump_minus, "JUMP_MINUS"}};

std::int64_t code_of(Op op) {
    for (std::size_t i = 0; i < operations.size(); ++i) {
        if (operations[i].first == op) return std::int64_t(i);
    }
    throw std::logic_error("an operation has no code");
}

bool jumps(Op op) {
    return op == Op::jump || op == Op::jump_less || op == Op::jump_negative || op == Op::jump_zero ||
           op == Op::jump_minus;
}

/// Bits of a two's complement number.
int signed_bits(std::int64_t value) { return 1 + bits_for((value < 0 ? ~value : value) + 1); }

int address_bits(std::size_t count) { return std::max(1, bits_for(std::int64_t(count))); }

/// The largest magnitude of an operand's part.
long double part_size(int bits, int number, int width) {
    const int step = width - 1;
    return std::exp2l(number + 1 == parts_of(bits, width) ? bits - 1 - number * step : step);
}

}  // namespace

MicroImage::MicroImage(std::vector<const MicroProgram*> programs, bool apart)
    : programs_(std::move(programs)) {
    for (const MicroProgram* p : programs_) {
        if (p->datapath.multipliers != 1)
            throw std::invalid_argument("the datapath " + p->datapath.name + " has " +
                                        std::to_string(p->datapath.multipliers) +
                                        " multipliers; expected one of one multiplier");
        bases_.push_back(apart ? registers_ : 0);
        registers_ = std::max(registers_, bases_.back() + p->registers.size());
    }
    place();
    measure();
    lay_out();
}

/// Gives every instruction and every table its place.
void MicroImage::place() {
    for (const MicroProgram* p : programs_) {
        entries_.push_back(instructions_);
        places_.emplace_back();
        for (const MicroInstruction& i : p->instructions) {
            places_.back().push_back(instructions_);
            if (i.op != Op::constant) ++instructions_;
        }
        for (const MicroTable& table : p->tables) {
            if (std::find(table_names_.begin(), table_names_.end(), table.name) != table_names_.end())
                continue;
            table_names_.push_back(table.name);
            table_bases_.push_back(lines_.size());
            lines_.insert(lines_.end(), table.lines.begin(), table.lines.end());
        }
    }
}

/// The widths that all programs fit.
void MicroImage::measure() {
    long double most = 1;
    register_bits_ = programs_.front()->datapath.first_bits;  // an operand is part of a register
    for (const MicroProgram* p : programs_) {
        long double size = 0;  // of the accumulator, whatever the registers hold
        const auto bits = [&](RegisterIndex r) { return p->registers[r].bits; };
        for (const MicroRegister& r : p->registers) register_bits_ = std::max(register_bits_, r.bits);
        for (const MicroInstruction& i : p->instructions) {
            const long double loaded = std::exp2l(bits(i.a) - 1 + std::max(i.shift, 0));
            if (i.op == Op::clear) size = 0;
            if (i.op == Op::load) size = loaded;
            if (i.op == Op::take_off) size += loaded;
            for (const auto& f : i.products) {
                size += part_size(bits(f.a), f.a_part, p->datapath.first_bits) *
                        part_size(bits(f.b), f.b_part, p->datapath.second_bits) * std::exp2l(f.shift);
                part_bits_ = std::max({part_bits_, bits_for(f.a_part + 1), bits_for(f.b_part + 1)});
                shift_bits_ = std::max(shift_bits_, signed_bits(f.shift));
            }
            most = std::max(most, size);
            shift_bits_ = std::max(shift_bits_, signed_bits(i.shift));
            if (i.op == Op::round && i.shifts_by) number_bits_ = std::max(number_bits_, bits(i.b));
        }
    }
    accumulator_bits_ = int(std::floor(std::log2l(most))) + 2;
    address_bits_ = address_bits(registers_);
    place_bits_ = address_bits(instructions_);
    line_address_bits_ = address_bits(lines_.size());
    for (const MicroTable::Line& line : lines_)
        line_bits_ = std::max({line_bits_, signed_bits(line.start), signed_bits(line.rise)});
}

void MicroImage::share(const std::vector<MicroImage*>& images) {
    for (int MicroImage::*width :
         {&MicroImage::register_bits_, &MicroImage::number_bits_, &MicroImage::part_bits_,
          &MicroImage::shift_bits_, &MicroImage::address_bits_, &MicroImage::place_bits_,
          &MicroImage::line_address_bits_, &MicroImage::line_bits_}) {
        int most = 0;
        for (const MicroImage* image : images) most = std::max(most, image->*width);
        for (MicroImage* image : images) image->*width = most;
    }
    for (MicroImage* image : images) image->lay_out();
}

void MicroImage::lay_out() {
    const int reg = address_bits_;
    const int place = place_bits_;
    const int extra = std::max(bits_for(register_bits_ + 1), line_address_bits_);
    int low = 0;
    fields_.clear();
    for (const auto& [name, bits] :
         std::vector<std::pair<const char*, int>>{{"OPERATION", bits_for(std::int64_t(operations.size()))},
                                                  {"TARGET", std::max(reg, place)},
                                                  {"A", reg},
                                                  {"B", reg},
                                                  {"SHIFT", shift_bits_},
                                                  {"BY", 1},
                                                  {"NEAREST", 1},
                                                  {"NEGATIVE", 1},
                                                  {"A_PART", part_bits_},
                                                  {"A_LAST", 1},
                                                  {"B_PART", part_bits_},
                                                  {"B_LAST", 1},
                                                  {"EXTRA", extra}}) {
        fields_.push_back({name, low, bits});
        low += bits;
    }
}

std::string MicroImage::hexadecimal(Value value, int bits) {
    std::string text;
    for (int low = (bits + 3) / 4 * 4 - 4; low >= 0; low -= 4) {
        const int digit_bits = std::min(4, bits - low);
        text += "0123456789abcdef"[std::size_t(value >> low & ((1 << digit_bits) - 1))];
    }
    return text;
}

std::string MicroImage::encoded(std::size_t program, const MicroInstruction& i) const {
    const MicroProgram& p = *programs_[program];
    const RegisterIndex base = bases_[program];
    std::map<std::string, std::int64_t> value;
    value["OPERATION"] = code_of(i.op);
    value["TARGET"] = std::int64_t(jumps(i.op) ? places_[program].at(i.to) : base + i.target);
    value["A"] = std::int64_t(base + i.a);
    value["B"] = std::int64_t(base + i.b);
    value["SHIFT"] = i.shift;
    if (i.op == Op::round) {
        value["BY"] = i.shifts_by;
        value["NEAREST"] = !i.down && (i.nearest || p.rounding == Rounding::nearest);
        value["EXTRA"] = p.registers[i.target].bits;
    } else if (i.op == Op::take_off) {
        value["NEGATIVE"] = i.value < 0;
    } else if (i.op == Op::table) {
        const auto known = std::find(table_names_.begin(), table_names_.end(), p.tables[i.table_index].name);
        value["EXTRA"] = std::int64_t(table_bases_[std::size_t(known - table_names_.begin())]);
    } else if (i.op == Op::multiply) {
        const MicroInstruction::Product& f = i.products.at(0);
        const auto last = [&](RegisterIndex r, int part, int width) {
            return part + 1 == parts_of(p.registers[r].bits, width);
        };
        value["A"] = std::int64_t(base + f.a);
        value["B"] = std::int64_t(base + f.b);
        value["SHIFT"] = f.shift;
        value["NEGATIVE"] = f.negative;
        value["A_PART"] = f.a_part;
        value["A_LAST"] = last(f.a, f.a_part, p.datapath.first_bits);
        value["B_PART"] = f.b_part;
        value["B_LAST"] = last(f.b, f.b_part, p.datapath.second_bits);
    }
    Value word = 0;
    for (const Field& field : fields_) {
        const Value mask = (Value(1) << field.bits) - 1;
        word |= (Value(value[field.name]) & mask) << field.low;
    }
    return hexadecimal(word, instruction_bits());
}

std::string MicroImage::instruction_file() const {
    std::string text;
    for (std::size_t p = 0; p < programs_.size(); ++p) {
        text += "// " + programs_[p]->name + "\n";
        for (const MicroInstruction& i : programs_[p]->instructions) {
            if (i.op != Op::constant) text += encoded(p, i) + "\n";
        }
    }
    return text;
}

std::string MicroImage::table_file() const {
    std::string text;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        for (std::size_t t = 0; t < table_bases_.size(); ++t) {
            if (table_bases_[t] == i) text += "// " + table_names_[t] + "\n";
        }
        const Value mask = (Value(1) << line_bits()) - 1;
        text += hexadecimal(Value(lines_[i].start) << line_bits() | (Value(lines_[i].rise) & mask),
                            2 * line_bits()) +
                "\n";
    }
    // A memory needs a word.
    return lines_.empty() ? hexadecimal(0, 2 * line_bits()) + "\n" : text;
}

std::string MicroImage::register_file() const {
    std::string text;
    for (std::size_t p = 0; p < programs_.size(); ++p) {
        for (const std::int64_t value : initial_values(p)) text += hexadecimal(value, register_bits_) + "\n";
    }
    return text;
}

std::vector<std::int64_t> MicroImage::initial_values(std::size_t program) const {
    std::vector<std::int64_t> values(programs_[program]->registers.size(), 0);
    for (const MicroInstruction& i : programs_[program]->instructions) {
        if (i.op == Op::constant) values[i.target] = i.value;
    }
    return values;
}

std::string MicroImage::package() const {
    std::string text =
        "// Written by microcode_tb: widths, sizes and the encoding of the microprograms beside this file.\n"
        "package microcode;\n"
        "  // verilator lint_off UNUSEDPARAM\n";
    const auto number = [&](const std::string& name, std::size_t value) {
        text += "  localparam int " + name + " = " + std::to_string(value) + ";\n";
    };
    number("WORD_BITS", std::size_t(word_bits()));
    number("OPERAND_BITS", std::size_t(programs_.front()->datapath.first_bits));
    number("REGISTER_BITS", std::size_t(register_bits_));
    number("ACCUMULATOR_BITS", std::size_t(accumulator_bits_));
    number("REGISTERS", registers_);
    number("REGISTER_ADDRESS_BITS", std::size_t(address_bits_));
    number("INSTRUCTIONS", instructions_);
    number("INSTRUCTION_ADDRESS_BITS", std::size_t(place_bits_));
    number("INSTRUCTION_BITS", std::size_t(instruction_bits()));
    number("LINES", std::max<std::size_t>(lines_.size(), 1));
    number("LINE_ADDRESS_BITS", std::size_t(line_address_bits_));
    number("LINE_BITS", std::size_t(line_bits()));
    number("NUMBER_BITS", std::size_t(number_bits_));
    for (const Field& field : fields_) {
        number(field.name + "_LOW", std::size_t(field.low));
        number(field.name + "_BITS", std::size_t(field.bits));
    }
    const int code_bits = fields_.front().bits;
    for (const auto& [op, name] : operations)
        text += "  localparam logic [" + std::to_string(code_bits - 1) + ":0] " + name + " = " +
                std::to_string(code_bits) + "'d" + std::to_string(code_of(op)) + ";\n";
    return text + "endpackage\n";
}

std::string name_in_file(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '/'; }, '_');
    return name;
}

}  // namespace raycell
