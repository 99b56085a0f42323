#include "testbench/golden/words.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

namespace raycell {
namespace {

constexpr double most_integer = 0x1p53;

[[noreturn]] void refuse(const std::string& text, const char* expected) {
    throw GoldenError("'" + text.substr(0, 60) + "': expected " + expected);
}

std::int64_t whole(const std::string& text, const char* expected) {
    std::int64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || stop != end || error != std::errc()) refuse(text, expected);
    return value;
}

/// Reads mantissa:exponent.
std::pair<std::int64_t, int> read_pair(const std::string& text) {
    constexpr const char* expected = "mantissa:exponent, the exponent from -1000 to 1000";
    const auto colon = text.find(':');
    if (colon == std::string::npos) refuse(text, expected);
    const auto mantissa = whole(text.substr(0, colon), expected);
    const auto exponent = whole(text.substr(colon + 1), expected);
    if (std::abs(double(mantissa)) > most_integer || std::abs(double(exponent)) > 1000)
        refuse(text, expected);
    return {mantissa, int(exponent)};
}

bool is_hexadecimal(const std::string& text) {
    return text.find('x') != std::string::npos || text.find("inf") != std::string::npos;
}

bool is_integer(double x) { return std::abs(x) <= most_integer && std::nearbyint(x) == x; }

}  // namespace

std::vector<std::string> tokens_of(const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> tokens;
    for (std::string word; words >> word;) tokens.push_back(word);
    return tokens;
}

std::string Words::hexadecimal(double value) {
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    char text[64];
    std::snprintf(text, sizeof text, "%a", value);
    return text;
}

double Words::read_hexadecimal(const std::string& text) {
    constexpr const char* expected = "a hexadecimal floating-point number as 0x1.8p-3, or inf";
    if (text == "inf") return std::numeric_limits<double>::infinity();
    if (text == "-inf") return -std::numeric_limits<double>::infinity();
    if (text.find_first_not_of("0123456789abcdefxp.+-") != std::string::npos) refuse(text, expected);
    char* stop = nullptr;
    const double value = std::strtod(text.c_str(), &stop);
    if (text.find('x') == std::string::npos || *stop != '\0' || !std::isfinite(value)) refuse(text, expected);
    return value;
}

std::string Words::word(const Format& format, double value) const {
    const double integer = value / format.step();
    if (arithmetic_.exact() || !is_integer(integer)) return hexadecimal(value);
    return std::to_string(std::int64_t(integer));
}

double Words::read_word(const Format& format, const std::string& text) const {
    double value = 0;
    if (is_hexadecimal(text)) {
        value = read_hexadecimal(text);
    } else {
        const auto integer = whole(text, "a word's integer");
        if (std::abs(double(integer)) > most_integer) refuse(text, "a word's integer, below 2^53");
        value = double(integer) * format.step();
    }
    // Some room: what never travels may have more bits than its message.
    if (!arithmetic_.exact() && !(std::abs(value) <= 16 * format.most()))
        refuse(text, "a number that is not far outside its format");
    return value;
}

std::string Words::floating(int bits, double value) const {
    if (arithmetic_.exact() || std::isinf(value)) return hexadecimal(value);
    if (value == 0) return "0:0";
    const int exponent = exponent_of(value);
    const double mantissa = scale_by(value, bits - 1 - exponent);
    if (!is_integer(mantissa)) return hexadecimal(value);
    return std::to_string(std::int64_t(mantissa)) + ":" + std::to_string(exponent);
}

std::string Words::reciprocal(double value) const {
    int exponent = 0;
    const double mantissa = std::ldexp(std::frexp(std::abs(value), &exponent), formats().word_bits - 1);
    if (arithmetic_.exact() || !is_integer(mantissa)) return hexadecimal(std::abs(value));
    return std::to_string(std::int64_t(mantissa)) + ":" + std::to_string(exponent);
}

std::string Words::reach(double value) const {
    if (!arithmetic_.exact() && value == formats().reach.most()) return "inf";
    return word(formats().reach, value);
}

double Words::read_floating(int bits, const std::string& text) const {
    if (is_hexadecimal(text)) return read_hexadecimal(text);
    const auto [mantissa, exponent] = read_pair(text);
    return scale_by(double(mantissa), exponent - bits + 1);
}

double Words::read_reciprocal(const std::string& text) const {
    const double size = read_floating(formats().word_bits, text);
    if (std::signbit(size)) refuse(text, "a number without a sign: its sign is the direction's");
    return size;
}

double Words::read_reach(const std::string& text) const {
    return text == "inf" ? read_hexadecimal(text) : read_word(formats().reach, text);
}

}  // namespace raycell
