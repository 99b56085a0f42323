// The parts of a machine and the links between them.
#pragma once

#include <memory>
#include <vector>

#include "cells/hosts/array.hpp"
#include "pipeline/ranks/rank_exchange.hpp"
#include "pipeline/stages/distribution.hpp"
#include "pipeline/stages/exterior.hpp"
#include "pipeline/stages/feed_lane.hpp"

namespace raycell {

/// The stages before the array, the array, the exterior processors, and the links between them. With several
/// ranks, only this rank's part.
struct MachineParts {
    /// The arguments are those of Machine.
    MachineParts(const CellScene& scene, const PictureSettings& settings, const MachineSettings& machine,
                 const ExteriorTracer* tracer, const SyntheticTraffic* traffic,
                 const Granularity& granularity, RankExchange* other_ranks);

    /// The lane that begins in row y; null if none does, or if it is another rank's.
    const FeedLane* lane_at(int y) const;
    /// Statistics of the geometry, or of the precomputation, of all lanes here.
    StageStatistics geometry() const;
    StageStatistics precomputation() const;
    /// Number of cells of the whole array, over all ranks.
    std::uint64_t cell_count() const {
        return std::uint64_t(environment.width()) * std::uint64_t(environment.height());
    }
    /// Cycles of a slow ray, its answer and its longest back-off.
    Cycle slow_ray() const;

    RankExchange* const ranks;  ///< null: the whole machine is here
    Scheduler scheduler;
    Picture picture;
    Environment environment;
    std::vector<std::unique_ptr<FeedLane>> lanes;  ///< those whose first row is here
    Distribution distribution;
    Array array;
    std::unique_ptr<Exterior> exterior;
    std::vector<std::unique_ptr<Link>> row_links;  ///< from each row's distributor into its first cell

  private:
    void make_lanes();
    void bind_rows();
};

}  // namespace raycell
