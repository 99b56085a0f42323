// Microprograms as words of a memory: the encoding that hardware reads.
#pragma once

#include <string>
#include <vector>

#include "model/microcode/program.hpp"

namespace raycell {

/// Programs of one datapath with one multiplier, one behind the other in one memory; tables that have the
/// same name are held once. Constants are no instructions: they are what their registers hold at the
/// beginning.
class MicroImage {
  public:
    /// `apart`: each program has registers of its own, in their order; else all begin at register 0. The
    /// programs must outlive it. Throws std::invalid_argument for a datapath of several multipliers.
    MicroImage(std::vector<const MicroProgram*> programs, bool apart);

    /// Makes every width, of instructions, registers and tables, that of the widest of some images, so that
    /// one package has the encoding of all: units with memories of their own in one design.
    static void share(const std::vector<MicroImage*>& images);

    /// Bits of an instruction, from `low` on.
    struct Field {
        std::string name;
        int low;
        int bits;
    };
    const std::vector<Field>& fields() const { return fields_; }
    int instruction_bits() const { return fields_.back().low + fields_.back().bits; }
    const std::vector<const MicroProgram*>& programs() const { return programs_; }
    /// Where a program begins in the memory, and which is its first register.
    std::size_t entry(std::size_t program) const { return entries_[program]; }
    RegisterIndex first_register(std::size_t program) const { return bases_[program]; }

    int word_bits() const { return programs_.front()->datapath.first_bits - 1; }
    std::size_t register_count() const { return registers_; }
    int register_bits() const { return register_bits_; }        ///< of the widest register
    int accumulator_bits() const { return accumulator_bits_; }  ///< enough for every value of the registers
    std::size_t instruction_count() const { return instructions_; }
    int entry_bits() const { return place_bits_; }  ///< of an instruction's place
    std::size_t table_lines() const { return lines_.size(); }
    int line_bits() const { return line_bits_; }  ///< of each of a line's two words

    /// A SystemVerilog package: the encoding and all widths.
    std::string package() const;
    /// Files for $readmemh: a word a line.
    std::string instruction_file() const;
    std::string table_file() const;
    /// What all registers hold at the beginning, of programs that are apart.
    std::string register_file() const;
    /// What the registers of a program hold at the beginning.
    std::vector<std::int64_t> initial_values(std::size_t program) const;
    /// A register's value as hexadecimal digits, all `bits` bits of it.
    static std::string hexadecimal(MicroMachine::Value value, int bits);

  private:
    void place();
    void measure();
    void lay_out();
    std::string encoded(std::size_t program, const MicroInstruction& instruction) const;

    std::vector<const MicroProgram*> programs_;
    std::vector<std::size_t> entries_;
    std::vector<RegisterIndex> bases_;
    /// Of each program: where each instruction stands in the memory.
    std::vector<std::vector<std::size_t>> places_;
    std::vector<std::string> table_names_;
    std::vector<std::size_t> table_bases_;
    std::vector<MicroTable::Line> lines_;
    std::vector<Field> fields_;
    std::size_t registers_ = 0;
    std::size_t instructions_ = 0;
    int register_bits_ = 1;
    int accumulator_bits_ = 1;
    int number_bits_ = 1;  ///< of registers that say how far to shift
    int part_bits_ = 1;
    int shift_bits_ = 1;    ///< two's complement
    int address_bits_ = 1;  ///< of a register's number
    int place_bits_ = 1;    ///< of an instruction's
    int line_address_bits_ = 1;
    int line_bits_ = 1;
};

/// A name without blanks, for files and fields.
std::string name_in_file(std::string name);

}  // namespace raycell
