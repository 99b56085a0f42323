#include "model/machine/message.hpp"

#include <algorithm>

#include "model/loading/voxel.hpp"
#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {
Answer answer_to(const Ray& ray, Answer::Kind kind) {
    Answer answer;
    answer.kind = kind;
    answer.id = ray.id;
    answer.slot = ray.slot;
    answer.home_x = ray.home_x;
    answer.home_y = ray.home_y;
    answer.child = ray.child;
    answer.ray_kind = ray.kind;
    return answer;
}

int slot_address_bits(const PictureSettings& picture, const MachineSettings& machine) {
    // A slot or one of the own rays; verdicts on voxels name the voxel instead, up to 1024 in a cell.
    const int slot = bits_for(machine.ray_store + own_rays_of(picture, machine));
    return picture.shadows == Shadows::per_hit ? slot : std::max(slot, field::voxel_index);
}

namespace {

/// Load messages are of loading words.
void set_loading_bits(MessageBits& bits, const PictureSettings& picture, const Formats& formats) {
    const int word = formats.word_bits;
    const int loading = formats.loading.bits();
    const bool depth = picture.hit == HitTest::depth;
    const bool gouraud = picture.display == Display::gouraud;
    const int columns = 2 * bits_for(picture.width);
    const int rows = 2 * bits_for(picture.height);
    const int plane = 3 * loading + 3;  // two slopes, an offset; the axis that it drops, its sign
    const int normals = 9 * loading;
    bits.edge = 3 * loading;
    if (depth) bits.span_edges = 0;
    bits.span = field::type + field::polygon_id + columns + (gouraud ? 6 * loading : 0);
    if (depth) {
        // Z, DZ; slopes, of which no sums are made; N, DN (paper, section 3.1) or a field.
        bits.span += 2 * loading + field::axis + 1 + 2 * word;
        bits.span += picture.normals == Normals::voxel ? 6 * loading : normals;
    } else {
        bits.span += plane + loading + normals + field::edges;
    }
    bits.trapeze = field::type + rows + columns + field::edges;
    if (gouraud) bits.trapeze += field::edges + 4 * 6 * loading;  // places and intensities of four corners
    bits.surface = field::type + field::polygon_id + bits_for(picture.height) + plane + loading + normals;
    bits.polygon = field::type + field::polygon_id + plane + loading + normals + field::vertices;
    bits.vertex = 3 * loading;
    bits.features = field::type + feature_bits(formats);
    bits.end_of_scene = field::type;
    bits.viewer = field::type + formats.place_bits() + 1 + field::faces + 3 * word + field::level_count +
                  field::level_mantissa + Formats::exponent_bits + field::source_count;
    const int colour = 3 * word;
    const int axis = 3 * word;
    const int place = formats.place_bits();
    const int mantissa = word + 12;
    const int pattern = field::samples + 2 * field::sample_place + word + Formats::exponent_bits;
    const int flat = place + 2 * 3 * mantissa + axis + pattern + colour;
    bits.source = {place + colour, axis + colour, place + axis + word + formats.shine_bits + colour,
                   flat,           flat,          place + mantissa + pattern + colour};
}

}  // namespace

int MessageBits::setup(const SourceCounts& sources) const {
    int bits = viewer + (sources.points() ? 0 : int(sources.sources()) * field::source_kind);
    for (std::size_t kind = 0; kind < source.size(); ++kind)
        bits += int(sources.of_kind[kind]) * source[kind];
    return bits;
}

MessageBits message_bits(const PictureSettings& picture, const MachineSettings& machine,
                         const Formats& formats) {
    const int word = formats.word_bits;
    const int home = bits_for(picture.width) + bits_for(picture.height);
    const int address = home + slot_address_bits(picture, machine) + field::child;
    MessageBits bits;
    // Place, direction, the reciprocals of dx and dy (mantissas; their signs are the direction's).
    const int place = 2 * word + wire_depth_bits(formats);
    const int way = place + 3 * word + 2 * (word + Formats::exponent_bits);
    // A weight, or for a shadow ray the distance to its source; whether it is outside the cube.
    bits.ray = field::type + way + word + field::polygon_id + field::generation + address + 1;
    bits.shadow_ray = field::type + way + word + field::polygon_id + address + 1;
    bits.intensity = field::type + 3 * word + address;
    bits.verdict = field::type + address;
    set_loading_bits(bits, picture, formats);
    return bits;
}

BufferClasses buffer_classes(Networks networks) {
    BufferClasses classes;
    classes.networks = networks;
    switch (networks) {
        case Networks::shared:
            classes.count = 1;
            classes.answer = 0;
            break;
        case Networks::split:
            classes.count = 2;
            classes.answer = 1;
            break;
        case Networks::half:
            classes.count = 3;
            classes.answer = 2;
            break;
        case Networks::quadrant:
            classes.count = 5;
            classes.answer = 4;
            break;
    }
    return classes;
}

const char* class_name(Networks networks, int index) {
    static const char* const quadrants[] = {"ray_east_south", "ray_west_south", "ray_east_north",
                                            "ray_west_north", "answer"};
    static const char* const halves[] = {"ray_east", "ray_west", "answer"};
    static const char* const split[] = {"ray", "answer"};
    if (networks == Networks::quadrant) return quadrants[index];
    if (networks == Networks::half) return halves[index];
    return networks == Networks::split ? split[index] : "all";
}

int BufferClasses::ray(const Ray& r) const {
    const int west = r.direction.x < 0 ? 1 : 0;
    const int north = r.direction.y < 0 ? 1 : 0;
    if (networks == Networks::half) return west;
    if (networks == Networks::quadrant) return 2 * north + west;
    return 0;
}

bool BufferClasses::used(int index, bool horizontal, Side side) const {
    if (index == answer || networks == Networks::shared || networks == Networks::split) return true;
    const bool west = index & 1;
    if (horizontal) return west == (side == Side::west);
    if (networks == Networks::half) return true;
    return (index >> 1 & 1) == (side == Side::north ? 1 : 0);
}

std::uint32_t BufferClasses::used_over(Side side) const {
    const bool horizontal = side == Side::east || side == Side::west;
    std::uint32_t bits = 0;
    for (int index = 0; index < count; ++index) {
        if (used(index, horizontal, side)) bits |= 1U << unsigned(index);
    }
    return bits;
}

}  // namespace raycell
