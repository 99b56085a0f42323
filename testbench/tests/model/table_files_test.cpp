// The operators' tables as files for hardware (docs/reference/specification/tables).
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "model/numbers/operators.hpp"
#include "model/numbers/table_words.hpp"

namespace raycell {
namespace {

constexpr int word_bits = 20;
using Words = std::vector<std::uint64_t>;

/// The words of a file, as $readmemh reads them.
Words words_of_file(const std::string& name) {
    std::ifstream file(RAYCELL_SOURCE_DIR "/docs/reference/specification/tables/" + name);
    Words words;
    for (std::string line; std::getline(file, line);) {
        line = line.substr(0, line.find("//"));
        if (!line.empty()) words.push_back(std::stoull(line, nullptr, 16));
    }
    return words;
}

/// The starts of a table's lines and the end of the last.
void append(Words& words, const Operators::Table& table) {
    for (const Operators::Table::Line& line : table.lines) words.push_back(line.start);
}
std::uint64_t end_of(const Operators::Table& table) {
    return table.lines.back().start + std::uint64_t(table.lines.back().rise);
}

TEST(TableFiles, HoldTheTablesOfReciprocalAndRootThatTheOperatorsUse) {
    const Operators operators({}, word_bits, Rounding::nearest);
    Words reciprocal, root;
    append(reciprocal, operators.reciprocals());
    reciprocal.push_back(end_of(operators.reciprocals()));
    EXPECT_EQ(words_of_file("reciprocal.hex"), reciprocal);
    append(root, operators.roots(0));
    EXPECT_EQ(end_of(operators.roots(0)), operators.roots(1).lines.front().start);
    append(root, operators.roots(1));
    root.push_back(end_of(operators.roots(1)));
    EXPECT_EQ(words_of_file("root.hex"), root);
}

TEST(TableFiles, HoldTheTablesOfPowersThatTheOperatorsAreMadeOf) {
    const auto lines = std::uint64_t(table_sizes({}, word_bits).power);
    Words logarithm, exponential;
    for (std::uint64_t i = 0; i <= lines; ++i) {
        logarithm.push_back(table_word::logarithm(i, lines, word_bits - 1));
        exponential.push_back(table_word::exponential(i, lines, word_bits - 1));
    }
    EXPECT_EQ(words_of_file("log2.hex"), logarithm);
    EXPECT_EQ(words_of_file("exp2.hex"), exponential);
}

}  // namespace
}  // namespace raycell
