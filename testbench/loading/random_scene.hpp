// Random polygons instead of a scene file, to study the pipeline apart from scenes.
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
    /// isotropic: all directions of the normal are equally likely, walls included. angle, slope: the
    /// polygon's angle with the screen, or the tangent of that angle, is uniform up to most_slope.
    Slopes slopes = Slopes::isotropic;
    double most_slope = 4;
    double depth = 64;  ///< of the cube, cells
    std::uint64_t seed = 1;
};

/// A scene of random polygons. Their centres lie anywhere in the cube; parts that reach over its faces are
/// cut. The polygons come object by object, divided as evenly as possible. Triangles have vertex normals of
/// their own. Throws std::invalid_argument where least_size is above most_size.
CellScene random_scene(const RandomPolygons& random, const PictureSettings& picture);

}  // namespace raycell::loading
