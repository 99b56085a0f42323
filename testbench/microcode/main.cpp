// microcode_tb: the cell's microprograms: equal to the model, and how long, how wide, how large they are.
#include <iomanip>
#include <iostream>
#include <sstream>
#include <systemc>

#include "testbench/common/entry.hpp"
#include "testbench/common/options.hpp"
#include "testbench/microcode/counts.hpp"
#include "testbench/microcode/export.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

struct Options {
    NumberSettings numbers;
    ArrayExtent extent{128, 128, 200, 0.2};
    std::uint64_t runs = 10000;
    std::uint64_t seed = 1;
    std::string datapath;
    std::string listing;
    std::string folder;
    std::string programs;
    bool progress = false;
    bool costs = false;
};

void add_options(OptionTable& table, Options& o) {
    table.group("Numbers");
    table.number("word-bits", o.numbers.word_bits, 8, 32, "bits of a word");
    table.choice("rounding", o.numbers.rounding,
                 {{"nearest", Rounding::nearest}, {"truncate", Rounding::truncate}},
                 "words: to the nearest, ties to even, or cut off");
    const std::vector<std::pair<std::string, Iteration>> iterations = {
        {"newton", Iteration::newton}, {"table", Iteration::table}, {"rounded", Iteration::rounded}};
    table.choice("reciprocal", o.numbers.operators.reciprocal, iterations,
                 "1/x: a table and one Newton step, the table alone, or digit by digit");
    table.choice("root", o.numbers.operators.root, iterations, "1/sqrt(x), in the same ways");
    table.choice("power", o.numbers.operators.power,
                 {{"tables", PowerMethod::tables}, {"schlick", PowerMethod::schlick}},
                 "Phong's power: by log2 and exp2 tables, or Schlick's fraction");
    table.size("cells", o.extent.width, o.extent.height,
               "the array, whose size decides how wide a distance is");
    table.number("cube-depth", o.extent.depth, 1.0, 65536.0, "depth of the cube, cells: how wide a depth is");
    table.group("Microprograms");
    table.number("runs", o.runs, std::uint64_t(1), std::uint64_t(1) << 40, "random inputs of each program");
    table.number("seed", o.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1, "of the inputs");
    table.text("datapath", o.datapath, "NAME", "word, wide or two alone; empty: all");
    table.flag(
        "costs", o.costs,
        "counts the entries of the cost table instead, at words of 20 bits and 128x128 cells, and prints "
        "them beside the table");
    table.flag("progress", o.progress, "says on standard error which programs are done");
    table.text("listing", o.listing, "PROGRAM", "prints the instructions of this program, too");
    table.text(
        "export", o.folder, "FOLDER",
        "writes the programs of a datapath of one multiplier (word, if --datapath says none) and --runs "
        "vectors of each there instead, for hardware");
    table.text("programs", o.programs, "NAMES", "with --export: these alone, commas between them");
}

std::string one_digit(double value) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << value;
    return text.str();
}

/// Tries every program of a datapath, and prints a row of each.
void try_all(const MicroSetting& setting, const Options& o, bool& listed) {
    for (const auto& trial : micro_trials(setting)) {
        const MicroTally tally = run_trial(*trial, o.runs, o.seed);
        if (o.progress)
            std::cerr << setting.datapath.name << " " << trial->program().name << ": " << o.runs
                      << " inputs\n";
        const MicroProgram& p = trial->program();
        std::cout << "| " << setting.datapath.name << " | " << p.name << " | `" << trial->cost_name()
                  << "` | " << table_cycles(CostTable(CostBasis::estimate), *trial) << " | " << tally.least
                  << " | " << one_digit(tally.mean) << " | " << tally.most << " | " << p.registers.size()
                  << " | " << p.register_bits() << " | " << trial->accumulator_bits() << " | " << p.words()
                  << " | " << p.memory_bits() << " |\n";
    }
    if (o.listing.empty()) return;
    for (const auto& trial : micro_trials(setting)) {
        if (trial->program().name != o.listing) continue;
        std::cout << "\n"
                  << o.listing << " on " << setting.datapath.name << ", instructions:\n\n"
                  << trial->program().listing() << "\n";
        listed = true;
    }
}

/// Every counted entry, by datapath: counted, and in the table.
void print_costs(const Options& o) {
    const std::vector<std::pair<std::string, CostBasis>> bases = {
        {"word", CostBasis::word}, {"wide", CostBasis::wide}, {"two", CostBasis::two}};
    std::vector<std::map<std::string, std::uint32_t>> counts;
    std::cout << "| entry | estimate |";
    for (const auto& basis : bases) {
        counts.push_back(count_costs(basis.first, o.runs, o.seed));
        std::cout << " " << basis.first << " | in the table |";
    }
    std::cout << "\n|---|---|---|---|---|---|---|---|\n";
    for (const auto& [name, member] : CostTable::entries()) {
        if (counts[0].count(name) == 0) continue;
        std::cout << "| `" << name << "` | " << CostTable(CostBasis::estimate).*member << " |";
        for (std::size_t i = 0; i < bases.size(); ++i)
            std::cout << " " << counts[i].at(name) << " | " << CostTable(bases[i].second).*member << " |";
        std::cout << "\n";
    }
}

int run(const Options& o) {
    if (o.costs) {
        print_costs(o);
        return exit_done;
    }
    MicroSetting setting{o.numbers, o.extent, {}};
    const std::vector<Datapath> all = datapaths(o.numbers.word_bits, widest_operand(setting.formats()));
    std::string names;
    std::vector<Datapath> chosen;
    for (const Datapath& datapath : all) {
        names += (names.empty() ? "" : ", ") + datapath.name;
        if (o.datapath.empty() || o.datapath == datapath.name) chosen.push_back(datapath);
    }
    if (chosen.empty()) throw UsageError("--datapath: there is no '" + o.datapath + "'; expected " + names);
    if (!o.folder.empty()) {
        setting.datapath = chosen.front();
        try {
            std::cout << export_programs(setting, {o.folder, o.programs, o.runs, o.seed});
        } catch (const std::invalid_argument& error) {
            throw UsageError(error.what());
        }
        return exit_done;
    }
    if (!o.programs.empty()) throw UsageError("--programs is for --export");
    bool listed = o.listing.empty();
    std::cout << "Words of " << o.numbers.word_bits << " bits; " << o.runs
              << " random inputs of each program equal the model.\n\n";
    for (const Datapath& d : chosen) {
        std::cout << "- " << d.name << ": " << d.meaning << ", " << d.multipliers << " x (" << d.first_bits
                  << " x " << d.second_bits << " bits)\n";
    }
    std::cout << "\n| datapath | program | instead of | cycles, estimated | least | mean | most | "
                 "registers | bits | "
                 "accumulator, bits | instructions | bits of them |\n"
                 "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Datapath& datapath : chosen) {
        setting.datapath = datapath;
        try_all(setting, o, listed);
    }
    if (!listed) {
        std::string programs;
        for (const auto& trial : micro_trials(setting))
            programs += (programs.empty() ? "" : ", ") + trial->program().name;
        throw UsageError("--listing: there is no '" + o.listing + "'; expected one of " + programs);
    }
    return exit_done;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{"The cell's microprograms against the model, bit for bit; exit code 2 if one differs"};
    app.name("microcode_tb");
    OptionTable table(app);
    add_options(table, options);
    return parse_and_run(app, {argv + 1, argv + argc}, [&] {
        try {
            return run(options);
        } catch (const MicroDifference& difference) {
            std::cout.flush();
            std::cerr << "microcode_tb: " << difference.what() << '\n';
            return int(exit_comparison);
        }
    });
}

}  // namespace
}  // namespace raycell

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("microcode_tb", "fewer --runs", [&] { return raycell::run(argc, argv); });
}
