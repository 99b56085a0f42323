// FNV-1a hash of schedules, pictures and saved arrays. Tests and documents pin its values as a sign of equal
// runs, so it must not change.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raycell {

class Fnv {
  public:
    /// Starts the hash with `start` instead of the usual value; schedules of cells start with 0.
    explicit Fnv(std::uint64_t start = 0xcbf29ce484222325ULL) : value_(start) {}
    void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3ULL; }
    void add_bytes(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) add(bytes[i]);
    }
    /// Mixes upper bits into lower ones, which multiplication never does.
    void fold(unsigned bits) { value_ ^= value_ >> bits; }
    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_;
};

}  // namespace raycell
