// A ray's id: its pixel and which of its samples in the upper half, its place in the sample's tree of rays in
// the lower half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "model/settings/settings.hpp"

namespace raycell {

constexpr int id_pixel_bits = 26;
static_assert(most_pixels == std::uint64_t(1) << id_pixel_bits && most_samples <= 64);

/// Pixel below most_pixels, sample from 0 to 63.
constexpr std::uint64_t ray_id(std::uint64_t pixel, std::uint32_t branch, unsigned sample = 0) {
    return std::uint64_t(sample) << (32 + id_pixel_bits) | pixel << 32 | branch;
}
/// Index of the pixel, row-major; for a precast or memo ray, of the cell that sends it.
constexpr std::size_t pixel_of(std::uint64_t id) { return std::size_t(id >> 32 & (most_pixels - 1)); }
constexpr unsigned sample_of_id(std::uint64_t id) { return unsigned(id >> (32 + id_pixel_bits)); }
constexpr std::uint32_t branch_of(std::uint64_t id) { return std::uint32_t(id); }
/// Name of a ray in reports and waveforms: pixel/branch, of a sample that is not the first
/// pixel.sample/branch.
inline std::string ray_name(std::uint64_t id) {
    const unsigned sample = sample_of_id(id);
    return std::to_string(pixel_of(id)) + (sample > 0 ? "." + std::to_string(sample) : std::string()) + "/" +
           std::to_string(branch_of(id));
}

}  // namespace raycell
