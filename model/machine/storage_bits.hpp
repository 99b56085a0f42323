// Bits that a cell must store beside its voxels: buffers, ray store, registers. docs/reference/cell.md has
// the tables.
#pragma once

#include "model/machine/message.hpp"

namespace raycell {

/// Parts of one slot of the ray store, bits.
struct SlotBits {
    int control = 0;   ///< state, rank by age, voxel that was hit
    int ray = 0;       ///< of the ray that hit: where its answer goes, kind, generation, weight, direction
    int hit = 0;       ///< point, normal, side
    int children = 0;  ///< their directions; sent, awaited, intensity; with recovery attempts and back-off
    int sources = 0;   ///< per source a bit for to ask, awaited, lit, as far as the shadow mode needs them
    int out = 0;       ///< register of the child on its way out: a ray, what was decided about it, its age
    int total() const { return control + ray + hit + children + sources + out; }
};

/// Bits of one slot, for this number of sources.
SlotBits slot_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats,
                   const SourceCounts& sources);

/// Registers beside buffers and slots, bits.
struct RegisterBits {
    /// The injector's: a ray; whether it is to be sent, awaited; its back-off. If the cell sends several:
    /// these and the sample for each own ray; the ray in the making; counters of samples and turns.
    int own_ray = 0;
    /// The intensities of a block of pixels, from which the picture is read, and what samples add up. That of
    /// a cell with one primary ray is not counted.
    std::int64_t pixels = 0;
    int decisions = 0;  ///< of each ray input and the own ray, once it is tested
    int ages = 0;       ///< of each input, the own ray and the shading unit's reply: oldest first
    int credits = 0;    ///< places left behind each output, by class; cycles until wires are free
    int outputs = 0;    ///< the message that leaves over each side, while its place is taken by the next
    int traversal = 0;  ///< working registers of the traversal units
    int shading = 0;    ///< of the shading unit, with a hit that has no slot and its reply
    int loading = 0;    ///< of the loading units: spans at work, each with its object's features
    int latches = 0;    ///< viewer, background and sources, from the load messages
    std::int64_t total() const {
        return pixels + own_ray + decisions + ages + credits + outputs + traversal + shading + loading +
               latches;
    }
};
RegisterBits register_bits(const PictureSettings& picture, const MachineSettings& machine,
                           const Formats& formats, const SourceCounts& sources);

/// Bits of a span that waits in a cell for its voxel, with its object's features.
int kept_span_bits(const MessageBits& messages);

/// What a cell with four neighbours stores, bits.
struct StorageBits {
    std::int64_t ray_buffers = 0;     ///< of its four inputs; each as wide as the widest message of its class
    std::int64_t answer_buffers = 0;  ///< 0 with `shared`: answers use the ray buffers
    std::int64_t ray_store = 0;       ///< M slots
    std::int64_t registers = 0;
    std::int64_t buffers() const { return ray_buffers + answer_buffers; }
    std::int64_t total() const { return buffers() + ray_store + registers; }
};
StorageBits storage_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats, const SourceCounts& sources);

}  // namespace raycell
