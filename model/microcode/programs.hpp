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

/// Where a ray meets a voxel's plane, and whether that is in the cell and in the voxel's run: hit_voxel() at
/// rung `edge`, but for the edges. In: nx to nz, c (the plane, relative to the cell and to base), x to z, dx
/// to dz, base, near, far, end (the ray's distance to the cell's side), leaves (0, or 1: it starts from a
/// polygon, in this cell). Out: hit (0 or 1), t, px to pz (the place, for the edges).
MicroProgram plane_program(const MicroSetting& setting);

/// Whether a point is inside an edge, up to the hair. In: a, b, c, u, v (relative to the run's beginning).
/// Out: inside (0 or 1).
MicroProgram edge_program(const MicroSetting& setting);

/// Operators::reciprocal() of an accumulator's word x other than 0. Out: r (negative for negative x) and
/// exponent: 1/x = r · 2^exponent. Not for `rounded`: throws std::invalid_argument.
MicroProgram reciprocal_program(const MicroSetting& setting);

/// Operators::inverse_root() of a field's word x > 0. Out: r, exponent: 1/sqrt(x) = r · 2^exponent. Not for
/// `rounded`.
MicroProgram root_program(const MicroSetting& setting);

/// Arithmetic::normalise() of a vector x, y, z of a field's words. Out: nx, ny, nz.
MicroProgram normalise_program(const MicroSetting& setting);

/// The normal at (u, v) of a field, normalised. In: bx to bz, ux to uz, vx to vz, u, v. Out: nx, ny, nz.
MicroProgram normal_program(const MicroSetting& setting);

/// reflect_direction(). In: dx to dz, nx to nz. Out: rx, ry, rz.
MicroProgram reflect_program(const MicroSetting& setting);

/// refract_direction(). In: dx to dz, nx to nz, ior, entering (0 or 1). Out: total (1: totally reflected, and
/// nothing else), rx, ry, rz.
MicroProgram refract_program(const MicroSetting& setting);

/// The place of a hit: point_at(). In: x, y, z, dx, dy, dz, t. Out: px, py, pz.
MicroProgram point_program(const MicroSetting& setting);

/// What a lit source adds in local_intensity(), whose highlight is known. In: cosine, kd, cx to cz (the
/// object's colour), highlight, ix to iz (the source's intensity), sx to sz (the sum so far). Out: sx, sy,
/// sz.
MicroProgram light_program(const MicroSetting& setting);

/// combine_intensity() of one channel. In: local, mirror, transmit, reflected, refracted. Out: sum.
MicroProgram combine_program(const MicroSetting& setting);

}  // namespace raycell
