// Checks that hold for every report.
#include "program.hpp"

namespace raycell::system_test {

namespace {

/// Keys that users' scripts rely on.
const char* const keys[] = {
    "/verdict",
    "/config",
    "/pixels/all",
    "/pixels/completed",
    "/voxels_needed",
    "/bound/load/cycles",
    "/bound/trace/of",
    "/feed_bits/wires",
    "/load_queue/peak",
    "/storage_bits/ray_buffers",
    "/storage_bits/answer_buffers",
    "/storage_bits/slot",
    "/storage_bits/ray_store",
    "/storage_bits/registers/own_ray",
    "/storage_bits/registers/decisions",
    "/storage_bits/registers/ages",
    "/storage_bits/registers/credits",
    "/storage_bits/registers/outputs",
    "/storage_bits/registers/traversal",
    "/storage_bits/registers/shading",
    "/storage_bits/registers/loading",
    "/storage_bits/registers/latches",
    "/storage_bits/registers/total",
    "/storage_bits/total",
    "/cycles/load",
    "/cycles/precast",
    "/cycles/trace",
    "/cycles/total",
    "/simulated_seconds",
    "/stages/geometry/items",
    "/stages/geometry/busy_cycles",
    "/stages/geometry/utilisation",
    "/stages/precomputation/items",
    "/stages/precomputation/busy_cycles",
    "/stages/precomputation/utilisation",
    "/stages/distribution/items",
    "/stages/distribution/busy_cycles",
    "/stages/distribution/utilisation",
    "/hops/load",
    "/hops/ray",
    "/hops/return",
    "/rays/primary",
    "/rays/reflected",
    "/rays/refracted",
    "/rays/shadow",
    "/rays/precast",
    "/rays/lost",
    "/rays/exterior",
    "/losses/saturated/features",
    "/losses/saturated/indices_of_refraction",
    "/losses/saturated/lights",
    "/losses/saturated/pixels",
    "/losses/single_normals",
    "/losses/drift_cells",
    "/losses/ties",
    "/losses/exterior_rays",
    "/voxels/stored",
    "/voxels/max_per_cell",
    "/voxels/mean_per_occupied_cell",
    "/voxels/bits_each",
    "/voxels/bits_total",
    "/voxels/max_bits_per_cell",
    "/voxels/overflowed",
    "/message_bits/ray",
    "/message_bits/shadow_ray",
    "/message_bits/intensity",
    "/message_bits/verdict",
    "/message_bits/span",
    "/message_bits/trapeze",
    "/formats/unit",
    "/formats/depth",
    "/ray_store/capacity",
    "/ray_store/peak",
    "/ray_store/mean",
    "/buffers/depth",
    "/buffers/peak",
    "/buffers/mean",
    "/deadlock/detected",
    "/deadlock/postponed",
    "/deadlock/report",
    "/precast/hops",
    "/model/processor_seconds/load",
    "/model/processor_seconds/precast",
    "/model/processor_seconds/trace",
    "/model/wall_seconds/build",
    "/model/wall_seconds/load",
    "/model/wall_seconds/precast",
    "/model/wall_seconds/trace",
    "/model/hops_per_second",
    "/model/peak_memory_bytes",
    "/model/bytes_per_cell",
    "/hash/image",
    "/hash/schedule",
};

bool has_every_key(const Json& report) {
    bool all = true;
    for (const char* key : keys) {
        const bool present = report.contains(Json::json_pointer(key));
        EXPECT_TRUE(present) << "the report lacks " << key;
        all = all && present;
    }
    return all;
}

std::int64_t count(const Json& block, const char* name) { return block.at(name).get<std::int64_t>(); }

void expect_messages_conserved(const Json& report, bool ended, bool timed) {
    const Json& rays = report.at("messages").at("rays");
    const Json& answers = report.at("messages").at("answers");
    const Json& loads = report.at("messages").at("load");
    const std::int64_t on_their_way =
        count(rays, "sent") - count(rays, "answered") - count(rays, "silent") - count(rays, "destroyed");
    const std::int64_t answers_on_their_way = count(answers, "sent") - count(answers, "delivered");
    const std::int64_t loads_on_their_way = count(loads, "sent") - count(loads, "delivered");
    if (timed) {  // the untimed machine does not send its rays
        EXPECT_EQ(on_their_way, count(rays, "in_flight")) << rays;
        EXPECT_EQ(answers_on_their_way, count(answers, "in_flight")) << answers;
        EXPECT_EQ(loads_on_their_way, count(loads, "in_flight")) << loads;
    }
    EXPECT_EQ(count(report.at("deadlock"), "postponed"), count(rays, "destroyed"));
    if (!ended) return;
    EXPECT_EQ(on_their_way, 0) << rays;
    EXPECT_EQ(answers_on_their_way, 0) << answers;
    EXPECT_EQ(loads_on_their_way, 0) << loads;
    if (!timed) return;
    const Json& kinds = report.at("rays");
    EXPECT_EQ(count(rays, "answered") + count(rays, "silent"),
              count(kinds, "primary") + count(kinds, "reflected") + count(kinds, "refracted") +
                  count(kinds, "shadow") + count(kinds, "precast"))
        << "every ray has an end: " << rays << kinds;
}

void expect_share(const Json& value) {
    EXPECT_GE(value.get<double>(), 0) << value;
    EXPECT_LE(value.get<double>(), 1) << value;
}

/// The bits of a cell must be the sum of its parts.
void expect_sums(const Json& bits) {
    std::int64_t registers = 0;
    for (const auto& [name, value] : bits.at("registers").items()) {
        if (name != "total") registers += value.get<std::int64_t>();
    }
    EXPECT_EQ(registers, count(bits.at("registers"), "total"));
    EXPECT_EQ(
        registers + count(bits, "ray_buffers") + count(bits, "answer_buffers") + count(bits, "ray_store"),
        count(bits, "total"));
}

void expect_bounds(const Json& report) {
    const Json& cycles = report.at("cycles");
    EXPECT_EQ(count(cycles, "total"),
              count(cycles, "load") + count(cycles, "precast") + count(cycles, "trace"));
    EXPECT_NEAR(report.at("simulated_seconds").get<double>(),
                double(count(cycles, "total")) / (report.at("config").at("clock-mhz").get<double>() * 1e6),
                1e-9);
    for (const auto& stage : report.at("stages")) expect_share(stage.at("utilisation"));
    EXPECT_LE(count(report.at("pixels"), "completed"), count(report.at("pixels"), "all"));
    const Json& store = report.at("ray_store");
    EXPECT_EQ(count(report.at("storage_bits"), "ray_store"),
              count(report.at("storage_bits"), "slot") * count(store, "capacity"));
    expect_sums(report.at("storage_bits"));
    const Json& cycles_of = report.at("cycles");
    EXPECT_LE(count(report.at("bound").at("load"), "cycles"), count(cycles_of, "load"));
    EXPECT_LE(count(report.at("bound").at("trace"), "cycles"),
              count(cycles_of, "precast") + count(cycles_of, "trace"));
    for (const auto& bound : report.at("bound"))
        EXPECT_EQ(bound.at("of") == "nothing", bound.at("cycles") == 0) << bound;
    const Json& feed = report.at("feed_bits");
    EXPECT_EQ(count(feed, "total"), count(feed, "buffers") + count(feed, "registers"));
    EXPECT_GE(count(report.at("load_queue"), "max_bits_per_cell"),
              count(report.at("voxels"), "max_bits_per_cell"));
    EXPECT_LE(count(store, "peak"), count(store, "capacity"));
    EXPECT_LE(store.at("mean").get<double>(), store.at("capacity").get<double>());
    for (const auto& peak : report.at("buffers").at("peak")) {
        EXPECT_LE(peak.get<std::int64_t>(), count(report.at("buffers"), "depth"));
    }
    const Json& voxels = report.at("voxels");
    EXPECT_LE(count(voxels, "max_per_cell"), count(voxels, "stored"));
    EXPECT_LE(count(voxels, "max_bits_per_cell"), count(voxels, "bits_total"));
    EXPECT_LE(count(voxels, "bits_total"),
              count(voxels, "max_bits_per_cell") * count(voxels, "occupied_cells"));
    EXPECT_NEAR(voxels.at("bits_each").get<double>() * double(count(voxels, "stored")),
                double(count(voxels, "bits_total")), 1e-6 * double(count(voxels, "bits_total")));
    EXPECT_EQ(report.at("hash").at("image").get<std::string>().size(), 16u);
    EXPECT_EQ(report.at("hash").at("schedule").get<std::string>().size(), 16u);
}

}  // namespace

void expect_sound(const Json& report) {
    if (!has_every_key(report)) return;
    const std::string verdict = report.at("verdict");
    EXPECT_TRUE(verdict == "completed" || verdict == "deadlock" || verdict == "livelock" ||
                verdict == "cycle_limit" || verdict == "capacity" || verdict == "interrupted")
        << verdict;
    const bool ended = verdict == "completed" || verdict == "capacity";
    const bool timed = report.at("config").at("engine") == "timed";
    expect_messages_conserved(report, ended, timed);
    expect_bounds(report);
    EXPECT_EQ(report.at("deadlock").at("detected").get<bool>(), verdict == "deadlock");
    const bool stuck = verdict == "deadlock" || verdict == "livelock";
    if (stuck) {
        EXPECT_FALSE(report.at("deadlock").at("report").empty()) << "a stuck machine says where";
    }
    if (ended) {
        EXPECT_TRUE(report.at("deadlock").at("report").empty());
    }
    const std::int64_t overflowed = count(report.at("voxels"), "overflowed");
    if (verdict == "capacity") {
        EXPECT_GT(overflowed, 0);
    }
    if (ended) {
        EXPECT_EQ(count(report.at("pixels"), "completed"), count(report.at("pixels"), "all"));
    }
    if (verdict == "completed") {
        EXPECT_EQ(overflowed, 0) << "what did not fit is named in the verdict";
    }
}

}  // namespace raycell::system_test
