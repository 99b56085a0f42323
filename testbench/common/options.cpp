#include "testbench/common/options.hpp"

#include "model/tracing/pixel_sum.hpp"
#include "scenes/frame_list.hpp"

namespace raycell {

void add_placement_options(OptionTable& table, RenderOptions& options) {
    table.group("Scene");
    PictureSettings& p = options.picture;
    table.text("scene", options.scene, "FILE", "scene: .nff or .obj");
    table.positional("file", options.scene, "the same; has precedence over --scene");
    table.text("view", options.view, "FILE.nff", "take background, view and sources from this file");
    table.text("sources", options.sources, "FILE.toml",
               "light sources that replace those of the scene, or are added to them");
    table.text("frames", options.frames, "FILE",
               "frames in a row: a list of views and scenes, one a line; all of them, or that of --frame");
    table.number("frame", options.frame, 0, int(max_frames),
                 "this one of --frames alone, from 1; 0: all, which only render can");
    table.choice("viewer", p.viewer, {{"scene", ViewerMode::scene}, {"infinity", ViewerMode::infinity}},
                 "viewer at the scene's distance, or at infinity (axial primary rays)");
    table.size("cells", p.width, p.height, "size of the array");
    table.size(
        "pixels", p.pixels_wide, p.pixels_high,
        "size of the picture, a whole multiple of the cells each way: a cell sends the primary rays of "
        "a block of pixels; cells: one each",
        "cells");
    table.number("chord-error", p.chord_error, 1e-3, 1e3,
                 "depth of a curved object's facets below their corners, pixels; half of it lies outside");
    table.number(
        "tessellate-for", p.tessellate_for, 0.0, 100.0,
        "PSNR of the polygons against the scene, dB, that chooses a chord error for each curved object; "
        "0: --chord-error for all");
}

void add_scene_options(OptionTable& table, RenderOptions& options) {
    PictureSettings& p = options.picture;
    add_placement_options(table, options);
    table.group("Results");
    table.text("output", options.prefix, "PREFIX",
               "where results go: PREFIX.exr, PREFIX.png, PREFIX.json, ...");
    table.group("Rays");
    table.number("max-depth", p.max_depth, 0, 62, "generations of rays after the primary one");
    table.number("min-weight", p.min_weight, 0.0, 1.0, "share of a pixel below which a ray is not sent");
    table.group("Samples of a pixel");
    table.number("samples", p.samples, 1, most_samples,
                 "primary rays of a pixel, whose mean is its intensity; the truth then has 256");
    table.choice("filter", p.filter, {{"box", PixelFilter::box}, {"tent", PixelFilter::tent}},
                 "where they lie: evenly, or closer to the pixel's middle");
    table.number("sample-until", p.sample_until, -1.0, 8.0,
                 "a pixel whose first four samples differ by no more in any component of their intensities "
                 "sends no others; negative: all send all");
    table.group("Results");
    table.flag("quiet", options.quiet, "no progress, no summary");
}

void add_source_samples(OptionTable& table, PictureSettings& p) {
    table.group("Rays");
    table.number("source-samples", p.source_samples, 1, int(max_sources),
                 "shadow rays from a hit, or a voxel, to each source that is an area");
}

void check_samples(const PictureSettings& p) {
    if (p.sample_until >= 0 && p.samples <= first_samples) {
        throw UsageError("--sample-until: the first " + std::to_string(first_samples) +
                         " samples of a pixel are sent in any case; expected --samples above that, not " +
                         std::to_string(p.samples));
    }
}

void add_truth_samples(OptionTable& table, RenderOptions& options) {
    table.group("Truth");
    table.number("truth-samples", options.truth_samples, 1, 65536,
                 "the truth's own samples of each source that is an area");
}

void add_link_options(OptionTable& table, MachineSettings& m) {
    table.group("Links and clock");
    table.number("link-bits", m.link_bits, 1, 4096, "bits that cross a link per cycle");
    table.number("loading-units", m.loading_units, 1, most_units,
                 "units of a cell that make voxels while the array is loaded, each one at a time");
    table.number("traversal-units", m.traversal_units, 1, most_units,
                 "units of a cell that test rays, each one at a time");
    table.number("start-within", m.start_within, 0U, 1U << 24U,
                 "primary rays start spread over so many cycles of the trace; 0: all at once");
    table.number("load-queue", m.load_queue, 0, 65535,
                 "spans that a cell keeps until their voxels are made; 0: no limit");
    table.number("feed-bits", m.feed_bits, 1, 4096,
                 "bits that cross a link of the feed per cycle: from geometry to the rows' distributors");
    table.number("feed-lanes", m.feed_lanes, 1, 4096,
                 "geometry and precomputation units, each for some of the rows");
    table.number("clock-mhz", m.clock_mhz, 1e-3, 1e5, "clock, MHz");
    table.number(
        "stall", m.stall, 0.0, 0.9,
        "probability that a transfer or an operation takes a cycle more, and again; drawn by --seed");
    table.number("max-cycles", m.max_cycles, std::int64_t(0), std::int64_t(1) << 62,
                 "timed engine: stop after so many cycles; 0: never");
}

void add_communication_options(OptionTable& table, MachineSettings& m) {
    table.group("Ray store, buffers and networks");
    table.number("ray-store", m.ray_store, 1, 1024, "M, rays that a cell can store, slots");
    table.number("buffer", m.buffer_depth, 1, 1024, "depth of every buffer, messages");
    table.choice("networks", m.networks,
                 {{"half", Networks::half},
                  {"quadrant", Networks::quadrant},
                  {"split", Networks::split},
                  {"shared", Networks::shared}},
                 "which messages share a buffer");
    table.choice("recovery", m.recovery, {{"postpone", Recovery::postpone}, {"none", Recovery::none}},
                 "a ray that finds no slot: destroyed and sent again, or left waiting");
    table.number("own-rays", m.own_rays, 1, most_own_rays,
                 "primary rays of a cell that may be under way at once; no more than it has samples are");
    table.choice("slots", m.slots,
                 {{"reserved", Slots::reserved}, {"free", Slots::free}, {"nested", Slots::nested}},
                 "slots kept by generation, free for all, or kept for deeper generations alone");
    add_link_options(table, m);
}

void add_granularity_options(OptionTable& table, RenderOptions& options) {
    table.group("Simulation");
    table.choice(
        "granularity", options.hosts,
        {{"auto", Hosts::automatic}, {"cell", Hosts::cell}, {"tile", Hosts::tile}},
        "what runs the cells: a SystemC module each, or one for a block of them, which is faster and "
        "smaller; auto: tiles, but modules for the cells that --detail, --probe or --golden name. No "
        "result depends on it");
    table.cells("detail", options.detail,
                "these cells are modules, with ports, all others in tiles; may come several times");
}

void add_voxel_options(OptionTable& table, PictureSettings& p) {
    table.group("Voxels and hit test");
    table.number("depth", p.depth_levels, 1, 65536, "depth levels of the cube");
    table.choice("hit", p.hit,
                 {{"edge", HitTest::edge},
                  {"mask", HitTest::mask},
                  {"plane", HitTest::plane},
                  {"interval", HitTest::interval},
                  {"depth", HitTest::depth}},
                 "what a cell compares a ray with");
    table.choice("normals", p.normals, {{"linear", Normals::linear}, {"voxel", Normals::voxel}},
                 "normals interpolated at the hit, or one per voxel");
    table.choice("shadows", p.shadows,
                 {{"per-hit", Shadows::per_hit}, {"precast", Shadows::precast}, {"memo", Shadows::memo}},
                 "a ray per hit and source, or sample of it; a bit per voxel and such a ray before tracing; "
                 "the same when "
                 "first hit");
    table.number("voxel-capacity", p.voxel_capacity, 0, 1000000, "voxels that a cell can hold; 0: unlimited");
    table.choice("display", p.display, {{"phong", Display::phong}, {"gouraud", Display::gouraud}},
                 "shading of --stage load");
}

void add_word_options(OptionTable& table, NumberSettings& n) {
    table.group("Numbers");
    table.choice("arithmetic", n.arithmetic, {{"fixed", Numbers::fixed}, {"exact", Numbers::exact}},
                 "numbers of the cell: words of word-bits, or double precision");
    table.number("word-bits", n.word_bits, 8, 32, "bits of a word in messages, voxels and the ALU");
    table.choice("rounding", n.rounding, {{"nearest", Rounding::nearest}, {"truncate", Rounding::truncate}},
                 "words: to the nearest, ties to even, or cut off");
}

void add_machine_options(OptionTable& table, RenderOptions& options) {
    PictureSettings& p = options.picture;
    MachineSettings& m = options.machine;
    add_voxel_options(table, p);
    table.group("Simulation");
    table.choice("stage", p.stage, {{"trace", RunStage::trace}, {"load", RunStage::load}},
                 "trace rays, or stop after loading and show the nearest voxels");
    table.choice("engine", options.engine, {{"timed", Engine::timed}, {"untimed", Engine::untimed}},
                 "SystemC cells, or the recursive reference without time");
    add_granularity_options(table, options);
    table.group("Rays beyond the cube");
    table.choice("exterior", p.exterior, {{"host", ExteriorMode::host}, {"none", ExteriorMode::none}},
                 "rays that leave the cube: traced on by the exterior processors, or lost");
    add_word_options(table, p.numbers);
    table.group("Numbers");
    const std::vector<std::pair<std::string, Iteration>> iterations = {
        {"newton", Iteration::newton}, {"table", Iteration::table}, {"rounded", Iteration::rounded}};
    OperatorSettings& o = p.numbers.operators;
    table.choice("reciprocal", o.reciprocal, iterations,
                 "1/x: a table and one Newton step, the table alone, or digit by digit; cycles in --cost");
    table.choice("root", o.root, iterations, "1/sqrt(x), in the same ways");
    table.choice("power", o.power,
                 {{"tables", PowerMethod::tables},
                  {"schlick", PowerMethod::schlick},
                  {"rounded", PowerMethod::rounded}},
                 "Phong's power: by log2 and exp2 tables, Schlick's fraction, or digit by digit");
    table.table_size("reciprocal-table", o.reciprocal_table,
                     "its entries, a power of two from 4; 0: what the word length needs, 64 at 20 bits");
    table.table_size("root-table", o.root_table, "the same; 0: 64 at 20 bits");
    table.table_size("power-table", o.power_table, "the same, of each of its two tables; 0: 32 at 20 bits");
    add_communication_options(table, m);
    table.group("Rays");
    add_source_samples(table, p);
    table.number("normal-offset", p.normal_offset, -1.0, 1.0,
                 "start of secondary rays off their polygon, cells; negative: what suits the arithmetic");
    table.group("Rays beyond the cube");
    table.number("exterior-processors", m.exterior_processors, 1, 1000000, "processors outside the cube");
    table.number("exterior-latency", m.exterior_latency, 1, 1000000000,
                 "cycles that one of them takes for a ray");
    table.group("Links and clock");
    table.number("seed", m.seed, std::uint64_t(0), ~std::uint64_t(0) >> 1, "of the back-off's jitter");
    table.flag(
        "wire-check", m.wire_check,
        "pack every ray and answer into its bits at every link and go on with what unpacks: the same picture "
        "in the same cycles");
    table.group("Costs");
    table.costs(m.costs);
    table.group("Truth");
    table.flag("truth", options.truth, "render the truth too and report the accuracy");
    table.flag("clip-truth", options.clip_truth, "clip the truth to the cube");
    add_truth_samples(table, options);
}

void add_array_options(OptionTable& table, RenderOptions& options) {
    table.group("Loaded arrays");
    table.text("save-array", options.save_array, "FILE",
               "keep the loaded array, for other traces of this scene and size");
    table.text("load-array", options.load_array, "FILE",
               "start with an array that --save-array kept, instead of loading it again");
}

void add_render_options(OptionTable& table, RenderOptions& options) {
    add_scene_options(table, options);
    add_machine_options(table, options);
    add_watch_options(table, options);
    add_recording_options(table, options);
    add_array_options(table, options);
    add_probe_options(table, options);
}

}  // namespace raycell
