#include "testbench/common/traffic_options.hpp"

namespace raycell {

void add_traffic_options(OptionTable& table, TrafficOptions& options) {
    PictureSettings& p = options.run.picture;
    TrafficSettings& t = options.traffic;
    table.group("Results");
    table.text("output", options.run.prefix, "PREFIX",
               "writes PREFIX.json, PREFIX.toml, PREFIX.cells.csv and, of a run that stopped, "
               "PREFIX.waits.json and PREFIX.knot.svg; empty: no files");
    table.group("Traffic");
    table.size("cells", p.width, p.height, "size of the array");
    table.size(
        "pixels", p.pixels_wide, p.pixels_high,
        "primary rays, a whole multiple of the cells each way: a cell sends those of a block of pixels; "
        "cells: one each",
        "cells");
    table.number("hit-probability", t.hit_probability, 0.0, 1.0,
                 "that a ray hits in a cell that it enters; never in the one that it starts from");
    table.number("generations", p.max_depth, 0, 62,
                 "of rays after the primary one: so many may have to wait");
    table.shares("branching", t.reflected, t.refracted,
                 "probability that a hit has a reflected child, and that it has a refracted one");
    table.choice("directions", t.directions,
                 {{"isotropic", Directions::isotropic},
                  {"axial", Directions::axial},
                  {"diagonal", Directions::diagonal},
                  {"back", Directions::back}},
                 "of rays in the plane of the array; back: isotropic, but see turn-back");
    table.number("turn-back", t.turn_back, 0.0, 1.0,
                 "directions back: share of the children that return to the cell that their parent came from "
                 "and hit there, as between facing mirrors");
    table.number("sources", t.sources, 0, int(max_sources),
                 "shadow rays of each hit; with them the last generation has to wait too");
    add_communication_options(table, options.run.machine);
    add_granularity_options(table, options.run);
    add_recording_options(table, options.run);
    add_waveform_options(table, options.run);
    table.group("Traffic");
    table.number("seed", t.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1,
                 "of every draw, and of the back-off's jitter");
    table.group("Costs");
    table.costs(options.run.machine.costs);
    table.group("Results");
    table.flag("quiet", options.run.quiet, "no progress, no summary");
}

}  // namespace raycell
