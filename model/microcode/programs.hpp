// The microprograms of a cell, each for the function of the model that it equals bit for bit.
#pragma once

#include "model/microcode/program.hpp"
#include "model/numbers/arithmetic.hpp"

namespace raycell {

/// A machine's numbers and its datapath.
struct MicroSetting {
    NumberSettings numbers;
    ArrayExtent extent;
    Datapath datapath;

    Formats formats() const { return Formats(numbers.word_bits, numbers.rounding, extent); }
};

/// The widest operand of a multiplication: a distance, or a depth relative to a run.
int widest_operand(const Formats& formats);

// Registers are named as below; what a program reads is put there before, what it gives is there afterwards.

/// next_crossing(), cross(), and whether the ray leaves the cube or reaches its source before. In and out: x,
/// y, z, dx, dy, dz; mx, ex, my, ey (1/|d| = m · 2^e), reach. Out: t, side, flags (0; 1: leaves the cube; 2:
/// axial, nothing else is set), left (reach − t, where reach is not infinite). `depth`: of the cube.
MicroProgram walk_program(const MicroSetting& setting, double depth);

/// way_out() of a ray that leaves the cube in this cell, and start_outside(). In: x to z, dx to dz, reach, t
/// (of the crossing), axial (1: it has none). Out: t, x to z, left and reach as the walk's.
MicroProgram leave_program(const MicroSetting& setting, double depth);

/// Whether a voxel's depth run meets that of a ray that goes to the back, or (`outwards`) to the front. In:
/// near, far, low, high; outwards also most (of the voxel's line of the index table). Out: meets (0 or 1; 2:
/// neither this one does nor any after it).
MicroProgram run_program(const MicroSetting& setting, bool outwards);

/// Whether a voxel goes before a line of the index table, which then moves up by one. In: near, far (the
/// voxel's), "line near", most (of the line). Out: before (0 or 1), most (of the line where it stands now).
MicroProgram order_program(const MicroSetting& setting);

/// Where a ray enters a voxel's run: hit_voxel() at rungs `depth` and `interval`. In: z, dz, z1 (the depth at
/// the cell's side), near, far, end (the ray's distance to that side). Out: hit (0 or 1), t.
MicroProgram enter_program(const MicroSetting& setting, HitTest rung);

/// Where a ray meets a voxel's plane, and whether that is in the cell and in the voxel's run: hit_voxel() at
/// rungs `plane` and `mask`, and at `edge`, but for the edges. In: nx to nz, c (the plane, relative to the
/// cell and to base), x to z, dx to dz, base, near, far, end, leaves (0, or 1: it starts from a polygon, in
/// this cell); but for `edge` also front (1: it leaves that polygon's front). `mask` also: mask, "u from", "u
/// to", "v from", "v to" (the window), "drop x", "drop z" (1: that axis is dropped; both 0: y). Out: hit (0
/// or 1), t, px to pz (the place, for the edges).
MicroProgram plane_program(const MicroSetting& setting, HitTest rung);

/// Whether a point is inside an edge, up to the hair. In: a, b, c, u, v (relative to the run's beginning).
/// Out: inside (0 or 1).
MicroProgram edge_program(const MicroSetting& setting);

// What else a visit of a ray in a cell computes (visit_cell(), nearest_in_cell()); the cost table has no
// entries for these.

/// The ray ends at its source, in this cell. In: reach, z, dz. Out: t, z1 (the depth there).
MicroProgram reached_program(const MicroSetting& setting);

/// The ray's depths in the cell, with a hair on both sides. In: z, z1. Out: low, high.
MicroProgram range_program(const MicroSetting& setting, double hair);

/// These depths end at a hit, a tie beyond it. In: z, dz, t, low, high. Out: low, high.
MicroProgram narrow_program(const MicroSetting& setting, double tie);

/// Whether a hit replaces the nearest one so far. In: t, best (its t), lower (1: its polygon's id is lower).
/// Out: nearer (0 or 1).
MicroProgram nearer_program(const MicroSetting& setting, double tie);

/// Whether a hit is at the source or beyond it. In: t, reach. Out: there (0 or 1).
MicroProgram at_source_program(const MicroSetting& setting, double hair);

/// A point in a voxel's projection. In: px to pz, base, "drop x", "drop z". Out: u, v.
MicroProgram projection_program(const MicroSetting& setting);

/// view_source(), and its distance as a word of `reach`, whose largest counts as infinite. In: sx to sz (the
/// source's mantissas), exponent (Formats::place_exponent), px to pz (the point in the cell), "cell x",
/// "cell y", nx to nz. Out: lx to lz, cosine, reach.
MicroProgram source_program(const MicroSetting& setting);

/// N·L of a directional source: view_source(). In: ax to az (its axis), nx to nz. Out: cosine.
MicroProgram facing_program(const MicroSetting& setting);

/// What a spot sends this way beside its power: the emission of view_source(). In: ax to az (its axis), lx to
/// lz (the direction to it), cut-off, falloff (Operators::exponent_word). Out: emission. For a power that is
/// `rounded`, also in: power. Without a power it is what a flat area sends.
MicroProgram emission_program(const MicroSetting& setting);

/// shift_of() a voxel. In: polygon, x, y. Out: u, v.
MicroProgram shift_program(const MicroSetting& setting);

/// The next sample of a flat area and its place: sample_of(). In: u, v (of the one before, not shifted),
/// "step u", "step v", "shift u", "shift v", fold (1: a triangle), cx to cz, "u x" to "u z", "v x" to "v z"
/// (mantissas of one exponent). Out: u, v, sx to sz (mantissas of that exponent).
MicroProgram sample_program(const MicroSetting& setting);

/// The axes of the disc that a sphere is from a point. In: wx to wz (the way to its middle, mantissas of an
/// accumulator's bits). Out: tx to tz, bx to bz.
MicroProgram disc_axes_program(const MicroSetting& setting);

/// The next sample of a sphere and its place: sample_of(). In: as of `sample`, tx to tz, bx to bz, radius, cx
/// to cz (mantissas of one exponent). Out: u, v, sx to sz.
MicroProgram disc_program(const MicroSetting& setting);

/// What a lit sample adds to its source's sums, beside the power. In: cosine, lx to lz, rx to rz (the
/// mirrored ray), ks, shine, diffuse, highlight (the sums). Out: diffuse, highlight. For a power that is
/// `rounded`, also in: power.
MicroProgram lit_sample_program(const MicroSetting& setting);

/// The means of a source's samples. In: diffuse, highlight (the sums), share, "share exponent" (1 / samples =
/// share · 2^it). Out: "mean diffuse", "mean highlight".
MicroProgram mean_program(const MicroSetting& setting);

/// A spot's shares in local_intensity(). In: emission, cosine, highlight (the power of R·L). Out: cosine,
/// highlight.
MicroProgram emitted_program(const MicroSetting& setting);

/// The start of a child: set_direction(), its place off the surface, its weight. In: dx to dz, px to pz (the
/// hit), nx to nz (the polygon's plane), weight (the parent's), share. Out: x to z, front (1: it goes to the
/// plane's front), weight, mx, ex, my, ey (1/|d| = m · 2^e, 0 for 0).
MicroProgram start_program(const MicroSetting& setting, double normal_offset);

/// Where an answer goes from cell (x, y): along x, then along y. In: x, y, "home x", "home y". Out: way (a
/// side's number; 4: it is home).
MicroProgram route_program(const MicroSetting& setting);

/// Operators::reciprocal() of an accumulator's word x other than 0. Out: r (negative for negative x) and
/// exponent: 1/x = r · 2^exponent.
MicroProgram reciprocal_program(const MicroSetting& setting);

/// Operators::inverse_root() of a field's word x > 0. Out: r, exponent: 1/sqrt(x) = r · 2^exponent.
MicroProgram root_program(const MicroSetting& setting);

/// Operators::power(). In: base (a unit word), shine (Operators::exponent_word). Out: power. Throws
/// std::invalid_argument for `rounded`: a library function of the model, whose last bit no number of digits
/// settles for certain.
MicroProgram power_program(const MicroSetting& setting);

/// Arithmetic::normalise() of a vector x, y, z of a field's words. Out: nx, ny, nz.
MicroProgram normalise_program(const MicroSetting& setting);

/// The normal at (u, v) of a field, not normalised. In: bx to bz, ux to uz, vx to vz, u, v. Out: fx, fy, fz.
MicroProgram normal_program(const MicroSetting& setting);

/// reflect_direction(). In: dx to dz, nx to nz. Out: rx, ry, rz.
MicroProgram reflect_program(const MicroSetting& setting);

/// transmit_direction(). In: dx to dz, nx to nz, ior, entering (0 or 1). Out: total (1: totally reflected),
/// rx, ry, rz.
MicroProgram refract_program(const MicroSetting& setting);

/// When a hit's children are worth sending.
struct ChildLimits {
    int max_depth = 4;
    double min_weight = 1.0 / 256;
};

/// The hit's point, its normal turned to the ray (shade_point()), which children are worth sending. In: x to
/// z, dx to dz, t, fx to fz (the field's normal), gx to gz (the plane's), weight, generation, mirror,
/// transmit (their shares). Out: px to pz, nx to nz, entering, reflects, refracts (0 or 1).
MicroProgram setup_program(const MicroSetting& setting, const ChildLimits& limits);

/// The ambient part of local_intensity(). In: kd, cx to cz. Out: sx, sy, sz.
MicroProgram ambient_program(const MicroSetting& setting);

/// What a lit source adds in local_intensity(). In: cosine, lx to lz (its direction), rx to rz (the mirrored
/// ray), kd, ks, shine, cx to cz (the object's colour), ix to iz (the source's intensity), sx to sz (the sum
/// so far). Out: sx, sy, sz. For a power that is `rounded`, also in: power.
MicroProgram light_program(const MicroSetting& setting);

/// The depth levels of a cube.
struct DepthLevels {
    double level = 1;  ///< height, cells: a mantissa of 16 bits
    int count = 1;
};

// Loading. A span, below: "drop x", "drop z" (1: that axis of the plane is dropped; both 0: y), negative (1:
// the normal's component there is -1), nu, nv, c (its other two, its offset), slack, edges (how many), "edge
// a 0", "edge b 0", "edge c 0" and so on; normals: bx to bz, ux to uz, vx to vz. At rung `depth`: "drop x",
// "drop z", z, dz, nx to nz, dnx to dnz, normals; its slopes are words that are kept as they are.

/// Whether a load message makes a voxel in a cell. In: type (5: a span), x (of the span), column. Out: makes.
MicroProgram forward_program(const MicroSetting& setting);

/// Moves a span to the next cell: advance(). In: a span, its x and last, normals. Out: passes (0: that was
/// its last cell, nothing else is set), x, c, "edge c 0" and so on, bx to bz; rung `depth`: x, z, nx to nz
/// (`voxel`), bx to bz (`linear`).
MicroProgram advance_program(const MicroSetting& setting, HitTest rung, Normals normals);

/// Cuts a part by a line, as part_in() does. In: "u 0", "v 0" and so on (the corners, two banks of 10),
/// corners (how many), begin (number of the first: 0 or 10), other (where the other bank begins), "line a" to
/// "line c". Out: corners, begin (0 and 10 exchanged if the line cuts).
MicroProgram cut_program(const MicroSetting& setting);

/// part_in() of a span and a cell. In: a span. Out: made (0: there is no part), corners, "z low", "z high",
/// "middle u", "middle v", "twice area".
MicroProgram part_program(const MicroSetting& setting, const DepthLevels& levels);

/// The run of a part. In: "z low", "z high", slack, "drop z". Out: "near level", "far level", near, far.
MicroProgram levels_program(const MicroSetting& setting, const DepthLevels& levels);

/// One edge of a voxel. In: "line a" to "line c" (the span's edge), near, far, "drop z". Out: "held a" to
/// "held c".
MicroProgram edge_of_voxel_program(const MicroSetting& setting);

/// The plane of a voxel. In: nu, nv, c, negative, "drop z", near, "point u", "anchor v" (the voxel's point
/// from the run's beginning). Out: "plane u", "plane v", "plane c".
MicroProgram plane_of_voxel_program(const MicroSetting& setting);

/// The normals of a voxel. In: normals, "drop z", near, "point u", "point v", "anchor v". Out: "normal bx" to
/// "normal bz", "normal ux", "normal vx" and so on.
MicroProgram normal_of_voxel_program(const MicroSetting& setting, Normals normals);

/// What a cell does with a span that it keeps: the first piece of a polygon in the cell. In: a span,
/// normals. Out: made (0: the polygon does not touch the cell); that of `levels`, the voxel's
/// plane and normals, "point u", "point v", "twice area", corners, crossings (how many edges), "kept a 0" and
/// so on (the edges). At rung `mask` without the mask.
MicroProgram voxel_program(const MicroSetting& setting, const DepthLevels& levels, HitTest rung,
                           Normals normals);

// What else a cell computes for its voxels; the cost table has no entries for these.

/// Another piece of a polygon joins its voxel, but for plane, normals and edges. In: "near level", "far
/// level", near, "point u", "point v", "twice area", "drop z" (the voxel's), the first five of the piece with
/// "piece" before ("piece near level"), "piece area". Out: "near level", "far level", near, far, "point u",
/// "point v", "anchor v", "twice area", way and "piece way" (how far the beginning of the voxel's run, and of
/// the piece's, moved).
MicroProgram join_program(const MicroSetting& setting, const DepthLevels& levels);

/// A plane's normal from its slopes. In: "plane u", "plane v", negative, "drop x", "drop z". Out: nx to nz.
MicroProgram components_program(const MicroSetting& setting);

/// An edge's offset when the beginning of its run moves along v. In: b, c, way. Out: c.
MicroProgram move_edge_program(const MicroSetting& setting);

/// The largest far up to a line of the index table. In: most, far. Out: most.
MicroProgram widen_program(const MicroSetting& setting);

/// The power of a highlight as the shading reads it (Operators::exponent_word). In: exponent, fraction (as
/// the features carry it). Out: shine.
MicroProgram shine_program(const MicroSetting& setting);

/// A source's place with an exponent that all coordinates of the array have room in
/// (Formats::place_exponent). In and out: sx to sz, exponent.
MicroProgram source_place_program(const MicroSetting& setting);

/// combine_intensity() of one channel. In: local, mirror, transmit, reflected, refracted. Out: sum.
MicroProgram combine_program(const MicroSetting& setting);

// What the shading unit computes besides; the cost table has no entries for these.

/// Where a hit is in its voxel's projection: before its setup, which needs the normal there. In: x to z, dx
/// to dz, t, base, "drop x", "drop z". Out: u, v (as `normal` takes them).
MicroProgram place_program(const MicroSetting& setting);

/// combine_intensity() of all channels. In: mirror, transmit, "local x" to "local z", "reflected x" and so
/// on, "refracted x" and so on. Out: "sum x" to "sum z".
MicroProgram total_program(const MicroSetting& setting);

/// No instruction: for calls that only copy.
MicroProgram nothing_program(const MicroSetting& setting);

}  // namespace raycell
