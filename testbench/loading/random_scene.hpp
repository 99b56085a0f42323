// Polygons drawn instead of read, so that the pipeline can be studied apart from scenes.
#pragma once

#include "model/geometry/placement.hpp"

namespace raycell::loading {

enum class Sizes { log, uniform };
enum class Slopes { isotropic, angle, slope };

struct RandomPolygons {
    int count = 0;  ///< 0: none, the scene comes from a file
    int sides = 3;  ///< corners of each polygon, 3..16
    int objects = 8;
    double least_size = 1;  ///< diameter of the circle that a polygon's corners lie on, cells
    double most_size = 16;
    Sizes sizes = Sizes::log;
    /// isotropic: every direction of the normal alike, walls included; angle, slope: the polygon's angle with
    /// the screen, or the tangent of that angle, uniform up to most_slope.
    Slopes slopes = Slopes::isotropic;
    double most_slope = 4;
    double depth = 64;  ///< of the cube, cells
    std::uint64_t seed = 1;
};

/// Polygons with their centres anywhere in the cube: those that reach over its faces are cut. They come
/// object by object, as evenly as they can. Triangles have normals of their own at their corners. Throws
/// std::invalid_argument where least_size is above most_size.
CellScene random_scene(const RandomPolygons& random, const PictureSettings& picture);

}  // namespace raycell::loading
