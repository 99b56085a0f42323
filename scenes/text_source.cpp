#include "scenes/text_source.hpp"

#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "model/files/input_file.hpp"

namespace raycell {

namespace {

constexpr std::size_t buffer_size = 64 * 1024;

/// Whether a number out of range is too small. std::from_chars does not tell; the decimal exponent of the
/// first significant digit does.
bool is_underflow(std::string_view word) {
    const std::size_t e = word.find_first_of("eE");
    const std::string_view mantissa = word.substr(0, e);
    long exponent = 0;
    if (e != std::string_view::npos) {
        std::string_view digits = word.substr(e + 1);
        const bool negative = !digits.empty() && digits[0] == '-';
        if (!digits.empty() && (digits[0] == '-' || digits[0] == '+')) digits.remove_prefix(1);
        const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
        if (result.ec != std::errc()) exponent = 1000000;
        if (negative) exponent = -exponent;
    }
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    const std::size_t first = mantissa.find_first_of("123456789");
    if (first == std::string_view::npos) return true;
    return static_cast<long>(point) - static_cast<long>(first) + exponent < 0;
}

}  // namespace

NumberFault parse_number(std::string_view word, double& value) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const last = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), last, value);
    if (error == std::errc::invalid_argument || stop != last) return NumberFault::malformed;
    if (error == std::errc::result_out_of_range) {
        if (!is_underflow(word)) return NumberFault::too_large;
        value = 0;
        return NumberFault::none;
    }
    if (!std::isfinite(value)) return NumberFault::not_finite;
    return std::abs(value) > max_magnitude ? NumberFault::too_large : NumberFault::none;
}

const char* describe(NumberFault fault) {
    switch (fault) {
        case NumberFault::not_finite:
            return "a finite number";
        case NumberFault::too_large:
            return "a number of magnitude 1e30 at most";
        default:
            return "a decimal number";
    }
}

std::string printable_path(const std::filesystem::path& path) {
    std::string out;
    for (const char c : path.string()) {
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
        out += control ? printable(std::string_view(&c, 1)) : std::string(1, c);
    }
    return out;
}

TextSource::TextSource(const std::filesystem::path& path) : name_(printable_path(path)) {
    const std::string fault = input_fault(path);
    if (!fault.empty()) throw InputError(name_, 0, fault, "a readable file");
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) {
        throw InputError(name_, 0, std::string("can't be opened: ") + std::strerror(errno),
                         "a readable file");
    }
    buffer_.resize(buffer_size);
    skip_mark();
}

TextSource::TextSource(std::string_view text, std::string name)
    : name_(std::move(name)), next_(text.data()), last_(text.data() + text.size()) {
    skip_mark();
}

bool TextSource::refill() {
    if (!file_) return false;
    const std::size_t count = std::fread(buffer_.data(), 1, buffer_.size(), file_.get());
    if (count == 0 && std::ferror(file_.get())) {
        throw InputError(name_, line_, std::string("can't be read on: ") + std::strerror(errno),
                         "a readable file");
    }
    next_ = buffer_.data();
    last_ = next_ + count;
    return count > 0;
}

int TextSource::unusual(char c) {
    if (c == '\0') throw InputError(name_, line_, "a NUL byte: this is no text file", "plain text");
    if (c == '\r' && (next_ != last_ || refill()) && *next_ == '\n') ++next_;
    ++line_;
    return '\n';
}

void TextSource::skip_mark() {
    if (next_ == last_ && !refill()) return;
    const std::string_view start(next_, static_cast<std::size_t>(last_ - next_));
    if (start.substr(0, 3) == "\xef\xbb\xbf") next_ += 3;
    if (start.substr(0, 2) == "\xff\xfe" || start.substr(0, 2) == "\xfe\xff") {
        throw InputError(name_, 1, "the text is encoded as UTF-16", "plain text (ASCII or UTF-8)");
    }
}

}  // namespace raycell
