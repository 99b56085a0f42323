// The readers' messages to the user: one error that ends the reading, and warnings that do not.
#pragma once

#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raycell {

/// The input can't be used. The message is one line, "FILE:LINE: what; expected what", without raw bytes of
/// the input.
struct InputError : std::runtime_error {
    /// `line` counts from 1; 0 stands for the whole file, and no line is printed.
    InputError(const std::string& file, std::size_t line, const std::string& what,
               const std::string& expected);
};

/// A word of the input in printable form: at most `limit` characters, all but printable ASCII escaped.
std::string printable(std::string_view word, std::size_t limit = 40);

/// Collects warnings. Of each kind the first few are kept and the rest only counted, so that a file with a
/// million faults gives a handful of lines.
class Diagnostics {
  public:
    static constexpr std::size_t shown_of_a_kind = 5;

    /// `kind` groups the warnings of a file. Of each kind at most `shown` are kept; the last of them gives
    /// the number of those left out.
    void warn(const std::string& file, std::size_t line, const std::string& kind, const std::string& text,
              std::size_t shown = shown_of_a_kind);

    /// Adds information that is no fault: "FILE: note: ...".
    void note(const std::string& file, const std::string& text);

    /// "FILE:LINE: warning: ..." in order of appearance; meant for standard error.
    std::vector<std::string> messages() const;

    /// Number of warnings, including those left out of messages(), without notes.
    std::size_t warning_count() const { return warnings_; }

    /// Number of warnings of one kind, in all files.
    std::size_t count_of(const std::string& kind) const;

  private:
    struct Kind {
        std::size_t count = 0;
        std::size_t last_line = 0;
        std::size_t last_shown = 0;  ///< index into messages_
        std::size_t shown = 0;
    };
    std::vector<std::string> messages_;
    std::map<std::pair<std::string, std::string>, Kind> kinds_;  ///< by kind and file
    std::size_t warnings_ = 0;
};

}  // namespace raycell
