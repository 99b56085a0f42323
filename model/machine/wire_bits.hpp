// The bits of messages, and how values are written into their fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/numbers/fixed.hpp"

namespace raycell {

/// The bits of one message, first sent first.
class WireBits {
  public:
    /// Appends the low `width` bits of `value`, the most significant one first; 0 to 64.
    void put(std::uint64_t value, int width);
    /// Reads on where the last get() ended.
    std::uint64_t get(int width);
    /// The same for two's complement.
    void put_signed(std::int64_t value, int width) { put(std::uint64_t(value), width); }
    std::int64_t get_signed(int width);

    int size() const { return size_; }
    /// Number of bits read so far.
    int read() const { return read_; }
    /// Four bits a digit, the first bit sent on the left, filled with zeros at the end.
    std::string hex() const;

  private:
    std::vector<std::uint64_t> words_;
    int size_ = 0;
    int read_ = 0;
};

/// A field of a message's layout.
struct WireField {
    std::string name;
    int bits;
    std::string meaning;  ///< format or code
};

/// Appends a word of `format` in `width` bits, and reads one. Throws std::range_error naming the field for a
/// value that has no code.
void put_word(WireBits& bits, const char* name, double value, const Format& format, int width);
double get_word(WireBits& bits, const Format& format, int width);
/// Appends a whole number from 0 up, with the same error.
void put_number(WireBits& bits, const char* name, std::uint64_t value, int width);
/// Throws the error of a value that has no code.
[[noreturn]] void refuse_value(const char* name, double value, int bits);

}  // namespace raycell
