// The options of deadlock_tb: a machine, and traffic without a scene.
#pragma once

#include "model/tracing/traffic.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

struct TrafficOptions {
    TrafficOptions() {
        run.prefix.clear();
        run.picture.width = run.picture.height = 32;
        run.picture.max_depth = 3;
    }
    RenderOptions run;  ///< array, machine, --output, --quiet
    TrafficSettings traffic;
};
void add_traffic_options(OptionTable& table, TrafficOptions& options);

}  // namespace raycell
