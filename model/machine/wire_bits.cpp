#include "model/machine/wire_bits.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace raycell {

void WireBits::put(std::uint64_t value, int width) {
    words_.resize(std::size_t(size_ + width + 63) / 64);
    for (int bit = width - 1; bit >= 0; --bit, ++size_) {
        if (value >> unsigned(bit) & 1) words_[std::size_t(size_ / 64)] |= 1ULL << unsigned(63 - size_ % 64);
    }
}

std::uint64_t WireBits::get(int width) {
    if (read_ + width > size_)
        throw std::length_error("a message of only " + std::to_string(size_) + " bits");
    std::uint64_t value = 0;
    for (int bit = 0; bit < width; ++bit, ++read_) {
        value = value << 1 | (words_[std::size_t(read_ / 64)] >> unsigned(63 - read_ % 64) & 1);
    }
    return value;
}

std::int64_t WireBits::get_signed(int width) {
    const std::uint64_t value = get(width);
    if (width == 0 || width == 64 || !(value >> unsigned(width - 1) & 1)) return std::int64_t(value);
    return std::int64_t(value) - (std::int64_t(1) << unsigned(width));
}

std::string WireBits::hex() const {
    constexpr const char* digits = "0123456789abcdef";
    std::string text;
    for (int at = 0; at < size_; at += 4) {
        text += digits[words_[std::size_t(at / 64)] >> unsigned(60 - at % 64) & 15];
    }
    return text;
}

void refuse_value(const char* name, double value, int bits) {
    std::ostringstream text;
    text.precision(17);
    text << "the field " << name << " of " << bits << " bits has no code for " << value;
    throw std::range_error(text.str());
}

void put_word(WireBits& bits, const char* name, double value, const Format& format, int width) {
    const double word = value / format.step();
    const double most = std::ldexp(1.0, width - 1);
    if (word != std::floor(word) || word < -most || word >= most) refuse_value(name, value, width);
    bits.put_signed(std::int64_t(word), width);
}

double get_word(WireBits& bits, const Format& format, int width) {
    return double(bits.get_signed(width)) * format.step();
}

void put_number(WireBits& bits, const char* name, std::uint64_t value, int width) {
    if (width < 64 && value >> unsigned(width) != 0) refuse_value(name, double(value), width);
    bits.put(value, width);
}

}  // namespace raycell
