// The typed configuration of one run, with defaults; every module gets its own part by const reference.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/settings/costs.hpp"

namespace raycell {

enum class HitTest { depth, interval, plane, mask, edge };  ///< the ladder, cheapest first
enum class Normals { voxel, linear };
enum class Shadows { per_hit, precast, memo };
enum class ExteriorMode { none, host };
enum class Networks { shared, split, quadrant, half };
enum class Recovery { none, postpone };
enum class Slots { reserved, free, nested };  ///< which rays find a slot (cells/deadlock/deadlock.md)
enum class Numbers { fixed, exact };          ///< words of fixed length, or double precision
/// How a value is rounded to a word: to the nearest, ties to even (SystemC's SC_RND_CONV), or truncated
/// towards minus infinity (SC_TRN).
enum class Rounding { nearest, truncate };
enum class Engine { timed, untimed };
enum class RunStage { load, trace };
enum class Display { gouraud, phong };
enum class ViewerMode { scene, infinity };

/// A rectangle of cells, both ends included.
struct CellRange {
    int x0 = 0;
    int x1 = 0;
    int y0 = 0;
    int y1 = 0;
    bool contains(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }
};

/// The cell's arithmetic. The methods of the operators decide their cycles in exact arithmetic too.
struct NumberSettings {
    Numbers arithmetic = Numbers::fixed;
    int word_bits = 20;  ///< of messages, voxels and the ALU, 8..32
    Rounding rounding = Rounding::nearest;
    OperatorSettings operators;
};

/// Where the samples of a pixel lie closest: nowhere, or towards its middle.
enum class PixelFilter : std::uint8_t { box, tent };
constexpr int most_samples = 64;                               ///< of a pixel
constexpr std::uint64_t most_pixels = std::uint64_t(1) << 26;  ///< of a picture

/// Settings that the picture depends on: scene placement, voxels, ray tree. Both engines use all of them.
struct PictureSettings {
    int width = 128;   ///< cells, 1..4096
    int height = 128;  ///< cells, 1..4096
    /// Of the picture, a whole multiple of the cells each way, which may differ; 0: a pixel a cell.
    int pixels_wide = 0;
    int pixels_high = 0;
    /// Pixels of a cell, across and down: its block.
    int block_width() const { return pixels_wide > 0 ? pixels_wide / width : 1; }
    int block_height() const { return pixels_high > 0 ? pixels_high / height : 1; }
    int block() const { return block_width() * block_height(); }
    /// Primary rays that a cell has to send at most.
    int own_samples() const { return block() * samples; }
    int samples = 1;  ///< primary rays of a pixel, 1..64; their mean is the pixel's intensity
    PixelFilter filter = PixelFilter::box;
    /// A pixel whose first four samples differ by no more than this in any component of their intensities
    /// sends no others; negative: all pixels send all.
    double sample_until = -1;
    int depth_levels = 1024;  ///< 1..65536
    ViewerMode viewer = ViewerMode::scene;
    RunStage stage = RunStage::trace;
    Display display = Display::phong;
    HitTest hit = HitTest::edge;
    Normals normals = Normals::linear;
    Shadows shadows = Shadows::per_hit;
    int source_samples = 8;  ///< shadow rays from a hit to each source that is an area, 1..64
    ExteriorMode exterior = ExteriorMode::host;
    int max_depth = 4;              ///< generations after the primary ray, 0..62
    double min_weight = 1.0 / 256;  ///< a secondary ray that weighs less is not sent; 0: no cut
    /// Offset of a new ray's origin along the polygon's normal, to the side that the ray goes to, in cells;
    /// negative: as the arithmetic needs it.
    double normal_offset = -1;
    /// Pixels (of the shorter side, where they are not square); the polygons of a curved object lie within
    /// half of it on either side of the surface.
    double chord_error = 0.1;
    /// PSNR of the polygons' truth against the scene's that chooses a chord error per object, dB; 0: all
    /// objects have chord_error.
    double tessellate_for = 0;
    int voxel_capacity = 0;  ///< voxels a cell can hold; 0: unlimited
    NumberSettings numbers;
};

constexpr int most_units = 4;      ///< of a kind in a cell
constexpr int most_own_rays = 16;  ///< of a cell under way at once

/// Settings that only time depends on: by invariant 2 none of them changes the picture.
struct MachineSettings {
    int ray_store = 8;     ///< M, slots per cell, >= 1
    int buffer_depth = 2;  ///< messages per buffer, >= 1
    Networks networks = Networks::half;
    Recovery recovery = Recovery::postpone;
    Slots slots = Slots::reserved;
    /// Primary rays of a cell that may be under way at once, 1..most_own_rays; no more than it has pixels.
    int own_rays = 1;
    int link_bits = 20;  ///< bits that cross a link per cycle, >= 1
    /// Spans that a cell keeps until their voxels are made, those at work included, >= 1; 0: no limit. All
    /// but these stand in the voxels' memory.
    int load_queue = 0;
    /// Units of a cell that make voxels while the array is loaded, each one at a time, 1..most_units.
    int loading_units = 2;
    /// Units of a cell that test rays, each one at a time, 1..most_units.
    int traversal_units = 2;
    /// Cycles of the trace over which the primary rays' first starts are spread, by a hash of seed and pixel;
    /// 0: all start at once.
    std::uint32_t start_within = 0;
    int feed_lanes = 16;  ///< ways from geometry to the rows, >= 1; no more than there are rows are used
    int feed_bits = 128;  ///< bits that cross a link of the feed per cycle, >= 1
    double clock_mhz = 20;
    std::int64_t max_cycles = 0;     ///< 0: no limit
    int exterior_processors = 4096;  ///< >= 1
    int exterior_latency = 200;      ///< cycles per ray handed to an exterior processor, >= 1
    std::uint64_t seed = 1;          ///< of back-offs, starts and random stalls
    bool wire_check = false;         ///< rays and answers are packed and unpacked at every link
    /// Probability that a transfer over a link, or an operation of a unit, takes one more cycle; tried again
    /// after each.
    double stall = 0;
    CostTable costs;
};

}  // namespace raycell
