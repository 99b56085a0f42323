#include "model/loading/voxel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/loading/coverage.hpp"
#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {
namespace {

dvec3 hold_point(const dvec3& point, const Arithmetic& arithmetic) {
    const Formats& f = arithmetic.formats();
    return {arithmetic.hold(f.unit, point.x), arithmetic.hold(f.unit, point.y),
            arithmetic.hold(f.depth, point.z)};
}

/// The voxel's plane in words: its offset is right in the middle of the polygon's part.
Plane voxel_plane(const Span& span, const Voxel& voxel, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return span.plane;
    const Formats& formats = arithmetic.formats();
    const Projection axes = projection(voxel.drop);
    const dvec2 anchor = project(voxel.point - dvec3(0, 0, voxel.base), voxel.drop);
    const dvec3& n = span.plane.n;
    Plane plane;
    plane.n = arithmetic.hold(formats.unit, n);
    plane.c = arithmetic.long_mac(formats.offset, span.plane.c, -n.z, voxel.base, plane.n[axes.u] - n[axes.u],
                                  anchor.x, plane.n[axes.v] - n[axes.v], anchor.y);
    return plane;
}

/// c + u·du + v·dv, per component.
dvec3 sum_at(const Format& f, const dvec3& c, const dvec3& du, double u, const dvec3& dv, double v,
             const Arithmetic& arithmetic) {
    const auto each = [&](int i) { return arithmetic.long_mac(f, c[i], du[i], u, dv[i], v); };
    return {each(0), each(1), each(2)};
}

/// The voxel's field of normals; in words it is right in the middle of the polygon's part, too.
NormalField voxel_normal(const Span& span, const Voxel& voxel, const PictureSettings& settings,
                         const Arithmetic& arithmetic) {
    const Format& loading = arithmetic.formats().loading;
    const Format& word = arithmetic.formats().normal;
    NormalField field = span.normal;
    const dvec2 own = project(voxel.point, voxel.drop);
    if (settings.normals == Normals::voxel) {
        const bool from_span = settings.hit == HitTest::depth;
        const dvec3 normal =
            from_span ? span.n : sum_at(loading, field.base, field.du, own.x, field.dv, own.y, arithmetic);
        field = {normal, dvec3(0), dvec3(0)};
    } else if (voxel.drop != 2 && !arithmetic.exact()) {  // v is z, which counts from the run's beginning
        field.base = sum_at(loading, field.base, field.dv, voxel.base, dvec3(0), 0, arithmetic);
    }
    if (arithmetic.exact()) return field;
    const dvec2 anchor = project(voxel.point - dvec3(0, 0, voxel.base), voxel.drop);
    const dvec3 middle = sum_at(loading, field.base, field.du, anchor.x, field.dv, anchor.y, arithmetic);
    const NormalField filled =
        fill_words(field, middle, scale_by(1, word.integer_bits() - 1), least_normal(word));
    NormalField held;
    held.du = arithmetic.hold(word, filled.du);
    held.dv = arithmetic.hold(word, filled.dv);
    held.base =
        sum_at(word, filled.base, filled.du - held.du, anchor.x, filled.dv - held.dv, anchor.y, arithmetic);
    return held;
}

void set_functions(Voxel& voxel, const Span& span, const PictureSettings& settings,
                   const Arithmetic& arithmetic) {
    voxel.plane = voxel_plane(span, voxel, arithmetic);
    voxel.normal = voxel_normal(span, voxel, settings, arithmetic);
}

/// An edge of the voxel, in words: right at its foot, the point of the edge next to the run's middle.
EdgeFunction voxel_edge(const EdgeFunction& edge, const Voxel& voxel, const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return edge;
    const Formats& formats = arithmetic.formats();
    const Format& loading = formats.loading;
    const dvec2 middle = project(0.5 * dvec3(1, 1, voxel.far - voxel.near), voxel.drop);
    double c = edge.c;
    if (voxel.drop != 2) c = arithmetic.long_mac(loading, c, edge.b, voxel.base);
    const double off = arithmetic.long_mac(loading, c, edge.a, middle.x, edge.b, middle.y);
    const dvec2 foot{arithmetic.long_mac(loading, middle.x, -off, edge.a),
                     arithmetic.long_mac(loading, middle.y, -off, edge.b)};
    EdgeFunction held{formats.unit.hold(edge.a), formats.unit.hold(edge.b), 0, edge.piece};
    held.c = arithmetic.long_mac(formats.edge_offset, 0, -held.a, foot.x, -held.b, foot.y);
    return held;
}

/// Adds a piece of the same polygon to the voxel that it already has in this cell. The point is that of the
/// largest piece.
void merge(Voxel& voxel, const Voxel& piece) {
    voxel.near_level = std::min(voxel.near_level, piece.near_level);
    voxel.far_level = std::max(voxel.far_level, piece.far_level);
    if (piece.area <= voxel.area) return;
    voxel.area = piece.area;
    voxel.point = piece.point;
}

/// What a span makes of its current cell.
struct Made {
    Voxel voxel;
    std::array<EdgeFunction, 4> edges;  ///< rung `edge`: those that cross the voxel
    int edge_count = 0;
};

/// Sets the run's ends from its levels.
void set_ends(Voxel& voxel, double level, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    voxel.near = arithmetic.hold(formats.depth, voxel.near_level * level);
    voxel.far = arithmetic.hold(formats.depth, voxel.far_level * level);
    if (arithmetic.exact()) return;
    // Levels may be finer than the word's last bit, but a run is never empty.
    voxel.far = std::max(voxel.far, voxel.near + formats.depth.step());
}

/// Sets the run of a voxel that reaches from depth `near` to `far`.
void set_run(Voxel& voxel, double near, double far, const PictureSettings& settings, double level,
             const Arithmetic& arithmetic) {
    const int last = settings.depth_levels - 1;
    voxel.near_level = std::clamp(int(std::floor(near / level)), 0, last);
    voxel.far_level = std::clamp(int(std::floor(far / level)), 0, last) + 1;
    set_ends(voxel, level, arithmetic);
    if (!arithmetic.exact()) voxel.base = voxel.near;
}

/// Rungs above `depth`: adds what the polygon's part in the cell says. False if there is none.
bool set_part(Made& made, const Span& span, const PictureSettings& settings, double level,
              const Arithmetic& arithmetic) {
    Voxel& voxel = made.voxel;
    const PartBounds bounds{span.plane, span.drop, span.edges.data(), span.edge_count};
    const Box column{-span.slack, dvec3(1, 1, level * settings.depth_levels) + span.slack};
    const Part part = part_in(bounds, column, arithmetic);
    if (part.empty()) return false;  // the row's part only passes by
    const double room = span.slack.z + arithmetic.hair();
    set_run(voxel, part.low.z - room, part.high.z + room, settings, level, arithmetic);
    const bool with_mask = settings.hit == HitTest::mask;
    const Coverage coverage = cover(bounds, part, voxel.near, voxel.far, with_mask, arithmetic);
    if (!coverage.touched) return false;
    voxel.mask = coverage.mask;
    voxel.window = coverage.window;
    voxel.area = part.area;
    const dvec3& middle = part.middle;
    voxel.point =
        hold_point({std::clamp(middle.x, 0.0, 1.0), std::clamp(middle.y, 0.0, 1.0), middle.z}, arithmetic);
    if (settings.hit != HitTest::edge) return true;
    for (int i = 0; i < coverage.crossings; ++i) {
        const EdgeFunction& edge = span.edges[std::size_t(coverage.crossing[std::size_t(i)])];
        made.edges[std::size_t(made.edge_count++)] = voxel_edge(edge, voxel, arithmetic);
    }
    return true;
}

/// The voxel without plane and normals; nothing if the polygon does not touch the cell.
std::optional<Made> make_voxel(const Span& span, const PictureSettings& settings, double level,
                               const Arithmetic& arithmetic) {
    Made made;
    made.voxel.polygon = span.polygon;
    made.voxel.object = span.object;
    made.voxel.drop = std::uint8_t(span.drop);
    if (settings.hit == HitTest::depth) {
        set_run(made.voxel, span.z, span.z, settings, level, arithmetic);
        made.voxel.point = hold_point({0.5, 0.5, span.z}, arithmetic);
    } else if (!set_part(made, span, settings, level, arithmetic)) {
        return std::nullopt;
    }
    return made;
}

/// Moves the voxel's edges, which count from the run's beginning, along with it.
void move_base(Voxel& voxel, CellStore& store, const Arithmetic& arithmetic) {
    if (arithmetic.exact() || voxel.base == voxel.near) return;
    const double shift = voxel.near - voxel.base;
    voxel.base = voxel.near;
    if (voxel.drop == 2) return;  // z is not among (u, v)
    for (std::uint32_t i = 0; i < voxel.edge_count; ++i) {
        EdgeFunction& edge = store.edges[voxel.first_edge + i];
        edge.c = arithmetic.mac(arithmetic.formats().edge_offset, edge.c, edge.b, shift);
    }
}

/// Adds the edges of a piece to those of the voxel that it has joined.
void add_piece(Voxel& voxel, const Made& piece, CellStore& store, const Arithmetic& arithmetic) {
    if (piece.edge_count == 0) {  // the piece covers the whole cell
        store.edges.resize(voxel.first_edge);
        voxel.edge_count = voxel.pieces = 0;
        return;
    }
    for (int i = 0; i < piece.edge_count; ++i) {
        EdgeFunction edge = piece.edges[std::size_t(i)];
        edge.piece = voxel.pieces;
        if (voxel.drop != 2 && voxel.base != piece.voxel.base) {  // the merged run begins nearer
            edge.c = arithmetic.mac(arithmetic.formats().edge_offset, edge.c, edge.b,
                                    voxel.base - piece.voxel.base);
        }
        store.edges.push_back(edge);
    }
    voxel.edge_count += std::uint32_t(piece.edge_count);
    ++voxel.pieces;
}

}  // namespace

std::uint32_t store_voxel(CellStore& store, const Span& span, const PictureSettings& settings, double level,
                          const Arithmetic& arithmetic) {
    const std::optional<Made> made = make_voxel(span, settings, level, arithmetic);
    if (!made) return 0;
    // The pieces of one polygon arrive one after the other. Mask voxels are not merged: each mask has its own
    // window.
    const bool mergeable = settings.hit != HitTest::mask;
    if (mergeable && !store.voxels.empty() && store.voxels.back().polygon == span.polygon) {
        Voxel& before = store.voxels.back();
        merge(before, made->voxel);
        set_ends(before, level, arithmetic);
        move_base(before, store, arithmetic);
        set_functions(before, span, settings, arithmetic);
        if (settings.hit == HitTest::edge && before.pieces > 0) add_piece(before, *made, store, arithmetic);
        return put_in_order(store.index, std::uint32_t(store.voxels.size() - 1), before.near, before.far);
    }
    if (settings.voxel_capacity > 0 && store.voxels.size() >= std::size_t(settings.voxel_capacity)) {
        // A polygon's next piece would have joined the voxel that already did not fit.
        if (!mergeable || store.last_overflowed != span.polygon) ++store.overflowed;
        store.last_overflowed = span.polygon;
        return 0;
    }
    Voxel voxel = made->voxel;
    set_functions(voxel, span, settings, arithmetic);
    voxel.first_edge = std::uint32_t(store.edges.size());
    if (made->edge_count > 0) {
        voxel.edge_count = std::uint32_t(made->edge_count);
        voxel.pieces = 1;
        store.edges.insert(store.edges.end(), made->edges.begin(), made->edges.begin() + made->edge_count);
    }
    store.voxels.push_back(voxel);
    if (settings.display == Display::gouraud)
        store.intensities.push_back(arithmetic.hold(arithmetic.formats().intensity, span.intensity));
    return put_in_order(store.index, std::uint32_t(store.voxels.size() - 1), voxel.near, voxel.far);
}

void make_index(CellStore& store) {
    store.index.clear();
    for (const Voxel& voxel : store.voxels)
        put_in_order(store.index, std::uint32_t(store.index.size()), voxel.near, voxel.far);
}

void StorageCounts::add(const StorageCounts& other) {
    voxels += other.voxels;
    edges += other.edges;
    overflowed += other.overflowed;
    occupied_cells += other.occupied_cells;
    max_voxels = std::max(max_voxels, other.max_voxels);
    max_needed = std::max(max_needed, other.max_needed);
    bits += other.bits;
    max_cell_bits = std::max(max_cell_bits, other.max_cell_bits);
}

void StorageCounts::add(const CellStore& store, const VoxelBits& each) {
    const std::uint64_t cell_voxels = store.voxels.size();
    const std::uint64_t cell_bits =
        cell_voxels * std::uint64_t(each.base) + store.edges.size() * std::uint64_t(each.per_edge);
    voxels += cell_voxels;
    edges += store.edges.size();
    overflowed += store.overflowed;
    occupied_cells += cell_voxels > 0;
    max_voxels = std::max(max_voxels, cell_voxels);
    max_needed = std::max(max_needed, cell_voxels + store.overflowed);
    bits += cell_bits;
    max_cell_bits = std::max(max_cell_bits, cell_bits);
}

int feature_bits(const Formats& formats) {
    return 6 * formats.feature_bits() + formats.shine_bits + formats.ior_bits() + 1;
}

VoxelBits voxel_bits(const PictureSettings& settings, const Formats& formats, std::size_t sources) {
    const int word = formats.word_bits;
    const int level_bits = bits_for(settings.depth_levels);
    VoxelBits bits;
    // One depth, one normal, as the paper's voxel; the slopes of its plane, which axis it drops, its sign:
    // rays start off a surface along it.
    bits.base =
        field::polygon_id + feature_bits(formats) + level_bits + 3 * word + 2 * word + field::axis + 1;
    if (settings.hit != HitTest::depth) bits.base += level_bits;
    // Its line of the index table: its number, and how far the voxels up to it reach.
    bits.base += field::voxel_index + level_bits;
    if (settings.hit >= HitTest::plane) bits.base += word;              // its offset
    if (settings.hit == HitTest::mask) bits.base += 64 + 4 * 5;         // coverage and its window
    if (settings.hit == HitTest::edge) bits.base += field::edge_count;  // how many edges follow
    if (settings.normals == Normals::linear) bits.base += 6 * word;
    if (settings.shadows != Shadows::per_hit) {
        bits.base += int(sources) * (settings.shadows == Shadows::memo ? 2 : 1);
        bits.base += 2 * word + formats.depth_word_bits();  // the point that its shadow rays start from
    }
    if (settings.hit == HitTest::edge) bits.per_edge = 2 * word + formats.depth_word_bits() + 2;
    return bits;
}

}  // namespace raycell
