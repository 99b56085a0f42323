// Where the cube stands in the scene: world to cell coordinates, the screen, the primary rays.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/geometry/curved.hpp"
#include "model/geometry/polygon.hpp"
#include "model/geometry/scene.hpp"
#include "model/geometry/sources.hpp"
#include "model/numbers/arithmetic.hpp"
#include "model/settings/settings.hpp"

namespace raycell {

/// Similarity from world to cell coordinates (x right, y down, z into the screen, all in cell widths) and the
/// cube [0, width] x [0, height] x [0, depth]. The screen is z = 0 (design, section 3).
struct Frame {
    int width = 1;   ///< cells
    int height = 1;  ///< cells
    /// Pixels of a cell, across and down: its block. They are counted row by row from 0.
    int block_width = 1;
    int block_height = 1;
    double depth = 1;  ///< of the cube, in cell widths
    int depth_levels = 1;
    dvec3 right{1, 0, 0};    ///< unit, world
    dvec3 down{0, 1, 0};     ///< unit, world
    dvec3 forward{0, 0, 1};  ///< unit, world
    dvec3 corner{0, 0, 0};   ///< world point of cell coordinates (0, 0, 0)
    double cell_width = 1;   ///< world units
    bool viewer_at_infinity = false;
    dvec3 eye{0, 0, -1};  ///< cell coordinates; unused with the viewer at infinity

    dvec3 to_cells(const dvec3& world) const;
    dvec3 direction_to_cells(const dvec3& world) const;    ///< rotation only: unit stays unit
    double level() const { return depth / depth_levels; }  ///< height of a depth level, cell widths
    Box cube() const { return {{0, 0, 0}, {double(width), double(height), depth}}; }

    int block() const { return block_width * block_height; }
    int picture_width() const { return width * block_width; }
    int picture_height() const { return height * block_height; }
    /// Pixels along a cell's side, where they are finer.
    double pixels_per_cell() const { return std::max(block_width, block_height); }
    /// Index in the picture, row-major, of a pixel of cell (x, y)'s block.
    std::size_t pixel_index(int x, int y, int pixel) const {
        const int column = x * block_width + pixel % block_width;
        const int row = y * block_height + pixel / block_width;
        return std::size_t(row) * std::size_t(picture_width()) + std::size_t(column);
    }
    /// A place in a pixel of a block, from its corner in pixels, as cell widths from the cell's corner.
    dvec2 place_in_block(int pixel, const dvec2& in_pixel = {0.5, 0.5}) const {
        return {(pixel % block_width + in_pixel.x) / block_width,
                (pixel / block_width + in_pixel.y) / block_height};
    }
    /// A place in the picture's pixel (column, row), its centre unless said, in cell coordinates.
    dvec2 place_in_pixel(int column, int row, const dvec2& in_pixel = {0.5, 0.5}) const {
        return {(column + in_pixel.x) / block_width, (row + in_pixel.y) / block_height};
    }

    /// Origin on the screen and unit direction of the primary ray through (x, y), cell coordinates.
    struct PrimaryRay {
        dvec3 origin;
        dvec3 direction;
    };
    PrimaryRay primary_ray(double x, double y) const;
};

/// The dimensions that number formats depend on, for the frame's array.
inline ArrayExtent extent_of(const Frame& frame) {
    return {frame.width, frame.height, frame.depth, frame.level()};
}

/// Names of the cube's faces, in the order of CellScene::beyond.
enum Face { face_left, face_right, face_top, face_bottom, face_front, face_back };

/// The whole scene in cell coordinates, tessellated, not clipped: what the truth and the exterior see.
struct CellScene {
    Frame frame;
    dvec3 background{0, 0, 0};
    std::vector<Material> objects;
    std::vector<Source> sources;
    std::vector<Polygon> polygons;
    std::vector<CurvedSurface> curved;  ///< spheres and cones, which have polygons, too
    std::optional<Box> within;          ///< of a clipped scene: curved surfaces count inside it alone
    std::vector<std::string> warnings;  ///< what is not treated as written, for standard error
    std::array<bool, 6> beyond{};       ///< per Face: whether anything reaches beyond its plane
};

/// A frame of the settings' cells, pixels and levels, which stands nowhere yet. Throws std::invalid_argument
/// if the pixels are no whole multiple of the cells.
Frame array_frame(const PictureSettings& settings);

/// Sets up the frame for a scene: the screen stands where the visible scene begins, the back of the cube
/// where it ends. Throws std::invalid_argument if the scene has no view, and as array_frame() does.
Frame place_frame(const Scene& scene, const PictureSettings& settings);

/// Tessellates the whole scene into a frame. `chord_errors`, in pixels, has one for every primitive, or is
/// empty: all have that of the settings. Throws std::invalid_argument for more than max_sources sources.
CellScene place_scene(const Scene& scene, const Frame& frame, const PictureSettings& settings,
                      const std::vector<double>& chord_errors = {});

}  // namespace raycell
