#include "model/loading/voxel.hpp"

#include <algorithm>
#include <cmath>

#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"

namespace raycell {
namespace {

struct Rectangle {
    dvec2 low;
    dvec2 high;
};

/// The cell's column over the voxel's run, in the projection of the plane.
Rectangle footprint(const Voxel& voxel, double level) {
    const dvec3 low{0, 0, voxel.near_level * level};
    const dvec3 high{1, 1, voxel.far_level * level};
    return {project(low, voxel.drop), project(high, voxel.drop)};
}

double least_over(const EdgeFunction& edge, const Rectangle& r) {
    return edge.c + std::min(edge.a * r.low.x, edge.a * r.high.x) +
           std::min(edge.b * r.low.y, edge.b * r.high.y);
}

double most_over(const EdgeFunction& edge, const Rectangle& r) {
    return edge.c + std::max(edge.a * r.low.x, edge.a * r.high.x) +
           std::max(edge.b * r.low.y, edge.b * r.high.y);
}

/// Whether the span's polygon covers the pixel centre (rung `depth`); z is its depth there.
bool covers_centre(const Span& span, double hair, double& z) {
    const dvec3& n = span.plane.n;
    if (std::abs(n.z) < 1e-12) return false;
    z = (span.plane.c - 0.5 * (n.x + n.y)) / n.z;
    const dvec2 uv = project({0.5, 0.5, z}, span.drop);
    for (int i = 0; i < span.edge_count; ++i) {
        if (span.edges[std::size_t(i)].at(uv) < -hair) return false;
    }
    return true;
}

/// Bounds of the part inside the cell; together with the edges they tell exactly which sub-cells a convex
/// part touches.
Rectangle part_bounds(const std::vector<dvec3>& part, int drop) {
    Rectangle bounds{dvec2(1e300), dvec2(-1e300)};
    for (const dvec3& p : part) {
        bounds.low = glm::min(bounds.low, project(p, drop));
        bounds.high = glm::max(bounds.high, project(p, drop));
    }
    return bounds;
}

/// The window of the mask: the part's bounds, rounded outwards to 32nds of the footprint.
Rectangle set_window(Voxel& voxel, const Rectangle& whole, const Rectangle& bounds, double hair) {
    const dvec2 size = whole.high - whole.low;
    const dvec2 low = (bounds.low - hair - whole.low) / size * double(window_steps);
    const dvec2 high = (bounds.high + hair - whole.low) / size * double(window_steps);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const int from = std::clamp(int(std::floor(low[int(axis)])), 0, window_steps - 1);
        const int to = std::clamp(int(std::ceil(high[int(axis)])), from + 1, window_steps);
        voxel.window[2 * axis] = std::uint8_t(from);
        voxel.window[2 * axis + 1] = std::uint8_t(to);
    }
    const dvec2 step = size / double(window_steps);
    return {whole.low + step * dvec2(voxel.window[0], voxel.window[2]),
            whole.low + step * dvec2(voxel.window[1], voxel.window[3])};
}

bool overlap(const Rectangle& a, const Rectangle& b, double hair) {
    return a.low.x <= b.high.x + hair && b.low.x <= a.high.x + hair && a.low.y <= b.high.y + hair &&
           b.low.y <= a.high.y + hair;
}

/// A sub-cell's bit is set where the polygon touches it at all: watertight first.
std::uint64_t coverage(const EdgeFunction* edges, int count, const Rectangle& whole, const Rectangle& bounds,
                       double hair) {
    std::uint64_t mask = 0;
    const dvec2 step = (whole.high - whole.low) / 8.0;
    for (int row = 0; row < 8; ++row) {
        for (int column = 0; column < 8; ++column) {
            const dvec2 low = whole.low + step * dvec2(column, row);
            const Rectangle part{low, low + step};
            bool touched = overlap(part, bounds, hair);
            for (int i = 0; i < count && touched; ++i) touched = most_over(edges[i], part) >= -hair;
            if (touched) mask |= std::uint64_t(1) << (8 * row + column);
        }
    }
    return mask;
}

/// The span's part inside its current cell; empty if the row's part only passes by.
std::vector<dvec3> cell_part(const Span& span) {
    std::vector<dvec3> part(span.outline.begin(), span.outline.begin() + span.outline_count);
    bool left = false;
    bool right = false;
    for (const dvec3& p : part) {
        left = left || p.x < -span.slack.x;
        right = right || p.x > 1 + span.slack.x;
    }
    if (left) part = clip_half_space(part, 0, -span.slack.x, 1);
    if (right && !part.empty()) part = clip_half_space(part, 0, 1 + span.slack.x, -1);
    return part;
}

dvec3 hold_point(const dvec3& point, const Arithmetic& arithmetic) {
    const Formats& f = arithmetic.formats();
    return {arithmetic.hold(f.unit, point.x), arithmetic.hold(f.unit, point.y),
            arithmetic.hold(f.depth, point.z)};
}

/// Sets the voxel's point (mean of the corners) and area.
void set_point(Voxel& voxel, const std::vector<dvec3>& part) {
    dvec3 sum{0, 0, 0};
    for (const dvec3& p : part) sum += p;
    voxel.point = sum / double(part.size());
    voxel.point.x = std::clamp(voxel.point.x, 0.0, 1.0);
    voxel.point.y = std::clamp(voxel.point.y, 0.0, 1.0);
    voxel.area = 0.5 * glm::length(newell(part));
}

/// Sets the voxel's plane and normal field from the span's. In words they are right in the middle of the
/// polygon's part.
void set_functions(Voxel& voxel, const Span& span, Normals normals, const Arithmetic& arithmetic) {
    const dvec2 own = project(voxel.point, voxel.drop);
    voxel.plane = span.plane;
    voxel.normal = span.normal;
    if (normals == Normals::voxel) voxel.normal = {span.normal.at(own), {0, 0, 0}, {0, 0, 0}};
    if (arithmetic.exact()) return;
    const Formats& formats = arithmetic.formats();
    const dvec3 shift{0, 0, voxel.base};
    Plane plane = span.plane;
    plane.c -= plane.n.z * voxel.base;
    voxel.plane = hold_plane(plane, voxel.drop, voxel.point - shift, formats.unit, formats.offset);
    NormalField field = voxel.normal;
    field.base = field.at(project(shift, voxel.drop));
    const dvec2 anchor = project(voxel.point - shift, voxel.drop);
    const double most = scale_by(1, formats.normal.integer_bits() - 1);
    field = fill_words(field, anchor, most, least_normal(formats.normal));
    voxel.normal = hold_field(field, anchor, formats.normal, formats.normal);
}

/// Sets the run's ends, and moves the edges, which are relative to its beginning, along with it.
void set_run(Voxel& voxel, CellStore& store, double level, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    voxel.near = arithmetic.hold(formats.depth, voxel.near_level * level);
    voxel.far = arithmetic.hold(formats.depth, voxel.far_level * level);
    if (arithmetic.exact()) return;
    // Levels may be finer than the word's last bit, but a run is never empty.
    voxel.far = std::max(voxel.far, voxel.near + formats.depth.step());
    if (voxel.base == voxel.near) return;
    const double shift = voxel.near - voxel.base;
    voxel.base = voxel.near;
    if (voxel.drop == 2) return;  // z is not among (u, v)
    for (std::uint32_t i = 0; i < voxel.edge_count; ++i) {
        EdgeFunction& edge = store.edges[voxel.first_edge + i];
        edge.c = arithmetic.mac(formats.edge_offset, edge.c, edge.b, shift);
    }
}

/// An edge of the voxel, in words; `whole` is the voxel's footprint.
EdgeFunction voxel_edge(const EdgeFunction& edge, const Voxel& voxel, const Rectangle& whole,
                        const Arithmetic& arithmetic) {
    if (arithmetic.exact()) return edge;
    const Formats& formats = arithmetic.formats();
    const dvec2 shift = project({0, 0, voxel.base}, voxel.drop);
    EdgeFunction relative = edge;
    relative.c = edge.at(shift);
    return hold_edge(relative, 0.5 * (whole.low + whole.high) - shift, formats.unit, formats.edge_offset);
}

/// Adds a piece of the same polygon to the voxel that it already has in this cell.
void merge(Voxel& voxel, const Voxel& piece, const Arithmetic& arithmetic) {
    voxel.near_level = std::min(voxel.near_level, piece.near_level);
    voxel.far_level = std::max(voxel.far_level, piece.far_level);
    const double area = voxel.area + piece.area;
    if (area > 0) {
        voxel.point = (voxel.area * voxel.point + piece.area * piece.point) / area;
        voxel.point = hold_point(voxel.point, arithmetic);
    }
    voxel.area = area;
}

}  // namespace

bool store_voxel(CellStore& store, const Span& span, const PictureSettings& settings, double level,
                 const Arithmetic& arithmetic) {
    const double hair = arithmetic.hair();
    Voxel voxel;
    voxel.polygon = span.polygon;
    voxel.object = span.object;
    voxel.drop = std::uint8_t(span.drop);
    const std::vector<dvec3> part = cell_part(span);
    if (part.empty()) return false;  // only touches the cell's side: the neighbour has it
    double near = std::max(span.near, span.z_min);
    double far = std::min(span.far, span.z_max);
    // Where a side crosses the cell, the plane continues past it; so the run is limited to the part inside.
    double part_near = part.front().z;
    double part_far = part.front().z;
    for (const dvec3& p : part) {
        part_near = std::min(part_near, p.z);
        part_far = std::max(part_far, p.z);
    }
    near = std::max(near, part_near - span.slack.z);
    far = std::min(far, part_far + span.slack.z);
    if (settings.hit == HitTest::depth) {
        double z = 0;
        if (!covers_centre(span, hair, z)) return false;
        near = far = z;
    } else if (near > far) {
        if (near > far + hair) return false;  // the part does not reach this cell
        std::swap(near, far);
    }
    const int last = settings.depth_levels - 1;
    const double room = settings.hit == HitTest::depth ? 0 : hair;
    voxel.near_level = std::clamp(int(std::floor((near - room) / level)), 0, last);
    voxel.far_level = std::clamp(int(std::floor((far + room) / level)), 0, last) + 1;

    std::array<EdgeFunction, 4> crossing;
    int crossings = 0;
    if (settings.hit != HitTest::depth) {
        const Rectangle whole = footprint(voxel, level);
        for (int i = 0; i < span.edge_count; ++i) {
            const EdgeFunction& edge = span.edges[std::size_t(i)];
            if (most_over(edge, whole) < -hair) return false;  // wholly outside: touches only the run's box
            if (least_over(edge, whole) < -hair) crossing[std::size_t(crossings++)] = edge;
        }
        if (settings.hit == HitTest::mask) {
            const Rectangle bounds = part_bounds(part, span.drop);
            voxel.mask =
                coverage(crossing.data(), crossings, set_window(voxel, whole, bounds, hair), bounds, hair);
        }
    }
    set_point(voxel, part);
    voxel.point = hold_point(voxel.point, arithmetic);
    set_run(voxel, store, level, arithmetic);
    if (settings.hit == HitTest::edge) {
        const Rectangle whole = footprint(voxel, level);
        for (int i = 0; i < crossings; ++i) {
            EdgeFunction& edge = crossing[std::size_t(i)];
            edge = voxel_edge(edge, voxel, whole, arithmetic);
        }
    }
    // The pieces of one polygon arrive one after the other. Mask voxels are not merged: each mask has its own
    // window.
    const bool mergeable = settings.hit != HitTest::mask;
    if (mergeable && !store.voxels.empty() && store.voxels.back().polygon == span.polygon) {
        Voxel& before = store.voxels.back();
        merge(before, voxel, arithmetic);
        set_run(before, store, level, arithmetic);
        set_functions(before, span, settings.normals, arithmetic);
        if (settings.hit == HitTest::edge && before.pieces > 0) {
            if (crossings == 0) {
                store.edges.resize(before.first_edge);
                before.edge_count = before.pieces = 0;
            } else {
                for (int i = 0; i < crossings; ++i) {
                    EdgeFunction edge = crossing[std::size_t(i)];
                    edge.piece = before.pieces;
                    if (before.drop != 2 && before.base != voxel.base) {  // the merged run begins nearer
                        edge.c = arithmetic.mac(arithmetic.formats().edge_offset, edge.c, edge.b,
                                                before.base - voxel.base);
                    }
                    store.edges.push_back(edge);
                }
                before.edge_count += std::uint32_t(crossings);
                ++before.pieces;
            }
        }
        return true;
    }
    if (settings.voxel_capacity > 0 && store.voxels.size() >= std::size_t(settings.voxel_capacity)) {
        // A polygon's next piece would have joined the voxel that already did not fit.
        if (!mergeable || store.last_overflowed != span.polygon) ++store.overflowed;
        store.last_overflowed = span.polygon;
        return false;
    }
    set_functions(voxel, span, settings.normals, arithmetic);
    if (settings.hit == HitTest::edge && crossings > 0) {
        voxel.first_edge = std::uint32_t(store.edges.size());
        voxel.edge_count = std::uint32_t(crossings);
        voxel.pieces = 1;
        store.edges.insert(store.edges.end(), crossing.begin(), crossing.begin() + crossings);
    } else {
        voxel.first_edge = std::uint32_t(store.edges.size());
    }
    store.voxels.push_back(voxel);
    if (settings.display == Display::gouraud)
        store.intensities.push_back(arithmetic.hold(arithmetic.formats().intensity, span.intensity));
    return true;
}

void StorageCounts::add(const StorageCounts& other) {
    voxels += other.voxels;
    edges += other.edges;
    overflowed += other.overflowed;
    occupied_cells += other.occupied_cells;
    max_voxels = std::max(max_voxels, other.max_voxels);
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
    // One depth, one normal: the paper's voxel.
    bits.base = field::polygon_id + feature_bits(formats) + level_bits + 3 * word;
    if (settings.hit != HitTest::depth) bits.base += level_bits;
    // Two slopes and an offset; 3 bits for their axis and its sign.
    if (settings.hit >= HitTest::plane) bits.base += 3 * word + 3;
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
