#include "testbench/common/report_json.hpp"

#include <algorithm>
#include <cstdio>

#include "model/machine/bound.hpp"
#include "model/machine/feed_bits.hpp"
#include "model/machine/losses.hpp"
#include "model/machine/second_store_bits.hpp"
#include "model/machine/storage_bits.hpp"
#include "model/picture/metrics.hpp"
#include "testbench/common/knot_report.hpp"

namespace raycell {
namespace {

using Json = nlohmann::ordered_json;

Json stage(const StageStatistics& s, Cycle cycles) {
    return {{"items", s.items},
            {"busy_cycles", s.busy_cycles},
            {"utilisation", cycles > 0 ? double(s.busy_cycles) / double(cycles) : 0.0}};
}

/// One list per quantity, with a value for each bucket: a mean over its cycles or a count of events.
Json activity(const Activity& a) {
    using Bucket = Activity::Bucket;
    const auto mean = [&](std::uint64_t Bucket::*sum) {
        Json list = Json::array();
        for (std::size_t i = 0; i < a.buckets.size(); ++i) {
            list.push_back(double(a.buckets[i].*sum) / double(a.cycles_of(i)));
        }
        return list;
    };
    const auto events = [&](std::uint64_t Bucket::*count) {
        Json list = Json::array();
        for (const Bucket& bucket : a.buckets) list.push_back(bucket.*count);
        return list;
    };
    return {{"start_cycle", a.start},
            {"cycles", a.end - a.start},
            {"bucket_cycles", a.bucket_cycles},
            {"rays_in_flight", mean(&Bucket::rays_in_flight)},
            {"answers_in_flight", mean(&Bucket::answers_in_flight)},
            {"slots_used", mean(&Bucket::slots_used)},
            {"hops", events(&Bucket::hops)},
            {"pixels_done", events(&Bucket::pixels_done)},
            {"postponed", events(&Bucket::postponed)}};
}

/// The activity while loading.
Json load_activity(const Activity& a) {
    Json hops = Json::array();
    Json loaded = Json::array();
    for (const Activity::Bucket& bucket : a.buckets) {
        hops.push_back(bucket.load_hops);
        loaded.push_back(bucket.cells_loaded);
    }
    return {{"start_cycle", a.start},
            {"cycles", a.end - a.start},
            {"bucket_cycles", a.bucket_cycles},
            {"hops", hops},
            {"cells_loaded", loaded}};
}

/// Losses by cause, due to words. `pixels`, `ties` and `exterior_rays` count only what the run did; the rest
/// follows from the scene.
Json losses_report(const RunResult& result, const CellScene& scene, const PictureSettings& picture) {
    const Context context(scene, picture);
    const Losses losses = losses_of(context);
    return {{"saturated",
             {{"features", losses.features},
              {"indices_of_refraction", losses.indices},
              {"lights", losses.lights},
              {"pixels", saturated_pixels(result.picture, context)}}},
            {"single_normals", losses.single_normals},
            {"drift_cells", losses.drift},
            {"ties", result.counters.rays.ties},
            {"exterior_rays", result.counters.rays.exterior}};
}

Json bound_json(const Bound& bound) {
    return {{"met", bound.met()},
            {"may", name_of(bound.may)},
            {"generations", bound.generations},
            {"ray_store_needed", bound.ray_store_needed ? Json(*bound.ray_store_needed) : Json()},
            {"reason", bound.reason},
            {"options", bound.options}};
}

const char* name_of(LoadedBy loading) {
    switch (loading) {
        case LoadedBy::run:
            return "run";
        case LoadedBy::saved:
            return "saved";
        case LoadedBy::saved_other_timing:
            return "saved_other_timing";
    }
    return "";
}

Json registers_json(const RegisterBits& bits) {
    Json json = {{"own_ray", bits.own_ray}, {"decisions", bits.decisions}, {"ages", bits.ages},
                 {"credits", bits.credits}, {"outputs", bits.outputs},     {"traversal", bits.traversal},
                 {"shading", bits.shading}, {"loading", bits.loading},     {"latches", bits.latches},
                 {"total", bits.total()}};
    if (bits.pixels > 0) json["pixels"] = bits.pixels;
    return json;
}

}  // namespace

std::string to_text(const Json& json) {
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string hex(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

Json report(const RunResult& result, const CellScene& scene, const PictureSettings& picture,
            const MachineSettings& machine) {
    const Counters& c = result.counters;
    const Cycle total = result.load_cycles + result.precast_cycles + result.trace_cycles;
    const Formats formats(picture.numbers.word_bits, picture.numbers.rounding, extent_of(scene.frame));
    const StorageCounts& storage = result.storage;
    const double stored = double(std::max<std::uint64_t>(storage.voxels, 1));
    Json json;
    json["verdict"] = name_of(result.verdict);
    json["cycles"] = {{"load", result.load_cycles},
                      {"precast", result.precast_cycles},
                      {"trace", result.trace_cycles},
                      {"total", total}};
    const auto binding = [](const Binding& b) { return Json{{"cycles", b.cycles}, {"of", name_of(b)}}; };
    json["bound"] = {{"load", binding(result.load_binding)}, {"trace", binding(result.trace_binding)}};
    const std::uint64_t pixels =
        std::uint64_t(picture.width) * std::uint64_t(picture.height) * std::uint64_t(picture.block());
    const bool whole = result.verdict == Verdict::completed || result.verdict == Verdict::capacity;
    json["pixels"] = {{"all", pixels}, {"completed", whole ? pixels : c.pixels_done}};
    json["simulated_seconds"] = double(total) / (machine.clock_mhz * 1e6);
    // A stage with a unit for each lane, or a distributor for each row: its utilisation is their mean.
    const Cycle lanes = Cycle(std::min(machine.feed_lanes, picture.height));
    StageStatistics distributors = result.distribution;
    json["stages"] = {{"geometry", stage(result.geometry, result.load_cycles * lanes)},
                      {"precomputation", stage(result.precomputation, result.load_cycles * lanes)},
                      {"distribution", stage(distributors, result.load_cycles * Cycle(picture.height))},
                      {"exterior", stage(result.exterior, (result.precast_cycles + result.trace_cycles) *
                                                              Cycle(machine.exterior_processors))}};
    const double cell_cycles =
        double(result.precast_cycles + result.trace_cycles) * picture.width * picture.height;
    json["units"] = {
        {"traversal",
         {{"utilisation",
           cell_cycles > 0 ? double(c.traversal_cycles) / (cell_cycles * machine.traversal_units) : 0.0}}},
        {"shading", {{"utilisation", cell_cycles > 0 ? double(c.shading_cycles) / cell_cycles : 0.0}}}};
    json["hops"] = {{"load", c.load_hops}, {"ray", c.rays.ray_hops}, {"return", c.rays.return_hops}};
    json["precast"] = {{"hops", result.precast_hops}};
    json["losses"] = losses_report(result, scene, picture);
    json["rays"] = {{"primary", c.rays.primary},     {"reflected", c.rays.reflected},
                    {"refracted", c.rays.refracted}, {"shadow", c.rays.shadow},
                    {"precast", c.rays.precast},     {"lost", c.rays.lost},
                    {"exterior", c.rays.exterior}};
    json["messages"] = {
        {"rays",
         {{"sent", c.rays_sent},
          {"answered", c.rays_answered},
          {"silent", c.rays_silent},
          {"destroyed", c.rays_destroyed},
          {"in_flight", result.in_flight.rays}}},
        {"answers",
         {{"sent", c.answers_sent},
          {"delivered", c.answers_delivered},
          {"in_flight", result.in_flight.answers}}},
        {"load",
         {{"sent", c.loads_sent}, {"delivered", c.loads_delivered}, {"in_flight", result.in_flight.loads}}}};
    if (c.packed_load > 0) {
        json["messages"]["packed"] = c.packed;
        json["messages"]["packed_load"] = c.packed_load;
    }
    json["voxels"] = {{"stored", storage.voxels},
                      {"max_per_cell", storage.max_voxels},
                      {"mean_per_occupied_cell",
                       double(storage.voxels) / double(std::max<std::uint64_t>(storage.occupied_cells, 1))},
                      {"occupied_cells", storage.occupied_cells},
                      {"bits_each", double(storage.bits) / stored},
                      {"edges_each", double(storage.edges) / stored},
                      {"bits_total", storage.bits},
                      {"max_bits_per_cell", storage.max_cell_bits},
                      {"overflowed", storage.overflowed}};
    json["voxels_needed"] = storage.max_needed;
    json["load_queue"] = {{"peak", c.most_kept},
                          {"max_bits_per_cell", std::max(c.most_load_bits, storage.max_cell_bits)}};
    const MessageBits messages = message_bits(picture, machine, formats);
    json["message_bits"] = {{"ray", messages.ray},
                            {"shadow_ray", messages.shadow_ray},
                            {"intensity", messages.intensity},
                            {"verdict", messages.verdict},
                            {"span", messages.longest_span()},
                            {"trapeze", messages.longest_trapeze()},
                            {"surface", messages.surface},
                            {"edge", messages.edge}};
    const SourceCounts sources(scene.sources, picture.source_samples);
    const StorageBits stored_bits = storage_bits(picture, machine, formats, sources);
    json["storage_bits"] = {{"ray_buffers", stored_bits.ray_buffers},
                            {"answer_buffers", stored_bits.answer_buffers},
                            {"slot", slot_bits(picture, machine, formats, sources).total()},
                            {"ray_store", stored_bits.ray_store},
                            {"registers", registers_json(register_bits(picture, machine, formats, sources))},
                            {"total", stored_bits.total()}};
    const SecondStoreBits second = second_store_bits(picture, machine, formats, sources,
                                                     std::max(c.most_load_bits, storage.max_cell_bits));
    json["second_store_bits"] = {{"store", second.store},     {"buffer", second.buffer},
                                 {"output", second.output},   {"control", second.control},
                                 {"latches", second.latches}, {"total", second.total()},
                                 {"wires", second.wires}};
    const FeedBits feed = feed_bits(picture, machine, formats);
    json["feed_bits"] = {{"buffers", feed.buffers},
                         {"registers", feed.registers},
                         {"wires", feed.wires},
                         {"total", feed.total()}};
    json["formats"] = Json::object();
    for (const auto& [name, format] : formats.names()) json["formats"][name] = format;
    json["ray_store"] = {
        {"capacity", machine.ray_store}, {"peak", result.ray_store_peak}, {"mean", result.ray_store_mean}};
    json["buffers"] = {{"depth", machine.buffer_depth}, {"peak", Json::object()}, {"mean", Json::object()}};
    for (const RunResult::BufferUse& use : result.buffers) {
        json["buffers"]["peak"][use.name] = use.peak;
        json["buffers"]["mean"][use.name] = use.mean;
    }
    json["deadlock"] = {{"detected", result.verdict == Verdict::deadlock},
                        {"postponed", c.rays_destroyed},
                        {"report", result.report}};
    json["deadlock"]["bound"] = bound_json(bound_of(Context(scene, picture), machine));
    json["deadlock"]["ledger"] = ledger_json(result);
    json["deadlock"]["time_outs"] = time_outs_json(result);
    if (result.waits.deadlocked()) json["deadlock"]["knot"] = knot_json(result);
    const bool loaded_here = !result.load_activity.buckets.empty();
    if (loaded_here || result.loading != LoadedBy::run) {
        json["activity"] = activity(result.activity);
        json["activity"]["trace_start"] = result.trace_start == never ? Json() : Json(result.trace_start);
        json["activity"]["load"] = loaded_here ? load_activity(result.load_activity) : Json();
    }
    json["loading"] = name_of(result.loading);
    json["cube"] = {{"depth_cells", scene.frame.depth},
                    {"cell_width_world", scene.frame.cell_width},
                    {"polygons", scene.polygons.size()}};
    json["hash"] = {{"image", hex(image_hash(result.picture))}, {"schedule", hex(result.schedule_hash)}};
    return json;
}

Json report(const Picture& test, const Picture& truth) {
    const Accuracy a = compare(test, truth);  // refuses what the others can't take
    return {{"psnr_db", a.psnr_db},
            {"rmse", a.rmse},
            {"max_error", a.max_error},
            {"off_by_1_255_percent", a.off_by_1_255_percent},
            {"off_by_0_1_percent", a.off_by_0_1_percent},
            {"wrong_hit_percent", a.wrong_hit_percent},
            {"ssim", ssim(test, truth)},
            {"flip", flip(test, truth)},
            {"relative_mse", relative_mse(test, truth)}};
}

}  // namespace raycell
