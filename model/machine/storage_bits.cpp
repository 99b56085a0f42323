#include "model/machine/storage_bits.hpp"

#include <algorithm>

#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"
#include "model/tracing/pixel_sum.hpp"

namespace raycell {
namespace {

constexpr Side all_sides[] = {Side::east, Side::south, Side::west, Side::north};

bool is_horizontal(Side side) { return side == Side::east || side == Side::west; }

/// Calls see(holds_rays, holds_answers) for each buffer of a cell's four inputs.
template <typename See>
void for_each_buffer(const BufferClasses& classes, const See& see) {
    for (const Side side : all_sides) {
        for (int index = 0; index < classes.count; ++index) {
            if (!classes.used(index, is_horizontal(side), side)) continue;
            see(classes.holds_rays(index), classes.holds_answers(index));
        }
    }
}

/// Bits of what is decided about a ray: its stage 2 (untested, in test, decided), what it needs 3, side or
/// kind of answer 2, leaves the array 1, lost 1, voxel, distance.
int decision_bits(const Formats& formats) {
    return 2 + 3 + 2 + 1 + 1 + field::voxel_index + formats.distance.bits();
}

/// Bits of a back-off. The longest is the shortest, doubled six times and at most once more by the jitter.
int backoff_bits(const MachineSettings& machine) {
    return bits_for((std::int64_t(machine.costs.backoff) << 7) + 1);
}

/// Bits of attempts and back-off.
int retry_bits(const MachineSettings& machine) {
    constexpr int attempts = 3;
    return machine.recovery == Recovery::postpone ? attempts + backoff_bits(machine) : 0;
}

/// Bits that the wait for the first start takes beyond the register of the back-off.
int start_bits(const MachineSettings& machine) {
    const int there = machine.recovery == Recovery::postpone ? backoff_bits(machine) : 0;
    return std::max(0, bits_for(std::int64_t(machine.start_within)) - there);
}

/// Bits of what is known about the primary rays of a cell, beside the ray that waits to leave.
int own_ray_bits(const PictureSettings& picture, const MachineSettings& machine,
                 const MessageBits& messages) {
    const int each = 2 + retry_bits(machine);  // to be sent, awaited
    const int samples = picture.own_samples();
    if (samples == 1) return each;
    const int rays = own_rays_of(picture, machine);
    const int next = bits_for(samples + 1);
    const int stop = may_stop_early(picture) ? next : 0;
    return rays * (each + bits_for(samples)) + messages.ray + next + stop + bits_for(rays);
}

/// Bits of the intensities of a cell's pixels: the sums of their samples, and how many there are so far. Of
/// the one pixel whose first samples decide, the least and the greatest of each component.
std::int64_t pixel_bits(const PictureSettings& picture, const Formats& formats) {
    if (picture.own_samples() == 1) return 0;
    const int more = picture.samples > 1 ? bits_for(picture.samples) : 0;
    const int count = picture.samples > 1 ? bits_for(picture.samples + 1) : 0;
    const int limits = may_stop_early(picture) ? 2 * 3 * formats.word_bits : 0;
    return (3 * (formats.word_bits + more) + count) * std::int64_t(picture.block()) + limits;
}

/// Home, slot and child: where a ray's answer goes.
int address_bits(const MessageBits& messages) { return messages.verdict - field::type; }

/// Bits of the longest ray that a slot sends (`children`), or that is the cell's own ray (not `children`).
int sent_ray_bits(const PictureSettings& picture, const MessageBits& messages, bool sources, bool children) {
    const bool shadow_rays =
        children ? picture.shadows != Shadows::precast : picture.shadows == Shadows::precast;
    return std::max(messages.ray, sources && shadow_rays ? messages.shadow_ray : 0);
}

/// Bits of a counter of the cycles that a message of `bits` takes on a link.
int wire_bits(const MachineSettings& machine, int bits) {
    return bits_for(link_cycles(bits, machine.link_bits) + 1);
}

}  // namespace

SlotBits slot_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats,
                   const SourceCounts& sources) {
    constexpr int children = 2;
    const int word = formats.word_bits;
    const int direction = 3 * word;
    const MessageBits messages = message_bits(picture, machine, formats);
    const int address = address_bits(messages);
    SlotBits bits;
    bits.control = 3 + bits_for(machine.ray_store) + field::voxel_index;  // six states; the oldest goes first
    bits.ray = address + 2 + field::generation + word + direction;  // kind: primary, reflected, refracted
    bits.hit = 2 * word + formats.depth_word_bits() + direction + 1;
    bits.children = children * (direction + 2 + 3 * word);
    bits.children += children * retry_bits(machine);
    const int each = picture.shadows == Shadows::per_hit ? 3 : picture.shadows == Shadows::memo ? 2 : 1;
    bits.sources = each * int(sources.lights);
    bits.out =
        sent_ray_bits(picture, messages, sources.sources() > 0, true) + decision_bits(formats) + field::age;
    return bits;
}

namespace {

/// Bits of a traversal unit's registers: nearest hit so far, crossing, the ray's depth run in the cell,
/// the line of the index table, its voxel, a counter over edges, places of the ray and of the next round's
/// beginning, a point, a sum.
int traversal_bits(const MachineSettings& machine, const Formats& formats, int ray_inputs) {
    const int distance = formats.distance.bits();
    const int nearest = 1 + distance + field::voxel_index;
    const int crossing = distance + 2;
    const int run = 2 * formats.depth_word_bits();
    const int counters = 2 * field::voxel_index + field::edge_count;
    const int places = 2 * bits_for(ray_inputs + 1 + machine.ray_store);
    const int point = 2 * formats.word_bits + formats.depth_word_bits();
    return nearest + crossing + run + counters + places + point + formats.accumulator.bits();
}

/// Registers of the shading unit for sources that are no points: what is sent this way; the samples' place in
/// their pattern, their shift, two sums; of spheres the two axes of a disc.
int light_bits(const SourceCounts& sources, const Formats& formats) {
    const auto has = [&](SourceKind kind) { return sources.of_kind[std::size_t(kind)] > 0; };
    const bool flat = has(SourceKind::rectangle) || has(SourceKind::triangle);
    const int emission = flat || has(SourceKind::spot) ? formats.word_bits : 0;
    const int samples = 2 * 2 * field::sample_place + 2 * (formats.word_bits + field::samples - 1);
    return emission + (flat || has(SourceKind::sphere) ? samples : 0) +
           (has(SourceKind::sphere) ? 2 * 3 * formats.word_bits : 0);
}

/// Bits of the shading unit's registers: job 3, its slot, counter over sources; three vectors (to the source,
/// half way, mirrored), distance to the source, intensity so far, a sum. For a hit without a slot: the ray,
/// the hit, and the reply on its way out.
int shading_bits(const SlotBits& slot, const MachineSettings& machine, const MessageBits& messages,
                 const Formats& formats) {
    const int vector = 3 * formats.word_bits;
    const int job = 3 + bits_for(machine.ray_store) + field::child;
    const int work = 3 * vector + formats.reach.bits() + vector + formats.accumulator.bits();
    return job + work + slot.ray + slot.hit + field::voxel_index + messages.intensity;
}

}  // namespace

RegisterBits register_bits(const PictureSettings& picture, const MachineSettings& machine,
                           const Formats& formats, const SourceCounts& sources) {
    const MessageBits messages = message_bits(picture, machine, formats);
    const BufferClasses classes = buffer_classes(machine.networks);
    const int ray = std::max(messages.ray, messages.shadow_ray);
    const int age = field::age;
    int ray_inputs = 0;
    RegisterBits bits;
    for_each_buffer(classes, [&](bool holds_rays, bool) {
        ray_inputs += holds_rays;
        bits.ages += age;
        bits.credits += bits_for(machine.buffer_depth + 1);  // as many outputs as inputs
    });
    const bool precast = picture.shadows == Shadows::precast;
    bits.own_ray = sent_ray_bits(picture, messages, sources.sources() > 0, false) +
                   own_ray_bits(picture, machine, messages) + start_bits(machine) +
                   (precast ? field::voxel_index + bits_for(std::int64_t(sources.lights)) : 0);
    bits.pixels = pixel_bits(picture, formats);
    bits.decisions = (ray_inputs + 1) * decision_bits(formats);
    bits.ages += 2 * age;
    bits.credits += 2 * side_count * wire_bits(machine, ray);  // those that come in and those that leave
    bits.outputs = side_count * std::max(ray, messages.intensity);
    bits.traversal = machine.traversal_units * traversal_bits(machine, formats, ray_inputs);
    bits.shading = shading_bits(slot_bits(picture, machine, formats, sources), machine, messages, formats) +
                   light_bits(sources, formats);
    bits.loading = machine.loading_units * kept_span_bits(messages);
    bits.latches = messages.setup(sources);  // the background is the viewer's
    return bits;
}

int kept_span_bits(const MessageBits& messages) {
    return messages.longest_span() + messages.features - 2 * field::type;
}

StorageBits storage_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats, const SourceCounts& sources) {
    const MessageBits messages = message_bits(picture, machine, formats);
    const std::int64_t ray = std::max(messages.ray, messages.shadow_ray);
    const std::int64_t answer = messages.intensity;
    StorageBits bits;
    for_each_buffer(buffer_classes(machine.networks), [&](bool rays, bool answers) {
        std::int64_t& kind = rays ? bits.ray_buffers : bits.answer_buffers;
        kind += std::max(rays ? ray : 0, answers ? answer : 0) * machine.buffer_depth;
    });
    bits.ray_store = std::int64_t(slot_bits(picture, machine, formats, sources).total()) * machine.ray_store;
    bits.registers = register_bits(picture, machine, formats, sources).total();
    return bits;
}

}  // namespace raycell
