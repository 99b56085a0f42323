// Files of golden vectors in tests: their lines and words, altered ones, and their replay.
#pragma once

#include <algorithm>
#include <sstream>

#include "../property.hpp"
#include "program.hpp"

namespace raycell::system_test {

inline Words records(const Workshop& workshop) {
    Words files;
    for (const std::string& name : workshop.results()) {
        if (contains(name, ".golden_") && contains(name, ".txt"))
            files.push_back(workshop.result(name).string());
    }
    return files;
}

inline Finished replay(const Workshop& workshop, const Words& files, const Words& more = {}) {
    return workshop.run_program(RAYCELL_CELL_TB, joined(joined({"--replay"}, files), more));
}

/// The lines of one record; its events begin at `first`.
struct Vectors {
    std::vector<std::string> lines;
    std::size_t first = 0;
};

inline std::vector<std::string> lines_of(const std::string& path) {
    std::vector<std::string> lines;
    std::istringstream in(read_text(path));
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

inline Vectors read_vectors(const std::string& path) {
    Vectors v{lines_of(path), 0};
    v.first = std::size_t(std::find(v.lines.begin(), v.lines.end(), "begin") - v.lines.begin()) + 1;
    return v;
}

inline std::string text_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

inline Words split(const std::string& line) {
    std::istringstream in(line);
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

/// The words that count: what stands behind a semicolon is a remark.
inline Words counted(const std::string& line) { return split(line.substr(0, line.find(';'))); }

constexpr std::size_t bits_at = 5;  ///< place of the bits in a line `in` or `out`
inline bool has_bits(const Words& words) { return words.size() > bits_at && words[bits_at] != "-"; }

/// The same digits but for one.
inline std::string other_bits(std::string digits, property::Random& random) {
    char& digit = digits[std::size_t(random.whole(0, int(digits.size()) - 1))];
    digit = digit == '5' ? 'a' : '5';
    return digits;
}

/// Another value of the same kind: a number or mantissa increased by one, or another word.
inline std::string other(const std::string& word) {
    if (word.find_first_not_of("-0123456789") == std::string::npos)
        return std::to_string(std::stoll(word) + 1);
    if (word.find_first_not_of("-0123456789:") == std::string::npos)
        return std::to_string(std::stoll(word) + 1) + word.substr(word.find(':'));
    return word == "inf" ? "1" : word == "shadow" ? "memo" : "shadow";
}

}  // namespace raycell::system_test
