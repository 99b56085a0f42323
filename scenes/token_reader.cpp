#include "scenes/token_reader.hpp"

#include <cmath>
#include <utility>

namespace raycell {

namespace {

/// Includes Ctrl-Z, which ends a text in DOS.
bool is_space(int c) { return c == ' ' || c == '\n' || c == '\t' || c == '\f' || c == '\v' || c == 0x1a; }

/// True for any text that starts like a number, and for the words that C reads as numbers.
bool looks_like_number(std::string_view text) {
    const char c = text[0];
    if ((c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.') return true;
    std::string lower;
    for (const char letter : text.substr(0, 8)) {
        lower += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    return lower == "nan" || lower == "inf" || lower == "infinity" || lower.substr(0, 4) == "nan(";
}

}  // namespace

TokenReader::TokenReader(TextSource source) : source_(std::move(source)) { advance(); }

void TokenReader::skip_comment() {
    int c = source_.get();
    while (c != '\n' && c != TextSource::end) c = source_.get();
}

void TokenReader::advance() {
    int c = source_.get();
    while (is_space(c) || c == '#') {
        if (c == '#') skip_comment();
        c = source_.get();
    }
    size_ = 0;
    kind_ = Kind::end;
    if (c == TextSource::end) return;

    token_line_ = source_.line();
    while (c != TextSource::end && !is_space(c) && c != '#') {
        if (size_ == buffer_.size()) {
            throw InputError(file(), token_line_,
                             "a word of more than 256 characters: '" + printable(text()) + "'",
                             "an NFF word or number");
        }
        buffer_[size_++] = static_cast<char>(c);
        c = source_.get();
    }
    if (c == '#') skip_comment();
    kind_ = looks_like_number(text()) ? Kind::number : Kind::word;
}

double TokenReader::number(const Entity& entity, std::string_view expected) {
    if (kind_ != Kind::number) fail(entity, expected);
    double value = 0;
    const NumberFault fault = parse_number(text(), value);
    if (fault != NumberFault::none) {
        fail(entity, std::string(raycell::describe(fault)) + " as " + std::string(expected));
    }
    advance();
    return value;
}

long long TokenReader::integer(const Entity& entity, std::string_view expected, long long low,
                               long long high) {
    double value = 0;
    const bool whole = kind_ == Kind::number && parse_number(text(), value) == NumberFault::none &&
                       value == std::floor(value);
    if (!whole || value < static_cast<double>(low) || value > static_cast<double>(high))
        fail(entity, expected);
    advance();
    return static_cast<long long>(value);
}

std::string TokenReader::describe(const Entity& entity) {
    return "'" + std::string(entity.word) + "' in line " + std::to_string(entity.line);
}

void TokenReader::fail(const Entity& entity, std::string_view expected) const {
    const std::string found =
        kind_ == Kind::end ? std::string("the file ends") : "found '" + printable(text()) + "'";
    throw InputError(file(), token_line_, describe(entity) + ": " + found, std::string(expected));
}

}  // namespace raycell
