// Rays and answers bit by bit, as the wires carry them (docs/reference/messages.md).
#pragma once

#include <cstdint>
#include <vector>

#include "model/machine/message.hpp"
#include "model/machine/wire_bits.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// Type codes, the first three bits of a message.
enum class WireType : std::uint8_t { ray, shadow_ray, intensity, lit, blocked, postponed };

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
    void put_place(WireBits& bits, const Ray& ray) const;
    void get_place(WireBits& bits, Ray& ray) const;
    void put_reciprocal(WireBits& bits, const char* name, double value) const;
    double get_reciprocal(WireBits& bits, double direction) const;
    void put_address(WireBits& bits, int x, int y, std::uint32_t slot, bool of_pixel, unsigned child) const;
    /// The codes of own rays are the last ones, counted down: own ray 0 is all ones.
    std::uint32_t own_ray_code(std::uint32_t number) const { return (1U << slot_bits_) - 1 - number; }
    RayKind verdict_kind(bool precast) const;

    Formats formats_;
    Shadows shadows_;
    int x_bits_;
    int y_bits_;
    int slot_bits_;
    int own_rays_;
};

}  // namespace raycell
