#include "testbench/stability/report.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace raycell::stability {

namespace {

/// A field of a CSV file: quoted if it contains a comma.
std::string quoted(const std::string& words) {
    return words.find(',') == std::string::npos ? words : '"' + words + '"';
}

}  // namespace

std::string Table::Value::spelt(int digits) const {
    if (!words_.empty()) return words_;
    char number[64];
    std::snprintf(number, sizeof number, "%.*g", digits, number_);
    return number;
}

void Table::add(std::vector<Value> row) {
    if (row.size() != columns_.size()) throw std::logic_error("a row does not match its table's columns");
    rows_.push_back(std::move(row));
}

void Table::write_csv(const std::filesystem::path& file) const {
    std::ofstream out(file);
    const auto line = [&](const auto& values, const auto& spell) {
        for (std::size_t i = 0; i < values.size(); ++i) out << (i ? "," : "") << spell(values[i]);
        out << '\n';
    };
    line(columns_, [](const std::string& name) { return name; });
    for (const auto& row : rows_) line(row, [](const Value& value) { return quoted(value.spelt(9)); });
    out.flush();
    if (!out) throw std::runtime_error("can't write " + file.string());
}

void Table::print_markdown() const {
    std::string head = "|";
    std::string rule = "|";
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        std::string name = columns_[i];
        std::replace(name.begin(), name.end(), '_', ' ');
        head += " " + name + " |";
        const bool words = !rows_.empty() && rows_.front()[i].is_words();
        rule += words ? "---|" : "---:|";
    }
    std::printf("%s\n%s\n", head.c_str(), rule.c_str());
    for (const auto& row : rows_) {
        std::string line = "|";
        for (const Value& value : row) line += " " + value.spelt(4) + " |";
        std::printf("%s\n", line.c_str());
    }
}

std::string text(const char* format, ...) {
    char buffer[1024];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(buffer, sizeof buffer, format, values);
    va_end(values);
    return buffer;
}

}  // namespace raycell::stability
