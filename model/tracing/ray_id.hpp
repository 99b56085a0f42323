// A ray's id: its pixel in the upper half, its place in the pixel's tree of rays in the lower half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace raycell {

constexpr std::uint64_t ray_id(std::uint64_t pixel, std::uint32_t branch) { return pixel << 32 | branch; }
/// Index of the pixel, row-major; for a precast or memo ray, of the cell that sends it.
constexpr std::size_t pixel_of(std::uint64_t id) { return std::size_t(id >> 32); }
constexpr std::uint32_t branch_of(std::uint64_t id) { return std::uint32_t(id); }
/// Name of a ray in reports and waveforms: pixel/branch.
inline std::string ray_name(std::uint64_t id) {
    return std::to_string(pixel_of(id)) + "/" + std::to_string(branch_of(id));
}

}  // namespace raycell
