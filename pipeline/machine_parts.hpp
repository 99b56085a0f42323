// The parts of a machine and the links between them.
#pragma once

#include <memory>
#include <vector>

#include "cells/hosts/array.hpp"
#include "pipeline/ranks/rank_exchange.hpp"
#include "pipeline/stages/distribution.hpp"
#include "pipeline/stages/exterior.hpp"
#include "pipeline/stages/geometry.hpp"
#include "pipeline/stages/precomputation.hpp"

namespace raycell {

/// The stages before the array, the array, the exterior processors, and the links between them. With several
/// ranks, only this rank's part.
struct MachineParts {
    /// The arguments are those of Machine.
    MachineParts(const CellScene& scene, const PictureSettings& settings, const MachineSettings& machine,
                 const ExteriorTracer* tracer, const SyntheticTraffic* traffic,
                 const Granularity& granularity, RankExchange* other_ranks);

    /// The input link of the distributor of row y.
    const Link& input_of_row(int y) const;
    /// Number of cells of the whole array, over all ranks.
    std::uint64_t cell_count() const {
        return std::uint64_t(environment.width()) * std::uint64_t(environment.height());
    }
    /// Cycles of a slow ray, its answer and its longest back-off.
    Cycle slow_ray() const;

    static constexpr int stage_link_depth = 4;  ///< messages between two stages before the array
    RankExchange* const ranks;                  ///< null: the whole machine is here
    Scheduler scheduler;
    Picture picture;
    Environment environment;
    Geometry geometry;
    Precomputation precomputation;
    Distribution distribution;
    Array array;
    std::unique_ptr<Exterior> exterior;
    Link to_precomputation;
    Link to_distribution;
    std::vector<std::unique_ptr<Link>> row_links;  ///< from each row's distributor into its first cell

  private:
    void bind_stages();
    void bind_rows();
};

}  // namespace raycell
