// What a study hands back: a table, where the method breaks, and what the program does about it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raycell::stability {

/// Columns are named for scripts, in small letters with the unit last: `leak_percent`, `error_cells`.
class Table {
  public:
    class Value {
      public:
        Value(std::string words) : words_(std::move(words)) {}
        Value(const char* words) : words_(words) {}
        Value(double number) : number_(number) {}
        Value(std::int64_t count) : words_(std::to_string(count)), counted_(true) {}
        bool is_words() const { return !words_.empty() && !counted_; }
        /// As text; numbers that are not counts get this many significant digits.
        std::string spelt(int digits) const;

      private:
        std::string words_;
        double number_ = 0;
        bool counted_ = false;
    };

    explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}
    /// Throws std::logic_error unless there is a value for every column.
    void add(std::vector<Value> row);

    /// Throws std::runtime_error naming the file if it can't be written.
    void write_csv(const std::filesystem::path& file) const;
    void print_markdown() const;

  private:
    std::vector<std::string> columns_;
    std::vector<std::vector<Value>> rows_;
};

struct Report {
    Table table;
    std::string boundary;   ///< one line, from the study's own data
    std::string treatment;  ///< one line: what the program does there
};

/// How much a study draws, and from which seed.
struct Effort {
    bool quick = false;
    std::uint64_t seed = 1;
    int samples(int full) const { return quick ? (full + 9) / 10 : full; }
};

/// printf of numbers and text into a string.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

}  // namespace raycell::stability
