// Words and numbers of an NFF text, one at a time.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "scenes/text_source.hpp"

namespace raycell {

/// The entity that is being read, for messages.
struct Entity {
    std::string_view word;
    std::size_t line = 0;
};

/// Splits a text at white space; '#' starts a comment to the end of the line. Constant memory.
class TokenReader {
  public:
    enum class Kind { end, word, number };  ///< number: looks like one, but may be malformed

    /// Reads the first token. Throws InputError as TextSource does, and for a token of more than 256
    /// characters.
    explicit TokenReader(TextSource source);

    Kind kind() const { return kind_; }
    std::string_view text() const { return {buffer_.data(), size_}; }

    /// Line of the current token; at the end of the file, that of the last one.
    std::size_t line() const { return token_line_; }
    const std::string& file() const { return source_.name(); }

    void advance();

    /// Takes the current token as a number. Throws InputError if it is none; `expected` describes it in the
    /// message.
    double number(const Entity& entity, std::string_view expected);

    /// Takes the current token as a whole number from `low` to `high`. Throws InputError if it is none.
    long long integer(const Entity& entity, std::string_view expected, long long low, long long high);

    /// "'p' in line 7".
    static std::string describe(const Entity& entity);

    /// Throws InputError at the current token: "'p' in line 7: found 's'; expected ...".
    [[noreturn]] void fail(const Entity& entity, std::string_view expected) const;

  private:
    void skip_comment();

    TextSource source_;
    std::array<char, 256> buffer_{};
    std::size_t size_ = 0;
    std::size_t token_line_ = 1;
    Kind kind_ = Kind::end;
};

}  // namespace raycell
