// The trials, by file.
#pragma once

#include "testbench/microcode/trials.hpp"

namespace raycell {

using TrialList = std::vector<std::unique_ptr<MicroTrial>>;

TrialList traversal_trials(const MicroSetting& setting);  ///< the walk, the rungs' tests
TrialList ray_trials(const MicroSetting& setting);        ///< a hit's setup, sources, new rays, answers
TrialList loading_trials(const MicroSetting& setting);    ///< a span's way, voxels
TrialList joining_trials(const MicroSetting& setting);    ///< pieces, the index table, features, sources
TrialList shading_trials(const MicroSetting& setting);    ///< operators, directions, intensities
TrialList source_trials(const MicroSetting& setting);     ///< sources that are no points
/// Every rung with either kind of normals, which the cost table does not tell apart.
TrialList loading_variants(const MicroSetting& setting);

/// A unit vector; some components are 0 or small.
dvec3 any_direction(MicroRandom& random, const Arithmetic& arithmetic);

}  // namespace raycell
