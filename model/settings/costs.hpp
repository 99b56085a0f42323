// Cycles per operation of every unit: the only source of times (design, section 6).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace raycell {

enum class HitTest;  // settings.hpp

enum class Iteration { newton, table, rounded };      ///< how reciprocal and 1/sqrt are computed
enum class PowerMethod { tables, schlick, rounded };  ///< how base^exponent is computed

/// How the cell computes operations that its ALU has no instruction for. `newton`: one step from a table with
/// linear interpolation; `table`: the table alone; `rounded`: the nearest word, digit by digit. Power:
/// `tables` of log2 and exp2 with linear interpolation; `schlick`: b / (n - n*b + b) (Schlick 1994).
struct OperatorSettings {
    Iteration reciprocal = Iteration::newton;
    Iteration root = Iteration::newton;
    PowerMethod power = PowerMethod::tables;
    /// Entries, a power of two from 4 to 4096; 0: what the word length needs (table_sizes), at 20 bits 64,
    /// 64, 32.
    int reciprocal_table = 0;
    int root_table = 0;
    int power_table = 0;  ///< of each of the two tables
};

/// What the cycles are counted for: a datapath with one multiplier of words, one with a multiplier that takes
/// a distance whole, one with two multipliers of words (model/microcode/datapath.hpp); or the estimates by
/// hand that the table had before there were programs.
enum class CostBasis { word, wide, two, estimate };

/// All values are cycles. 0 makes leave_cube, mirrored and light_again free, their operators included.
/// Override from the command line or the configuration: --cost NAME=CYCLES. What a microprogram exists for is
/// its mean at words of 20 bits, less the operators that are added apart (docs/reference/microcode.md); the
/// rest are estimates whatever the basis: power_rounded, backoff, and the stages before the array.
struct CostTable {
    // Traversal unit: the incremental walk (Amanatides & Woo 1987) and the comparisons with voxels.
    std::uint32_t walk_step;         ///< next crossing, position on it, cube test
    std::uint32_t leave_cube;        ///< where a ray leaves through front or back; plus a reciprocal
    std::uint32_t compare_depth;     ///< compares a voxel's run with the ray's, rung `depth`
    std::uint32_t compare_interval;  ///< the same, the other rungs
    // Per voxel whose run meets the ray's. A reciprocal is added to each.
    std::uint32_t enter_run;      ///< where the ray enters the run, rungs `depth` and `interval`
    std::uint32_t compare_plane;  ///< two dot products
    std::uint32_t compare_mask;
    std::uint32_t compare_edge;  ///< plus per_edge for every edge that crosses the cell
    std::uint32_t per_edge;
    // Shading unit: the microprogrammed ALU.
    std::uint32_t shade_setup;      ///< hit point, unit normal turned to the ray; plus a root
    std::uint32_t normal_linear;    ///< interpolates the normal
    std::uint32_t source_view;      ///< direction and distance to one source, N·L; plus a root
    std::uint32_t ray_start;        ///< a new ray's place and weight; plus two reciprocals
    std::uint32_t reflect;          ///< plus a root and a ray's start
    std::uint32_t refract;          ///< plus a reciprocal, two roots and a ray's start
    std::uint32_t local_intensity;  ///< ambient and the final sums
    std::uint32_t per_lit_source;   ///< diffuse, R·L; plus its power
    std::uint32_t mirrored;         ///< direction for highlights where no reflected child has it; plus a root
    std::uint32_t light_again;      ///< a lit source's direction, which a slot does not keep; plus a root
    // Sources that are no points.
    std::uint32_t source_facing;    ///< N·L of a directional source, instead of source_view
    std::uint32_t source_emission;  ///< what is sent this way, beside source_view; of a spot plus a power
    std::uint32_t emitted;          ///< a lit light's share of N·L and of its highlight: spots, flat areas
    std::uint32_t sample_shift;     ///< of a hit's samples
    std::uint32_t sample_place;     ///< a sample's place on a flat area
    std::uint32_t disc_axes;        ///< of a sphere, once for all its samples; plus two roots
    std::uint32_t disc_place;       ///< a sample's place on a sphere; plus a root
    std::uint32_t per_lit_sample;   ///< adds a lit sample to its source's, beside its power
    std::uint32_t sample_mean;      ///< of a source with lit samples, beside per_lit_source
    // Operators, by method (--reciprocal, --root, --power).
    std::uint32_t reciprocal_newton;   ///< look-up, interpolation, two multiplications
    std::uint32_t reciprocal_table;    ///< look-up and interpolation
    std::uint32_t reciprocal_rounded;  ///< digit by digit
    std::uint32_t root_newton;
    std::uint32_t root_table;
    std::uint32_t root_rounded;
    std::uint32_t power_tables;   ///< two look-ups with interpolation, a multiplication, shifts
    std::uint32_t power_schlick;  ///< plus a reciprocal
    std::uint32_t power_rounded;
    // Router and ray store.
    std::uint32_t route_return;  ///< an answer from its arrival to an output or home
    std::uint32_t backoff;       ///< shortest wait before a postponed ray is sent again
    // Loading.
    std::uint32_t load_depth;  ///< a cell makes its voxel from a span, rung `depth`
    std::uint32_t load_interval;
    std::uint32_t load_plane;
    std::uint32_t load_mask;
    std::uint32_t load_edge;
    std::uint32_t load_order;    ///< a line of the index table that a voxel passes on its way to its place
    std::uint32_t load_advance;  ///< moves a span on to the next cell, beside the making of its voxel
    std::uint32_t load_forward;  ///< a cell latches or only passes a load message
    std::uint32_t geometry_polygon;
    std::uint32_t geometry_skip;  ///< finds that an object or a polygon has no part in a lane's rows
    std::uint32_t precomputation_trapeze;
    std::uint32_t distribution_span;  ///< a row cuts its span from a trapeze
    std::uint32_t distribution_pass;
    CostBasis basis;  ///< of the entries that are not set apart

    CostTable() : CostTable(CostBasis::word) {}
    explicit CostTable(CostBasis basis);

    /// Cycles in which a cell makes a voxel of a rung.
    std::uint32_t load_voxel(HitTest rung) const;
    /// Cycles of an operator, by its method.
    std::uint32_t reciprocal(const OperatorSettings& operators) const;
    std::uint32_t root(const OperatorSettings& operators) const;
    std::uint32_t power(const OperatorSettings& operators) const;

    /// Every entry by name, for --help, the configuration file and overrides.
    static std::vector<std::pair<std::string, std::uint32_t CostTable::*>> entries();
    /// The entries that are counted from microprograms, of a cell: the others are estimates.
    static std::vector<std::string> counted();
    /// Sets "name=cycles"; throws std::invalid_argument naming the entry and what was allowed.
    void set(const std::string& assignment);
};

}  // namespace raycell
