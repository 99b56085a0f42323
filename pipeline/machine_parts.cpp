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
      picture(scene.frame.width, scene.frame.height),
      environment(scene, settings, machine, scheduler, picture, traffic, ranks ? &ranks->share() : nullptr),
      geometry("geometry", environment),
      precomputation("precomputation", environment),
      distribution("distribution", environment),
      array("array", environment, granularity),
      to_precomputation(scheduler, 1, stage_link_depth),
      to_distribution(scheduler, 1, stage_link_depth) {
    bind_stages();
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

void MachineParts::bind_stages() {
    to_precomputation.set_name("geometry.out");
    environment.stall(to_precomputation, to_precomputation.name());
    to_precomputation.connect_source(geometry);
    to_precomputation.connect_sink(precomputation);
    geometry.out.bind(to_precomputation);
    precomputation.in.bind(to_precomputation);

    to_distribution.set_name("precomputation.out");
    environment.stall(to_distribution, to_distribution.name());
    to_distribution.connect_source(precomputation);
    precomputation.out.bind(to_distribution);
    const ArrayShare& share = environment.share;
    if (share.contains(0)) {
        to_distribution.connect_sink(distribution.row(0));
        distribution.row(0).in = &to_distribution;
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

const Link& MachineParts::input_of_row(int y) const {
    const std::size_t no_link = environment.share.rows().front() == 0;  // no link leads into row 0
    return y == 0 ? to_distribution
                  : *distribution.links()[std::size_t(environment.share.place(y)) - no_link];
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
           dearest * Cycle(1 + env.context.scene.sources.size());
}

}  // namespace raycell
