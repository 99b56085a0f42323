// Cycles per operation of every unit: the only source of times (design, section 6).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace raycell {

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

/// All values are cycles. Override from the command line or the configuration: --cost NAME=CYCLES.
struct CostTable {
    // Traversal unit: the incremental walk (Amanatides & Woo 1987) and the comparisons with voxels.
    std::uint32_t walk_step = 4;         ///< next crossing, position on it, cube test
    std::uint32_t compare_depth = 1;     ///< compares a voxel's run with the ray's, rung `depth`
    std::uint32_t compare_interval = 2;  ///< the same, the other rungs
    // Per voxel whose run meets the ray's. A reciprocal is added to each; rungs `depth` and `interval` cost
    // the reciprocal alone.
    std::uint32_t compare_plane = 4;  ///< two dot products
    std::uint32_t compare_mask = 5;
    std::uint32_t compare_edge = 4;  ///< plus per_edge for every edge that crosses the cell
    std::uint32_t per_edge = 2;
    // Shading unit: the microprogrammed ALU.
    std::uint32_t shade_setup = 20;     ///< hit point, normal turned to the ray
    std::uint32_t normal_linear = 7;    ///< interpolate; plus a root
    std::uint32_t source_view = 11;     ///< direction and distance to one source, N·L; plus a root
    std::uint32_t reflect = 6;          ///< plus a root, and a ray's start: two reciprocals
    std::uint32_t refract = 12;         ///< plus a reciprocal, two roots and a ray's start
    std::uint32_t local_intensity = 6;  ///< ambient and the final sums
    std::uint32_t per_lit_source = 14;  ///< diffuse, R·L; plus its power
    // Operators, by method (--reciprocal, --root, --power).
    std::uint32_t reciprocal_newton = 4;    ///< look-up, interpolation, two multiplications
    std::uint32_t reciprocal_table = 2;     ///< look-up and interpolation
    std::uint32_t reciprocal_rounded = 20;  ///< one digit per cycle
    std::uint32_t root_newton = 5;
    std::uint32_t root_table = 2;
    std::uint32_t root_rounded = 20;
    std::uint32_t power_tables = 6;   ///< two look-ups with interpolation, a multiplication, shifts
    std::uint32_t power_schlick = 3;  ///< plus a reciprocal
    std::uint32_t power_rounded = 60;
    // Router and ray store.
    std::uint32_t route_return = 1;  ///< an answer from its arrival to an output or home
    std::uint32_t backoff = 64;      ///< shortest wait before a postponed ray is sent again
    // Loading.
    std::uint32_t load_voxel = 12;   ///< a cell makes its voxel and advances the span
    std::uint32_t load_forward = 1;  ///< a cell latches or only passes a load message
    std::uint32_t geometry_polygon = 40;
    std::uint32_t precomputation_trapeze = 20;
    std::uint32_t distribution_span = 8;  ///< a row cuts its span from a trapeze
    std::uint32_t distribution_pass = 1;

    /// Cycles of an operator, by its method.
    std::uint32_t reciprocal(const OperatorSettings& operators) const;
    std::uint32_t root(const OperatorSettings& operators) const;
    std::uint32_t power(const OperatorSettings& operators) const;

    /// Every entry by name, for --help, the configuration file and overrides.
    static std::vector<std::pair<std::string, std::uint32_t CostTable::*>> entries();
    /// Sets "name=cycles"; throws std::invalid_argument naming the entry and what was allowed.
    void set(const std::string& assignment);
};

}  // namespace raycell
