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

/// Whether a voxel's depth run meets the ray's. In: near, far, low, high. Out: meets (0 or 1).
MicroProgram run_program(const MicroSetting& setting);

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

/// view_source(), and its distance as a word of `reach`, whose largest counts as infinite. In: sx to sz (the
/// source's mantissas), exponent (Formats::place_exponent), px to pz (the point in the cell), "cell x",
/// "cell y", nx to nz. Out: lx to lz, cosine, reach.
MicroProgram source_program(const MicroSetting& setting);

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

/// combine_intensity() of one channel. In: local, mirror, transmit, reflected, refracted. Out: sum.
MicroProgram combine_program(const MicroSetting& setting);

}  // namespace raycell
