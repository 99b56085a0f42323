// What a cell must store to communicate, bit by bit: its buffers and its ray store. docs/reference/cell.md has the
// table.
#pragma once

#include "model/machine/message.hpp"

namespace raycell {

/// Parts of one slot of the ray store, bits.
struct SlotBits {
    int control = 0;   ///< state, rank by age, voxel that was hit
    int ray = 0;       ///< of the ray that hit: where its answer goes, kind, generation, weight, direction
    int hit = 0;       ///< point, normal, side
    int children = 0;  ///< their directions; sent, awaited, intensity; with recovery attempts and back-off
    int sources = 0;   ///< a bit each for to ask, awaited, lit, as the shadow mode needs them
    int out = 0;       ///< register of the child on its way out
    int total() const { return control + ray + hit + children + sources + out; }
};

/// Bits of one slot, for so many sources.
SlotBits slot_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats,
                   std::size_t sources);

/// What a cell with four neighbours stores, bits.
struct StorageBits {
    std::int64_t ray_buffers = 0;     ///< of its four input links; a buffer's words hold the widest message
    std::int64_t answer_buffers = 0;  ///< 0 with `shared`: answers stand among the rays
    std::int64_t ray_store = 0;       ///< M slots
    std::int64_t buffers() const { return ray_buffers + answer_buffers; }
    std::int64_t total() const { return buffers() + ray_store; }
};
StorageBits storage_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats, std::size_t sources);

}  // namespace raycell
