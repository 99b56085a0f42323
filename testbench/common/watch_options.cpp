// Options of what a run shows and records of itself.
#include "testbench/common/options.hpp"

namespace raycell {

void add_watch_options(OptionTable& table, RenderOptions& options) {
    table.group("Looking inside");
    table.rays("watch-ray", options.watch_rays,
               "prints the life of the ray with this id and of its children; may come several times");
    table.cells("watch-pixel", options.watch_pixels,
                "prints the lives of all rays of a pixel's tree; may come several times");
}

void add_recording_options(OptionTable& table, RenderOptions& options) {
    table.group("Looking inside");
    table.number("film", options.film, 0, 2000,
                 "frames of the run at most, from 4 on, in PREFIX.film.json: coarse maps of messages, voxels "
                 "and slots over "
                 "time, which the report page shows; 0: none");
    table.flag(
        "rays", options.rays,
        "a line for every ray, in PREFIX.rays.csv: where it came from, where it ended, its cycles and hops");
}

void add_waveform_options(OptionTable& table, RenderOptions& options) {
    table.group("Looking inside");
    ProbeOptions& p = options.probes;
    table.cells("probe", p.cells,
                "waveforms of these cells: PREFIX.vcd, PREFIX.gtkw; may come several times");
    table.window("window", p.window, "cycles of the run that --probe shows, both ends included");
    table.flag("vcd-on-deadlock", p.on_deadlock,
               "if the run deadlocks: waveforms of the knot's cells, by running once more");
    table.number("vcd-last", p.last, std::int64_t(0), std::int64_t(1) << 62,
                 "cycles before the deadlock formed from which on --vcd-on-deadlock shows it");
    table.number("vcd-mark", p.mark, std::int64_t(-1), std::int64_t(1) << 62,
                 "cycle with GTKWave's marker, at which the view opens; -1: the first one shown");
    table.number("vcd-limit", p.limit_mb, std::int64_t(1), std::int64_t(1) << 40,
                 "size at which a dump ends, MB; the run goes on");
}

void add_probe_options(OptionTable& table, RenderOptions& options) {
    add_waveform_options(table, options);
    table.cells("golden", options.golden,
                "messages into and out of these cells, for cell_tb and the test of a cell of your own: "
                "PREFIX.golden_X_Y.txt; may come several times");
    table.choice("golden-part", options.golden_part,
                 {{"cell", GoldenPart::cell}, {"traversal", GoldenPart::traversal}},
                 "what --golden records: all messages, or the traversal unit's tests alone, with the cell's "
                 "voxels: PREFIX.traversal_X_Y.txt");
}

}  // namespace raycell
