#include "pipeline/machine_parts.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {

MachineParts::MachineParts(const CellScene& scene, const PictureSettings& settings,
                           const MachineSettings& machine, const ExteriorTracer* tracer,
                           const SyntheticTraffic* traffic, const Granularity& granularity,
                           RankExchange* other_ranks)
    : ranks(other_ranks),
      scheduler("scheduler", sc_core::sc_time(1e3 / machine.clock_mhz, sc_core::SC_NS)),
      picture(scene.frame.picture_width(), scene.frame.picture_height()),
      environment(scene, settings, machine, scheduler, picture, traffic, ranks ? &ranks->share() : nullptr),
      distribution("distribution", environment),
      array("array", environment, granularity) {
    make_lanes();
    bind_rows();
    const bool anything_beyond =
        std::any_of(scene.beyond.begin(), scene.beyond.end(), [](bool b) { return b; });
    if (settings.exterior == ExteriorMode::host && anything_beyond && settings.stage == RunStage::trace) {
        if (ranks && ranks->rank() != 0) {
            Exterior::join_remote(array, environment, *ranks);
            return;
        }
        if (!tracer)
            throw std::invalid_argument("exterior 'host' needs a tracer for what lies outside the cube");
        exterior = std::make_unique<Exterior>("exterior", environment, *tracer);
        exterior->join(array, ranks);
    }
}

void MachineParts::make_lanes() {
    const int count = environment.feed_lanes();
    for (int lane = 0; lane < count; ++lane) {
        const int first = rows_of_lane(lane, count, environment.height()).first;
        if (!environment.share.contains(first)) continue;
        lanes.push_back(std::make_unique<FeedLane>(environment, lane, count));
        Link& link = lanes.back()->trapezes;
        link.connect_sink(distribution.row(first));
        distribution.row(first).in = &link;
    }
}

void MachineParts::bind_rows() {
    const ArrayShare& share = environment.share;
    for (const int y : share.rows()) {
        row_links.push_back(std::make_unique<Link>(scheduler, 1, environment.machine.buffer_depth));
        Link& link = *row_links.back();
        link.set_name("distribution.row_" + std::to_string(y) + ".east");
        environment.stall(link, link.name());
        link.connect_source(distribution.row(y));
        distribution.row(y).east = &link;
        array.join_row(y, link);
    }
}

const FeedLane* MachineParts::lane_at(int y) const {
    for (const auto& lane : lanes) {
        if (lane->rows.first == y) return lane.get();
    }
    return nullptr;
}

StageStatistics MachineParts::geometry() const {
    StageStatistics sum;
    for (const auto& lane : lanes) sum += lane->geometry.statistics();
    return sum;
}

StageStatistics MachineParts::precomputation() const {
    StageStatistics sum;
    for (const auto& lane : lanes) sum += lane->precomputation.statistics();
    return sum;
}

Cycle MachineParts::slow_ray() const {
    // A ray and its answer may cross the array and visit the exterior, and each operation may be the most
    // expensive of the table, once per source; loading's are none of a ray. The longest back-off is below 128
    // times CostTable::backoff.
    const Environment& env = environment;
    Cycle dearest = 0;
    for (const auto& [name, member] : CostTable::entries())
        dearest = name.rfind("load_", 0) == 0 ? dearest : std::max(dearest, Cycle(env.costs().*member));
    const Cycle span = Cycle(env.width() + env.height());
    const Cycle hop = 64 + Cycle(env.cycles_for(env.bits.ray)) + Cycle(env.costs().walk_step);
    return Cycle(env.costs().backoff) * 128 + span * hop + Cycle(env.machine.exterior_latency) +
           dearest * Cycle(1 + env.context.lights.rays.size());
}

}  // namespace raycell
