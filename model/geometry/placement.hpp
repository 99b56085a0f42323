// Where the cube stands in the scene: world to cell coordinates, the screen, the primary rays.
#pragma once

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
    int width = 1;     ///< cells
    int height = 1;    ///< cells
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

    /// Origin on the screen and unit direction of the primary ray through (x, y) cells, pixel centre at +0.5.
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

/// Sets up the frame for a scene: the screen stands where the visible scene begins, the back of the cube
/// where it ends. Throws std::invalid_argument if the scene has no view.
Frame place_frame(const Scene& scene, const PictureSettings& settings);

/// Tessellates the whole scene into a frame. `chord_errors`, in cells, has one for every primitive, or is
/// empty: all have that of the settings. Throws std::invalid_argument for more than max_sources sources.
CellScene place_scene(const Scene& scene, const Frame& frame, const PictureSettings& settings,
                      const std::vector<double>& chord_errors = {});

}  // namespace raycell
