// How fine each curved object must be, for the accuracy that is asked for.
#pragma once

#include <string>
#include <vector>

#include "model/geometry/placement.hpp"

namespace raycell {

/// A chord error for every primitive, pixels, that costs few voxels for the accuracy
/// (docs/measured/tessellation.md). `level` is that of spheres; none is below `least` or above
/// `coarsest_chord_error`.
std::vector<double> chord_errors_at(const Scene& scene, const Frame& frame, double level, double least);

constexpr double coarsest_chord_error = 0.5;  ///< pixels
constexpr double finest_chord_error = 1e-3;   ///< pixels

/// The least chord error that words can tell from none, pixels: both sides of a surface one step of a place
/// in a cell apart.
double told_chord_error(const Frame& frame, const PictureSettings& settings);

struct Fineness {
    std::vector<double> chord_errors;  ///< of every primitive; empty for a scene without curved ones
    double level = 0;                  ///< that of the spheres, pixels
    double psnr_db = 200;  ///< of the polygons' truth against the scene's, where they were compared
    bool reached = true;   ///< psnr_db is no more than 0.5 below what was asked for
};

/// Chooses the coarsest polygons whose truth has settings.tessellate_for dB of PSNR against the scene's;
/// outside the cube the scene itself is met, if there is an exterior. It tries levels and compares the
/// pixels' centres, 256 x 256 of them at most, spread evenly. Takes as long as some ten pictures of that
/// size; the result does not depend on `threads` (0: as many as there are).
Fineness fineness_for(const Scene& scene, const Frame& frame, const PictureSettings& settings,
                      int threads = 0);

}  // namespace raycell
