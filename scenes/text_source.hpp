// Characters, lines and numbers of a text file, for all readers.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/diagnostics.hpp"

namespace raycell {

/// Largest magnitude of a scene's numbers: products of four lengths still fit a double.
constexpr double max_magnitude = 1e30;

enum class NumberFault { none, malformed, not_finite, too_large };

/// Reads a decimal number that fills the whole word, in any locale. Hexadecimal, nan, inf and numbers beyond
/// max_magnitude are faults; a number too small for a double becomes 0.
NumberFault parse_number(std::string_view word, double& value);

/// What parse_number expected, for messages.
const char* describe(NumberFault fault);

/// Reads a text character by character, in constant memory. LF, CRLF and CR all end a line and are returned
/// as '\n'; a UTF-8 byte order mark is skipped. Throws InputError for a NUL byte, UTF-16 or a read error.
class TextSource {
  public:
    static constexpr int end = -1;

    /// Opens a regular file. Throws InputError if it can't be read or is a directory or a device.
    explicit TextSource(const std::filesystem::path& path);

    /// Reads from memory; `text` must outlive this. `name` stands for the file in messages.
    TextSource(std::string_view text, std::string name);

    /// The next character, '\n' at each line end, or `end`.
    int get() {
        if (next_ == last_ && !refill()) return end;
        const char c = *next_++;
        if (c == '\n' || c == '\r' || c == '\0') return unusual(c);
        return static_cast<unsigned char>(c);
    }

    /// Line of the next character, from 1.
    std::size_t line() const { return line_; }

    /// The file's name as messages print it.
    const std::string& name() const { return name_; }

  private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    bool refill();
    int unusual(char c);
    void skip_mark();

    std::string name_;
    std::unique_ptr<std::FILE, Close> file_;
    std::vector<char> buffer_;
    const char* next_ = nullptr;
    const char* last_ = nullptr;
    std::size_t line_ = 1;
};

/// A path as messages print it: control characters escaped, the rest as the user wrote it.
std::string printable_path(const std::filesystem::path& path);

}  // namespace raycell
