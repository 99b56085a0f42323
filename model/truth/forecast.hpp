// Forecasts the work of a run, to estimate its time beforehand: load messages from the outlines of the
// polygons, rays from a sample of pixels that are traced classically.
#pragma once

#include <cstdint>

#include "model/geometry/placement.hpp"
#include "model/settings/settings.hpp"
#include "model/truth/truth.hpp"

namespace raycell {

/// Expected counts, within a factor of two of the timed engine's in most scenes. Rays sent again are not
/// included: where M is small, a run makes more hops.
struct Forecast {
    double load_hops = 0;     ///< of load messages between cells
    double load_steps = 0;    ///< of trapezes down the chain of distributors
    double voxels = 0;        ///< stored; of the rungs from `interval` up
    double precast_hops = 0;  ///< of precast rays and their answers
    double trace_hops = 0;    ///< of all other rays and their answers

    double hops() const { return load_hops + precast_hops + trace_hops; }
};

/// Forecasts a run over this scene. `truth` must have been made from it; if null, or with --stage load,
/// nothing is traced. Looks at `samples` pixels, and at as many voxels for precast. The number of rays is
/// limited too, so that the forecast takes a fraction of a second; where trees are very large it is too low.
Forecast forecast(const CellScene& scene, const PictureSettings& settings, const TruthRenderer* truth,
                  int samples = 1024);

}  // namespace raycell
