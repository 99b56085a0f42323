#include "pipeline/stages/feed_lane.hpp"

namespace raycell {
namespace {

/// A stage's name; that of an only lane has no number.
std::string name_of(const char* stage, int lane, int lanes) {
    return lanes == 1 ? stage : std::string(stage) + "_" + std::to_string(lane);
}

}  // namespace

FeedLane::FeedLane(Environment& environment, int lane, int lanes)
    : rows(rows_of_lane(lane, lanes, environment.height())),
      geometry(name_of("geometry", lane, lanes).c_str(), environment, rows),
      precomputation(name_of("precomputation", lane, lanes).c_str(), environment, rows),
      polygons(environment.scheduler, 1, feed_link_depth),
      trapezes(environment.scheduler, 1, feed_link_depth) {
    polygons.set_name(name_of("geometry", lane, lanes) + ".out");
    environment.stall(polygons, polygons.name());
    polygons.connect_source(geometry);
    polygons.connect_sink(precomputation);
    geometry.out.bind(polygons);
    precomputation.in.bind(polygons);

    trapezes.set_name(name_of("precomputation", lane, lanes) + ".out");
    environment.stall(trapezes, trapezes.name());
    trapezes.connect_source(precomputation);
    precomputation.out.bind(trapezes);
}

}  // namespace raycell
