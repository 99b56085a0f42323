// What the runs of a sweep have given: rows, a table of machines, a chart.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "testbench/sweep/design.hpp"

namespace raycell {

/// What a sweep keeps of a run's report. Bits are those of a cell, of one with four neighbours.
struct SweepRow {
    SweepPoint point;
    std::string verdict;
    double completed = 0;  ///< share of the pixels
    std::uint64_t load_cycles = 0;
    std::uint64_t cycles = 0;  ///< precast and trace
    std::uint64_t rays_sent = 0;
    std::uint64_t postponed = 0;
    std::uint64_t ray_store_peak = 0;
    double ray_store_mean = 0;
    std::uint64_t buffer_bits = 0;
    std::uint64_t ray_store_bits = 0;
    std::uint64_t register_bits = 0;
    std::uint64_t voxel_bits = 0;  ///< of the fullest cell
    std::uint64_t cell_bits() const { return buffer_bits + ray_store_bits + register_bits + voxel_bits; }
    bool certain = false;  ///< proved to end in any scene, not only seen to
    std::uint64_t knot_cells = 0;
    std::string psnr;  ///< dB, with --truth; else empty
    std::string image_hash;
    std::string schedule_hash;
};
/// Throws std::runtime_error for a report that lacks something.
SweepRow row_of(const SweepPoint& point, const nlohmann::ordered_json& report);

/// A line per run: the axes of several values, then what SweepRow has.
std::string sweep_csv(const SweepDesign& design, const std::vector<SweepRow>& rows);

/// Runs that differ in nothing but their seed.
struct SweepMachine {
    std::vector<const SweepRow*> runs;
    bool safe() const;             ///< all completed
    std::string verdicts() const;  ///< "completed", "3 completed, 2 deadlock"
    /// Median over the runs that completed.
    std::optional<std::uint64_t> cycles() const;
};
std::vector<SweepMachine> machines_of(const SweepDesign& design, const std::vector<SweepRow>& rows);

/// Markdown: a row per machine with verdicts, cycles and bits; with several M, the smallest from which on
/// every larger one completed, for each of the other combinations.
std::string sweep_table(const SweepDesign& design, const std::vector<SweepRow>& rows);

/// SVG: share of the runs that completed and median cycles, over the axis of most values; a line for each
/// combination of the others. Empty if no axis has several values.
std::string sweep_chart(const SweepDesign& design, const std::vector<SweepRow>& rows);

}  // namespace raycell
