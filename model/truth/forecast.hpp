// What a run will take, foretold from the scene: messages of the loading from the outlines of its polygons,
// rays from a sample of pixels that are traced classically. For estimates of time before a run.
#pragma once

#include <cstdint>

#include "model/geometry/placement.hpp"
#include "model/settings/settings.hpp"
#include "model/truth/truth.hpp"

namespace raycell {

/// Expected counts, within a factor of two of the timed engine's in most scenes. Postponed rays are not
/// foretold: where M is scarce a run makes more hops.
struct Forecast {
    double load_hops = 0;     ///< of load messages between cells
    double load_steps = 0;    ///< of trapezes down the chain of distributors
    double voxels = 0;        ///< stored; of the rungs from `interval` up
    double precast_hops = 0;  ///< of precast rays and their answers
    double trace_hops = 0;    ///< of all other rays and their answers

    double hops() const { return load_hops + precast_hops + trace_hops; }
};

/// Foretells a run over this scene. `truth` must have been made of it; null, or --stage load: nothing is
/// traced. `samples` pixels, and as many voxels for precast, are looked at; their rays are limited, too, so
/// that the forecast takes a fraction of a second even where trees are very large (what it says is too
/// little then).
Forecast forecast(const CellScene& scene, const PictureSettings& settings, const TruthRenderer* truth,
                  int samples = 1024);

}  // namespace raycell
