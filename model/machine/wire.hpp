// Rays and answers bit by bit, as the wires carry them (docs/reference/messages.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "model/machine/message.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// The bits of one message, first sent first.
class WireBits {
  public:
    static constexpr int most = 448;

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
    std::array<std::uint64_t, most / 64> words_{};
    int size_ = 0;
    int read_ = 0;
};

/// Type codes, the first three bits of a message.
enum class WireType : std::uint8_t { ray, shadow_ray, intensity, lit, blocked, postponed };

/// A field of a message's layout.
struct WireField {
    std::string name;
    int bits;
    std::string meaning;  ///< format or code
};

/// Packs and unpacks the messages of one machine in words. What a message does not carry is what its receiver
/// does not use or can tell from the rest: the ray's kind (from type, slot and child), a shadow ray's
/// generation and weight, a verdict's colour, `fresh` and `leaves_front` (only of use in the cell that sends
/// the ray). A ray's id is no part of the machine: statistics name rays by it, and it is the seed of a
/// back-off's jitter.
class Wire {
  public:
    /// Throws std::invalid_argument for exact arithmetic, whose numbers are no words.
    Wire(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats);

    /// Throws std::range_error naming the field for a value that has no code.
    WireBits pack(const Ray& ray) const;
    WireBits pack(const Answer& answer) const;
    /// The content of a message; its id is 0. `precast`: the phase, which tells what a verdict is for.
    Ray unpack_ray(WireBits bits, bool precast) const;
    Answer unpack_answer(WireBits bits, bool precast) const;

    /// The layouts, for documents and tests: of the messages ray, shadow_ray, intensity and verdict.
    std::vector<WireField> layout(WireType type) const;

  private:
    struct Address;  // home, slot, child
    void put_word(WireBits& bits, const char* name, double value, const Format& format, int width) const;
    void put_place(WireBits& bits, const Ray& ray) const;
    void get_place(WireBits& bits, Ray& ray) const;
    void put_reciprocal(WireBits& bits, const char* name, double value) const;
    double get_reciprocal(WireBits& bits, double direction) const;
    void put_address(WireBits& bits, int x, int y, std::uint32_t slot, bool of_pixel, unsigned child) const;
    std::uint32_t no_slot() const { return (1U << slot_bits_) - 1; }
    RayKind verdict_kind(bool precast) const;

    Formats formats_;
    Shadows shadows_;
    int x_bits_;
    int y_bits_;
    int slot_bits_;
};

}  // namespace raycell
