// The layer between an OBJ or MTL file and tinyobjloader. tinyobjloader does not join continued lines, report
// malformed numbers, or know line numbers, so it is fed one checked line at a time.
#pragma once

#include <cstddef>
#include <set>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/text_source.hpp"

namespace raycell {

/// Logical lines: a backslash at the end of a line joins it to the next, except in comments.
class LineReader {
  public:
    static constexpr std::size_t max_length = 4 * 1024 * 1024;  ///< characters of a logical line

    explicit LineReader(TextSource source);

    /// Reads the next line, without its comment and without white space at its ends. False at the end of the
    /// file. Throws InputError as TextSource does, and for a line of more than max_length characters.
    bool next(std::string& line);

    /// Number of the file's line in which the current line starts, from 1.
    std::size_t line() const { return start_; }
    const std::string& file() const { return source_.name(); }

  private:
    TextSource source_;
    std::size_t start_ = 0;
};

/// Splits at white space; the views point into `line`.
std::vector<std::string_view> split(std::string_view line);

/// Kinds of warnings for unknown words: one for each of the first few words, one for all others, so that no
/// file gives a message for each of its lines.
class UnknownWords {
  public:
    static constexpr std::size_t most_named = 16;
    /// "unknown word 'x'", or "more unknown words".
    std::string kind(std::string_view word);

  private:
    std::set<std::string> named_;
};

/// The line without its first word.
std::string_view rest_of(std::string_view line);

/// A stream buffer that asks `next_line()` for text whenever its reader needs more; exceptions pass through.
/// It holds one line at a time, so the line number is known while the reader handles that line.
class LineFeed : public std::streambuf {
  protected:
    /// Puts the next checked line, with '\n', into `text`; false at the end.
    virtual bool next_line(std::string& text) = 0;

  private:
    int_type underflow() override;
    std::string text_;
};

}  // namespace raycell
