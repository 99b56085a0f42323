// Microprograms on integer words: instructions, an assembler, an interpreter.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "model/microcode/datapath.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// A register: a word of `bits` bits, two's complement, whose last bit is worth 2^-fraction.
struct MicroRegister {
    std::string name;
    int bits = 0;
    int fraction = 0;
};
using RegisterIndex = std::size_t;

/// One instruction: one cycle.
struct MicroInstruction {
    enum class Op : std::uint8_t {
        constant,   ///< target = value
        move,       ///< target = a
        add,        ///< target = a + b
        subtract,   ///< target = a − b
        least,      ///< target = the lesser of a and b
        most,       ///< target = the greater
        load,       ///< accumulator = a · 2^shift
        take_off,   ///< accumulator += value · a · 2^shift; value is 1 or -1
        clear,      ///< accumulator = 0
        absolute,   ///< target = |a|
        count,      ///< target = −floor(log2(a)), a > 0
        low,        ///< target = the last `shift` bits of a
        high,       ///< target = a / 2^shift, cut off
        bit,        ///< target = bit number b of a
        fetch,      ///< target = the register of the array a whose number is in b
        store,      ///< that register = target
        table,      ///< target, second target = the line of the table that a's bits from `shift` on select
        multiply,   ///< accumulator += the products
        round,      ///< target = accumulator / 2^shift, rounded and saturated; with `by`, / 2^(shift − by)
        jump,       ///< to `to`
        jump_less,  ///< to `to` if a < b
        jump_negative,  ///< to `to` if a < 0
        jump_zero,      ///< to `to` if a = 0
        jump_minus,     ///< to `to` if the accumulator < 0
        end
    };
    struct Product {
        RegisterIndex a = 0;
        int a_part = 0;
        RegisterIndex b = 0;
        int b_part = 0;
        int shift = 0;
        bool negative = false;
    };
    Op op = Op::end;
    RegisterIndex target = 0;
    RegisterIndex a = 0;
    RegisterIndex b = 0;
    std::int64_t value = 0;
    bool nearest = false;  ///< round: to the nearest, whatever the machine's rounding
    bool down = false;     ///< round: cut off, whatever the machine's rounding
    int shift = 0;
    bool shifts_by = false;  ///< round: by register b, too
    std::size_t table_index = 0;
    std::size_t to = 0;
    std::vector<Product> products;
};

/// A table of lines: where each starts, and how much it rises to the next one's start.
struct MicroTable {
    std::string name;
    struct Line {
        std::int64_t start;
        std::int64_t rise;
    };
    std::vector<Line> lines;
};

/// A program for one datapath.
struct MicroProgram {
    std::string name;
    Datapath datapath;
    Rounding rounding = Rounding::nearest;
    std::vector<MicroRegister> registers;
    std::vector<MicroInstruction> instructions;
    std::vector<MicroTable> tables;
    /// First register of each array, and how many it has.
    std::map<RegisterIndex, std::size_t> arrays;

    RegisterIndex find(const std::string& name) const;  ///< throws std::out_of_range
    /// Bits of all registers.
    int register_bits() const;
    /// Instructions in the memory. A constant is a register that nothing writes: it is none of them.
    int words() const;
    /// Bits of an instruction: operation, registers, shift, where to jump; and of all of them.
    int instruction_bits() const;
    int memory_bits() const { return instruction_bits() * words(); }
    /// A line for each instruction.
    std::string listing() const;
};

/// Runs a program. Every value must fit its register, and the accumulator its bits, else std::logic_error: a
/// datapath of these widths could not hold it.
class MicroMachine {
  public:
    /// `program` must outlive it.
    using Value = __int128;  ///< of a register: up to 127 bits

    explicit MicroMachine(const MicroProgram& program);
    void set(RegisterIndex index, std::int64_t value) { values_[index] = checked(index, value); }
    std::int64_t get(RegisterIndex index) const { return std::int64_t(values_[index]); }
    /// Of all registers.
    const std::vector<Value>& values() const { return values_; }
    /// The same by name, as numbers: a register's raw word times its last bit.
    void put(const std::string& name, double value);
    double take(const std::string& name) const;
    /// Runs to the end and returns the cycles. Throws std::logic_error beyond `limit` cycles.
    int run(int limit = 100000);
    /// Bits of the accumulator that were needed so far, over all runs.
    int accumulator_bits() const;

  private:
    Value part(RegisterIndex index, int number, int width) const;
    Value rounded(int shift, int bits, bool nearest) const;
    RegisterIndex element(const MicroInstruction& instruction) const;
    Value checked(RegisterIndex index, Value value) const;

    const MicroProgram& program_;
    std::unordered_map<std::string, RegisterIndex> names_;
    std::vector<Value> most_;  ///< of each register
    std::vector<Value> values_;
    Value accumulator_ = 0;
    Value accumulator_used_ = 0;  ///< every bit that an accumulator had so far, the sign left out
};

/// Writes a program: registers by name, sums of products cut to the datapath's multipliers, labels.
class Assembler {
  public:
    Assembler(std::string name, const Datapath& datapath, Rounding rounding);

    RegisterIndex reg(const std::string& name, int bits, int fraction);
    /// A register that holds a number for ever.
    RegisterIndex constant(const std::string& name, std::int64_t value, int bits, int fraction);

    /// `count` registers of one format beside each other, "name 0" and so on; an address register selects.
    RegisterIndex array(const std::string& name, std::size_t count, int bits, int fraction);
    /// The same of numbers that never change.
    RegisterIndex constants(const std::string& name, const std::vector<std::int64_t>& values, int bits,
                            int fraction);
    /// target = the array's register of this number.
    void fetch(RegisterIndex target, RegisterIndex array, RegisterIndex number);
    /// The array's register of this number = a.
    void store(RegisterIndex array, RegisterIndex number, RegisterIndex a);

    struct Factor {
        RegisterIndex a;
        RegisterIndex b;
        bool negative = false;
    };
    /// target = c + the products, rounded once. `c` may be `none`. With `by`, a register that holds a whole
    /// number, all of it counts 2^by times as much.
    void sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products,
             RegisterIndex by = none);
    /// The same, rounded to the nearest whatever the machine's rounding: so are accumulators kept.
    void sum_to_nearest(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products);
    /// The same, cut off whatever the machine's rounding: so are lines computed while loading.
    void sum_down(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products);
    /// target = half of c + the products, rounded once.
    void half_sum(RegisterIndex target, RegisterIndex c, const std::vector<Factor>& products);
    void move(RegisterIndex target, RegisterIndex a);
    void add(RegisterIndex target, RegisterIndex a, RegisterIndex b);
    void subtract(RegisterIndex target, RegisterIndex a, RegisterIndex b);
    void least(RegisterIndex target, RegisterIndex a, RegisterIndex b);
    void most(RegisterIndex target, RegisterIndex a, RegisterIndex b);
    /// target = a, rounded and saturated to the target's format.
    void round(RegisterIndex target, RegisterIndex a);

    /// The same, cut off whatever the machine's rounding.
    void round_down(RegisterIndex target, RegisterIndex a);
    int fraction(RegisterIndex a) const { return program_.registers[a].fraction; }

    /// target = a − b, whose last bits need not be the same.
    void difference(RegisterIndex target, RegisterIndex a, RegisterIndex b);

    /// target = a · 2^by, rounded; `by` holds a whole number, and fractions are as of whole numbers.
    void scale(RegisterIndex target, RegisterIndex a, RegisterIndex by, int shift);
    void absolute(RegisterIndex target, RegisterIndex a);
    /// The same for whole numbers: last bits are taken as 1.
    void absolute_of(RegisterIndex target, RegisterIndex a);
    /// target has a's bits; what its last bit is worth changes.
    void reinterpret(RegisterIndex target, RegisterIndex a);
    /// target = a / 2, a even and whole.
    void halve(RegisterIndex target, RegisterIndex a);
    void count(RegisterIndex target, RegisterIndex a);
    void low(RegisterIndex target, RegisterIndex a, int bits);
    /// target = a / 2^shift, cut off; last bits are taken as 1.
    void high(RegisterIndex target, RegisterIndex a, int shift);
    void bit(RegisterIndex target, RegisterIndex a, RegisterIndex number);
    /// The start and the rise of a table's line, selected by a's bits from `shift` on.
    void table(RegisterIndex start, RegisterIndex rise, const MicroTable& lines, RegisterIndex a, int shift);

    /// target = rest · 2^digits / by, cut off, digit by digit; 0 <= rest < by, and rest is lost. All are
    /// taken as whole numbers; `one` holds 1. Four instructions a digit, of which two or four are run.
    void divide(const std::string& name, RegisterIndex target, RegisterIndex rest, RegisterIndex by,
                int digits, RegisterIndex one);

    void label(const std::string& name);
    void jump(const std::string& to);
    void jump_less(RegisterIndex a, RegisterIndex b, const std::string& to);
    void jump_negative(RegisterIndex a, const std::string& to);
    void jump_zero(RegisterIndex a, const std::string& to);
    /// target = a · 2^shift + b, all whole.
    void join(RegisterIndex target, RegisterIndex a, int shift, RegisterIndex b);
    /// target = the accumulator, whose last bit becomes the target's.
    void keep(RegisterIndex target);
    /// target = (whole + part) · 2^by, rounded.
    void scale_sum(RegisterIndex target, RegisterIndex whole, RegisterIndex part, RegisterIndex by);
    /// To `to` if a·b + c < 0.
    void jump_product_negative(RegisterIndex c, RegisterIndex a, RegisterIndex b, const std::string& to);
    /// To `to` if the sum of the terms is negative, however their last bits differ.
    struct Term {
        RegisterIndex a;
        bool negative = false;
        int shift = 0;  ///< counts 2^shift times as much
    };
    void jump_sum_negative(const std::vector<Term>& terms, const std::string& to);
    void end();

    /// Throws std::logic_error for a jump to nowhere.
    MicroProgram finish();
    static constexpr RegisterIndex none = ~RegisterIndex(0);

  private:
    /// What an instruction does not use is 0.
    MicroInstruction& emit(MicroInstruction::Op op, RegisterIndex target = 0, RegisterIndex a = 0,
                           RegisterIndex b = 0);
    /// accumulator = c + the products; returns its fraction bits.
    int accumulate(RegisterIndex c, const std::vector<Factor>& products);
    void jump_to(MicroInstruction::Op op, RegisterIndex a, RegisterIndex b, const std::string& to);
    void same_fraction(RegisterIndex a, RegisterIndex b) const;

    MicroProgram program_;
    std::map<std::string, std::size_t> labels_;
    std::vector<std::pair<std::size_t, std::string>> jumps_;
};

}  // namespace raycell
