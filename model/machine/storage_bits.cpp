#include "model/machine/storage_bits.hpp"

#include <algorithm>

#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {
SlotBits slot_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats,
                   std::size_t sources) {
    constexpr int children = 2;
    const int word = formats.word_bits;
    const int direction = 3 * word;
    const MessageBits messages = message_bits(picture, machine, formats);
    const int address = messages.verdict - field::type;
    SlotBits bits;
    bits.control = 3 + bits_for(machine.ray_store) + field::voxel_index;  // six states; the oldest goes first
    bits.ray = address + 2 + field::generation + word + direction;  // kind: primary, reflected, refracted
    bits.hit = 2 * word + formats.depth_word_bits() + direction + 1;
    bits.children = children * (direction + 2 + 3 * word);
    if (machine.recovery == Recovery::postpone) {
        // The back-off doubles up to six times, and the jitter at most doubles it once more.
        constexpr int attempts = 3;
        bits.children += children * (attempts + bits_for((std::int64_t(machine.costs.backoff) << 7) + 1));
    }
    const int each = picture.shadows == Shadows::per_hit ? 3 : picture.shadows == Shadows::memo ? 2 : 1;
    bits.sources = each * int(sources);
    bits.out =
        std::max(messages.ray, sources > 0 && picture.shadows != Shadows::precast ? messages.shadow_ray : 0);
    return bits;
}

StorageBits storage_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats, std::size_t sources) {
    const MessageBits messages = message_bits(picture, machine, formats);
    const BufferClasses classes = buffer_classes(machine.networks);
    const std::int64_t ray = std::max(messages.ray, messages.shadow_ray);
    const std::int64_t answer = messages.intensity;
    StorageBits bits;
    for (const Side side : {Side::east, Side::south, Side::west, Side::north}) {
        const bool horizontal = side == Side::east || side == Side::west;
        for (int index = 0; index < classes.count; ++index) {
            if (!classes.used(index, horizontal, side)) continue;
            if (classes.count == 1) {
                bits.ray_buffers += std::max(ray, answer);
            } else if (index == classes.answer) {
                bits.answer_buffers += answer;
            } else {
                bits.ray_buffers += ray;
            }
        }
    }
    bits.ray_buffers *= machine.buffer_depth;
    bits.answer_buffers *= machine.buffer_depth;
    bits.ray_store = std::int64_t(slot_bits(picture, machine, formats, sources).total()) * machine.ray_store;
    return bits;
}

}  // namespace raycell
