// Microprograms against the functions of the model, bit for bit, and what runs them.
#include <gtest/gtest.h>

#include <cmath>

#include "../property.hpp"
#include "testbench/microcode/counts.hpp"
#include "testbench/microcode/trial_lists.hpp"

namespace raycell {
namespace {

#ifdef RAYCELL_SANITIZED
constexpr std::uint64_t inputs = 40;  // of each seed: this build is slow
constexpr std::uint64_t recounts = 1000;
/// How far a count of fewer inputs than the table's may be off.
double recount_room(std::uint32_t cycles) { return 4 + 0.02 * cycles; }
#else
constexpr std::uint64_t inputs = 250;
constexpr std::uint64_t recounts = 20000;
double recount_room(std::uint32_t) { return 0; }
#endif

class MicrocodeOf : public testing::TestWithParam<int> {};

TEST_P(MicrocodeOf, EveryProgramEqualsTheModelOnEveryDatapath) {
    MicroSetting setting;
    setting.numbers.word_bits = GetParam();
    setting.extent = {128, 100, 170.3, 0.25};
    for (const Rounding rounding : {Rounding::nearest, Rounding::truncate}) {
        for (const Iteration method : {Iteration::newton, Iteration::table, Iteration::rounded}) {
            setting.numbers.rounding = rounding;
            setting.numbers.operators.reciprocal = setting.numbers.operators.root = method;
            setting.numbers.operators.power = method == Iteration::newton  ? PowerMethod::tables
                                              : method == Iteration::table ? PowerMethod::schlick
                                                                           : PowerMethod::rounded;
            for (const Datapath& datapath : datapaths(GetParam(), widest_operand(setting.formats()))) {
                setting.datapath = datapath;
                for (const auto& trial : micro_trials(setting)) {
                    // Programs without operators are the same whatever their methods.
                    if (method != Iteration::newton && !trial->cost().has_operators()) continue;
                    for (const std::uint64_t seed : property::seeds(1, 4)) {
                        SCOPED_TRACE(property::rerun(seed));
                        const MicroTally tally = run_trial(*trial, inputs, seed);
                        EXPECT_GT(tally.least, 0);
                    }
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Words, MicrocodeOf, testing::Values(8, 9, 12, 16, 20, 24, 27, 32),
                         [](const auto& words) { return "of_" + std::to_string(words.param) + "_bits"; });

/// Depths finer than their last bit, loading words coarser than a unit word's last bit, a single cell.
TEST(Microcode, EqualsTheModelInArraysOfOtherShapes) {
    for (const ArrayExtent& extent : {ArrayExtent{3, 2, 60, 0.001}, ArrayExtent{1, 1, 1, 1.0 / 65536},
                                      ArrayExtent{8, 8, 60000, 1}, ArrayExtent{2048, 16, 3000, 3}}) {
        for (const int bits : {8, 12, 20, 32}) {
            MicroSetting setting;
            setting.numbers.word_bits = bits;
            setting.extent = extent;
            setting.datapath = datapaths(bits, widest_operand(setting.formats()))[0];
            for (const auto make : {micro_trials, loading_variants}) {
                for (const auto& trial : make(setting)) run_trial(*trial, inputs, 1);
            }
        }
    }
}

TEST(Microcode, AProgramThatWasAlteredIsFoundOut) {
    MicroSetting setting;
    setting.extent = {128, 128, 200, 0.2};
    setting.datapath = datapaths(20, widest_operand(setting.formats()))[0];
    MicroProgram walk = walk_program(setting, 200);
    ASSERT_GT(walk.instructions.size(), 20u);
    // Every single shift that rounds matters: altered by one, some input shows it.
    std::size_t roundings = 0;
    for (std::size_t i = 0; i < walk.instructions.size(); ++i) {
        if (walk.instructions[i].op != MicroInstruction::Op::round) continue;
        ++roundings;
        MicroProgram altered = walk;
        ++altered.instructions[i].shift;
        EXPECT_TRUE(walk_differs(setting, altered, 2000)) << "instruction " << i;
    }
    EXPECT_GE(roundings, 5u);
    EXPECT_FALSE(walk_differs(setting, walk, 2000));
}

TEST(Microcode, OperandsWiderThanAMultiplierAreCutIntoParts) {
    EXPECT_EQ(parts_of(20, 20), 1);
    EXPECT_EQ(parts_of(21, 20), 2);
    EXPECT_EQ(parts_of(39, 20), 2);
    EXPECT_EQ(parts_of(40, 20), 3);
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Datapath path{"any", "", random.whole(1, 3), random.whole(4, 20), random.whole(4, 20)};
        Assembler assembler("product", path, Rounding::nearest);
        const int bits_a = random.whole(4, 30);
        const int bits_b = random.whole(4, 30);
        const RegisterIndex a = assembler.reg("a", bits_a, 0);
        const RegisterIndex b = assembler.reg("b", bits_b, 0);
        const RegisterIndex product = assembler.reg("product", 62, 0);
        assembler.sum(product, Assembler::none, {{a, b}});
        assembler.end();
        const MicroProgram program = assembler.finish();
        MicroMachine machine(program);
        const auto any = [&](int bits) {
            const std::int64_t most = (std::int64_t(1) << (bits - 1)) - 1;
            return random.chance(0.2)   ? -most - 1
                   : random.chance(0.2) ? most
                                        : std::int64_t(random.uniform(-1, 1) * double(most));
        };
        const std::int64_t x = any(bits_a);
        const std::int64_t y = any(bits_b);
        machine.set(a, x);
        machine.set(b, y);
        const int cycles = machine.run();
        EXPECT_EQ(machine.get(product), x * y);
        EXPECT_EQ(cycles, 2 + (path.products(bits_a, bits_b) + path.multipliers - 1) / path.multipliers);
    }
}

TEST(Microcode, AValueThatDoesNotFitItsRegisterIsAnError) {
    Assembler assembler("sum", datapaths(20, 30)[0], Rounding::nearest);
    const RegisterIndex a = assembler.reg("a", 8, 0);
    assembler.add(a, a, a);
    assembler.end();
    const MicroProgram program = assembler.finish();
    MicroMachine machine(program);
    machine.set(a, 63);
    EXPECT_EQ(machine.run(), 1);
    EXPECT_EQ(machine.get(a), 126);
    EXPECT_THROW(machine.run(), std::logic_error);
    EXPECT_THROW(machine.set(a, 128), std::logic_error);
    Assembler endless("endless", datapaths(20, 30)[0], Rounding::nearest);
    endless.label("again");
    endless.jump("again");
    const MicroProgram loop = endless.finish();
    EXPECT_THROW(MicroMachine(loop).run(), std::logic_error);
    Assembler nowhere("nowhere", datapaths(20, 30)[0], Rounding::nearest);
    nowhere.jump("there");
    EXPECT_THROW(nowhere.finish(), std::logic_error);
}

TEST(Microcode, TheCostTableOfEveryDatapathIsWhatItsProgramsCount) {
    for (const auto& [name, basis] : {std::pair<const char*, CostBasis>{"word", CostBasis::word},
                                      {"wide", CostBasis::wide},
                                      {"two", CostBasis::two}}) {
        const CostTable table(basis);
        const auto counts = count_costs(name, recounts, 1);
        EXPECT_EQ(counts.size(), CostTable::counted().size());
        for (const auto& [entry, member] : CostTable::entries()) {
            const auto counted = counts.find(entry);
            if (counted == counts.end()) {
                EXPECT_EQ(table.*member, CostTable(CostBasis::estimate).*member) << entry;
            } else {
                EXPECT_NEAR(table.*member, counted->second, recount_room(counted->second))
                    << name << " " << entry;
            }
        }
    }
}

TEST(Microcode, ADivisionDigitByDigitIsTheQuotientCutOff) {
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const int digits = random.whole(1, 40);
        const int bits = random.whole(2, 45);
        Assembler assembler("quotient", datapaths(20, 30)[0], Rounding::nearest);
        const RegisterIndex rest = assembler.reg("rest", bits + 2, 0);
        const RegisterIndex by = assembler.reg("by", bits + 1, 0);
        const RegisterIndex quotient = assembler.reg("quotient", digits + 1, 0);
        const RegisterIndex one = assembler.constant("1", 1, 2, 0);
        assembler.divide("quotient", quotient, rest, by, digits, one);
        assembler.end();
        const MicroProgram program = assembler.finish();
        MicroMachine machine(program);
        const auto divisor = std::int64_t(std::exp2(random.uniform(0, bits)));
        const auto dividend = std::int64_t(random.uniform(0, 1) * double(divisor));
        machine.set(rest, dividend);
        machine.set(by, divisor);
        const int cycles = machine.run();
        EXPECT_EQ(machine.get(quotient), std::int64_t((__int128(dividend) << unsigned(digits)) / divisor));
        EXPECT_GE(cycles, 2 + 2 * digits);
        EXPECT_LE(cycles, 2 + 4 * digits);
    }
}

TEST(Microcode, ANumberBeyondAnArrayIsAnErrorAndASumMayBeCutOffWhateverTheRounding) {
    Assembler assembler("array", datapaths(20, 30)[0], Rounding::nearest);
    const RegisterIndex first = assembler.array("word", 3, 8, 2);
    const RegisterIndex after = assembler.reg("after", 8, 2);
    const RegisterIndex number = assembler.reg("number", 4, 0);
    const RegisterIndex whole = assembler.reg("whole", 8, 0);
    assembler.fetch(after, first, number);
    assembler.round_down(whole, after);
    assembler.store(first, number, after);
    assembler.end();
    const MicroProgram program = assembler.finish();
    MicroMachine machine(program);
    machine.put("word 1", -1.25);
    machine.put("word 2", 3.75);
    machine.set(number, 1);
    machine.run();
    EXPECT_EQ(machine.take("whole"), -2);
    machine.set(number, 2);
    machine.run();
    EXPECT_EQ(machine.take("whole"), 3);
    for (const int beyond : {3, -1}) {
        machine.set(number, beyond);
        EXPECT_THROW(machine.run(), std::logic_error);
    }
}

TEST(Microcode, OfAPowerThatTheModelTakesFromALibraryThereIsNoProgram) {
    MicroSetting setting;
    setting.datapath = datapaths(20, 30)[0];
    setting.numbers.operators.power = PowerMethod::rounded;
    EXPECT_THROW(power_program(setting), std::invalid_argument);
}

TEST(Microcode, AnOperatorDigitByDigitTakesAsManyRoundsAsItsWordHasDigits) {
    int before = 0;
    for (const int bits : {8, 16, 24, 32}) {
        MicroSetting setting;
        setting.numbers.word_bits = bits;
        setting.datapath = datapaths(bits, widest_operand(setting.formats()))[0];
        setting.numbers.operators.reciprocal = Iteration::rounded;
        const MicroProgram program = reciprocal_program(setting);
        MicroMachine machine(program);
        machine.put("x", 0.75);
        const int cycles = machine.run();
        if (before != 0) {
            EXPECT_NEAR(cycles - before, 8 * 5, 8) << bits << " bits";
        }
        before = cycles;
    }
}

TEST(Microcode, ABitOfARegisterAndWhatIsAboveItsLastBits) {
    Assembler assembler("bits", datapaths(20, 30)[0], Rounding::nearest);
    const RegisterIndex word = assembler.reg("word", 64, 0);
    const RegisterIndex number = assembler.reg("number", 8, 0);
    const RegisterIndex bit = assembler.reg("bit", 2, 0);
    const RegisterIndex above = assembler.reg("above", 64, 0);
    assembler.bit(bit, word, number);
    assembler.high(above, word, 4);
    assembler.end();
    const MicroProgram program = assembler.finish();
    MicroMachine machine(program);
    for (const std::int64_t value : {std::int64_t(0x5a), std::int64_t(-37), std::int64_t(1) << 62}) {
        for (int i = 0; i < 64; ++i) {
            machine.set(word, value);
            machine.set(number, i);
            EXPECT_EQ(machine.run(), 2);
            EXPECT_EQ(machine.get(bit), value >> i & 1);
            EXPECT_EQ(machine.get(above), value >> 4);
        }
    }
}

}  // namespace
}  // namespace raycell
