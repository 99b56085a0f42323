// Cycles per operation of every unit: the one place where time comes from (design, section 6).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace raycell {

/// All values are cycles. Override from the command line or the configuration: --cost NAME=CYCLES.
struct CostTable {
    // Traversal unit: the incremental walk (Amanatides & Woo 1987) and the comparisons with voxels.
    std::uint32_t walk_step = 4;      ///< next crossing, position on it, cube test
    std::uint32_t compare_depth = 1;  ///< per voxel at each rung
    std::uint32_t compare_interval = 2;
    std::uint32_t compare_plane = 8;  ///< two dot products and a division
    std::uint32_t compare_mask = 9;
    std::uint32_t compare_edge = 8;  ///< plus per_edge for every edge that crosses the cell
    std::uint32_t per_edge = 2;
    // Shading unit: the microprogrammed ALU.
    std::uint32_t shade_setup = 20;    ///< hit point, normal turned to the ray
    std::uint32_t normal_linear = 12;  ///< interpolate and normalise
    std::uint32_t source_view = 16;    ///< direction and distance to one source, N·L
    std::uint32_t reflect = 8;
    std::uint32_t refract = 24;
    std::uint32_t local_intensity = 6;  ///< ambient and the final sums
    std::uint32_t per_lit_source = 20;  ///< diffuse, R·L and its power
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

    /// Every entry by name, for --help, the configuration file and overrides.
    static std::vector<std::pair<std::string, std::uint32_t CostTable::*>> entries();
    /// Sets "name=cycles"; throws std::invalid_argument naming the entry and what was allowed.
    void set(const std::string& assignment);
};

}  // namespace raycell
