// operators_tb: measures the cell's operators over the whole range of their arguments and prints the table of
// their errors, storage and cycles as Markdown; or writes the operators' own tables for hardware.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/numbers/operators.hpp"
#include "model/numbers/table_words.hpp"
#include "model/settings/costs.hpp"
#include "testbench/common/version.hpp"

namespace {

using namespace raycell;

struct UsageError : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

constexpr std::int64_t most_samples = std::int64_t(1) << 20;

class Errors {
  public:
    void add(double value, double truth) {
        const double error = std::abs(value - truth);
        largest_ = std::max(largest_, error);
        sum_ += error;
        ++count_;
    }
    double largest() const { return largest_; }
    std::string bits() const {
        if (largest_ == 0) return "exact";
        char text[16];
        std::snprintf(text, sizeof text, "%.1f", -std::log2(largest_));
        return text;
    }
    double mean() const { return sum_ / double(count_); }

  private:
    double largest_ = 0;
    double sum_ = 0;
    std::int64_t count_ = 0;
};

/// Calls `visit` with the words from `first` to `last`, which have `fraction_bits`: with all words if they
/// are no more than a million, else with about a million, evenly spread. Both ends are always included.
template <class Visit>
void for_words(double first, double last, int fraction_bits, Visit visit) {
    const double step = scale_by(1, -fraction_bits);
    const auto from = std::int64_t(first / step);
    const auto to = std::int64_t(last / step);
    // Odd, so that the last bits vary too.
    const std::int64_t stride = to - from <= most_samples ? 1 : (to - from) / most_samples | 1;
    for (std::int64_t i = from; i < to; i += stride) visit(double(i) * step);
    visit(double(to) * step);
}

Errors reciprocal_errors(const Operators& operators, int word_bits) {
    Errors errors;
    for_words(1, 2, word_bits - 1, [&](double m) { errors.add(operators.reciprocal(m), 1 / m); });
    return errors;
}

Errors root_errors(const Operators& operators, int word_bits) {
    Errors errors;
    for_words(1, 4, word_bits - 2,
              [&](double m) { errors.add(operators.inverse_root(m), 1 / std::sqrt(m)); });
    return errors;
}

Errors power_errors(const Operators& operators, int word_bits, double least_base,
                    const std::vector<double>& exponents) {
    Errors errors;
    for (const double exponent : exponents) {
        for_words(least_base, 1, word_bits - 2, [&](double base) {
            errors.add(operators.power(base, exponent), std::pow(base, exponent));
        });
    }
    return errors;
}

Errors usual_power_errors(const Operators& operators, int word_bits) {
    return power_errors(operators, word_bits, 0, {1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1000, 1024});
}

/// Powers of smaller bases are 0 in any word.
Errors high_power_errors(const Operators& operators, int word_bits) {
    return power_errors(operators, word_bits, 1023.0 / 1024, {100000});
}

template <class Method>
struct Variant {
    const char* name;
    Method method;
    int tables;  ///< number that it needs
};

/// An operator, and the arguments over which it is measured.
template <class Method>
struct Measured {
    const char* name;
    const char* arguments;
    std::vector<Variant<Method>> variants;
    Method OperatorSettings::*method;
    int OperatorSettings::*entries;
    Errors (*errors_of)(const Operators&, int);
    std::uint32_t (CostTable::*cycles)(const OperatorSettings&) const;
};

/// Prints the lines of one operator: its methods, those with tables in several sizes. A table holds two words
/// per entry, its value and the difference to the next.
template <class Method>
void print_operator(const Measured<Method>& measured, int word_bits) {
    for (const Variant<Method>& variant : measured.variants) {
        for (const int size : {16, 32, 64, 128, 256}) {
            if (size > std::int64_t(1) << (word_bits - 1)) break;  // no more entries than there are mantissas
            OperatorSettings settings;
            settings.*measured.method = variant.method;
            settings.*measured.entries = size;
            const Operators operators(settings, word_bits, Rounding::nearest);
            const Errors errors = measured.errors_of(operators, word_bits);
            std::printf("| %s | %s | %s | %s | %.2e | %s | %.2e | %d | %u |\n", measured.name,
                        measured.arguments, variant.name,
                        variant.tables == 0 ? "-" : std::to_string(size).c_str(), errors.largest(),
                        errors.bits().c_str(), errors.mean(), variant.tables * size * 2 * word_bits,
                        unsigned((CostTable().*measured.cycles)(settings)));
            if (variant.tables == 0) break;
        }
    }
}

void print_table(int word_bits) {
    const std::vector<Variant<Iteration>> iterations = {
        {"table", Iteration::table, 1}, {"newton", Iteration::newton, 1}, {"rounded", Iteration::rounded, 0}};
    const std::vector<Variant<PowerMethod>> powers = {{"tables", PowerMethod::tables, 2},
                                                      {"schlick", PowerMethod::schlick, 0},
                                                      {"rounded", PowerMethod::rounded, 0}};
    std::printf(
        "Words of %d bits, rounded to the nearest.\n\n"
        "| operator | arguments | method | table (entries) | largest error (absolute) | largest error (bits) "
        "| mean error (absolute) | storage (bits) | time (cycles) |\n"
        "|---|---|---|---:|---:|---:|---:|---:|---:|\n",
        word_bits);
    const Measured<Iteration> reciprocal = {"1/x",
                                            "x 1 to 2",
                                            iterations,
                                            &OperatorSettings::reciprocal,
                                            &OperatorSettings::reciprocal_table,
                                            reciprocal_errors,
                                            &CostTable::reciprocal};
    const Measured<Iteration> root = {
        "1/sqrt(x)", "x 1 to 4",      iterations, &OperatorSettings::root, &OperatorSettings::root_table,
        root_errors, &CostTable::root};
    Measured<PowerMethod> power = {"b^n",
                                   "b 0 to 1, n 1 to 1024",
                                   powers,
                                   &OperatorSettings::power,
                                   &OperatorSettings::power_table,
                                   usual_power_errors,
                                   &CostTable::power};
    print_operator(reciprocal, word_bits);
    print_operator(root, word_bits);
    print_operator(power, word_bits);
    power.arguments = "b 1023/1024 to 1, n 100000";
    power.errors_of = high_power_errors;
    print_operator(power, word_bits);
}

/// Writes one table for $readmemh. Lines run from a word to the next, so there is one word more than lines.
template <class Word>
void write_table(const std::string& folder, const std::string& name, const std::string& curve, int lines,
                 int word_bits, Word word) {
    const std::string path = folder + "/" + name + ".hex";
    std::ofstream file(path);
    file << "// " << curve << ": " << lines << " lines, word i to word i + 1; words of " << word_bits
         << " bits, " << word_bits - 1 << " of them fraction bits\n";
    for (int i = 0; i <= lines; ++i) {
        char text[20];
        std::snprintf(text, sizeof text, "%05llx\n", static_cast<unsigned long long>(word(std::uint64_t(i))));
        file << text;
    }
    if (!file.flush()) throw std::runtime_error(path + ": it can't be written");
}

void write_tables(const std::string& folder, int word_bits) {
    const TableSizes sizes = table_sizes({}, word_bits);
    const int f = word_bits - 1;
    const auto octave = std::uint64_t(sizes.root / 2);
    const auto power = std::uint64_t(sizes.power);
    write_table(
        folder, "reciprocal", "1/m, m from 1 to 2", sizes.reciprocal, word_bits,
        [&](std::uint64_t i) { return table_word::reciprocal(i, std::uint64_t(sizes.reciprocal), f); });
    write_table(folder, "root", "1/sqrt(m), half of the lines from m = 1 to 2, half from 2 to 4", sizes.root,
                word_bits, [&](std::uint64_t i) {
                    return i < octave ? table_word::root(0, i, octave, f)
                                      : table_word::root(1, i - octave, octave, f);
                });
    write_table(folder, "log2", "log2(m), m from 1 to 2", sizes.power, word_bits,
                [&](std::uint64_t i) { return table_word::logarithm(i, power, f); });
    write_table(folder, "exp2", "2^x, x from 0 to 1; the last word, 2, takes one bit more", sizes.power,
                word_bits, [&](std::uint64_t i) { return table_word::exponential(i, power, f); });
}

const char* const help =
    "Usage: operators_tb [--word-bits N] [--tables DIR]\n"
    "Prints the cell's operators as a Markdown table: errors, storage and cycles of their methods.\n"
    "Arguments are all words from 1 to 2 (1/x), 1 to 4 (1/sqrt(x)) and 0 to 1 (b^n), of long words about a\n"
    "million, evenly spread. n is 1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1000 and 1024, and 100000 on lines "
    "of\n"
    "its own, with b from 1023/1024 on.\n"
    "Errors are absolute, of results up to 1; in bits: -log2 of the largest. Storage: two words per entry;\n"
    "b^n has two tables of that many entries, 1/sqrt(x) half of them over 1 to 2 and half over 2 to 4.\n"
    "schlick divides by 1/x (newton, 64 entries): its cycles are in, its table is not.\n"
    "  --word-bits N  length of a word, 8 to 32 (default 20)\n"
    "  --tables DIR   write the operators' tables into a folder instead, for $readmemh: reciprocal.hex, "
    "root.hex,\n"
    "                 log2.hex, exp2.hex\n"
    "  --version      what the program was built from\n"
    "  --help         this text\n";

int word_bits_in(const std::string& text) {
    int bits = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, bits);
    if (error != std::errc{} || stop != end || bits < 8 || bits > 32) {
        throw UsageError("--word-bits " + text + ": expected 8 to 32");
    }
    return bits;
}

void run(const std::vector<std::string>& arguments) {
    int word_bits = 20;
    std::string folder;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] == "--help") {
            std::printf("%s", help);
            return;
        }
        if (arguments[i] == "--version") {
            std::printf("operators_tb %s\n", version_text().c_str());
            return;
        }
        const bool tables = arguments[i] == "--tables";
        if (arguments[i] != "--word-bits" && !tables) {
            throw UsageError("unknown argument '" + arguments[i] +
                             "'; expected --word-bits N, --tables DIR, --help or --version");
        }
        if (i + 1 == arguments.size())
            throw UsageError(arguments[i] + (tables ? ": expected a folder" : ": expected 8 to 32"));
        ++i;
        if (tables) {
            folder = arguments[i];
        } else {
            word_bits = word_bits_in(arguments[i]);
        }
    }
    if (folder.empty()) {
        print_table(word_bits);
    } else {
        write_tables(folder, word_bits);
    }
}

/// Throws std::runtime_error if standard output can't be written.
void flush_output() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw std::runtime_error("standard output can't be written");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run({argv + 1, argv + argc});
        flush_output();
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "operators_tb: " << error.what() << '\n';
        return 1;
    }
}
