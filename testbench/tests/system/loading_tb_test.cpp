// loading_tb, end to end: checks, figures, exit codes, files.
#include <algorithm>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const Words all_files = {"a.columns.csv", "a.json", "a.links.csv", "a.rows.csv", "a.toml"};

std::vector<std::vector<std::string>> table(const fs::path& path) {
    std::vector<std::vector<std::string>> lines;
    std::istringstream text(read_text(path));
    for (std::string line; std::getline(text, line);) {
        std::istringstream fields(line);
        lines.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) lines.back().push_back(field);
    }
    return lines;
}

/// Expects what must hold in every report of a completed run.
void expect_sound_loading(const Json& json) {
    for (const char* name : {"stores", "content", "order", "promptness", "conservation", "bound"}) {
        EXPECT_EQ(json.at("checks").at(name).at("faults"), 0) << name << json.at("checks").at(name);
    }
    EXPECT_EQ(json.at("messages").at("sent"), json.at("messages").at("delivered"));
    EXPECT_LE(json.at("bound").at("cycles").get<int>(), json.at("cycles").at("load").get<int>());
    const Json& stages = json.at("stages");
    EXPECT_EQ(stages.at("precomputation").at("messages"), json.at("links").at("polygons").at("messages"));
    EXPECT_EQ(stages.at("geometry").at("messages"), stages.at("precomputation").at("messages"));
    for (const auto& [name, stage] : stages.items()) {
        EXPECT_LE(stage.at("busy_share").get<double>() + stage.at("starved_share").get<double>() +
                      stage.at("blocked_share").get<double>(),
                  1.0)
            << name;
        EXPECT_LE(stage.at("busy_share").get<double>(), stage.at("busiest_share").get<double>() + 1e-9)
            << name;
    }
    EXPECT_EQ(stages.at("geometry").at("units"), stages.at("precomputation").at("units"));
    EXPECT_LE(json.at("items").at("polygons"), json.at("items").at("sent_polygons"));
    EXPECT_LE(json.at("items").at("trapezes"), json.at("items").at("sent_trapezes"));
    const Json& making = stages.at("cells").at("voxels");
    EXPECT_GE(making.at("spans"), json.at("voxels").at("stored"));
    EXPECT_LE(making.at("busiest_share").get<double>(), 1.0);
    EXPECT_LE(making.at("busy_share").get<double>(), making.at("busiest_share").get<double>() + 1e-9);
    for (const auto& [name, links] : json.at("links").items()) {
        if (links.at("links") == 0) continue;
        EXPECT_LE(links.at("occupancy").at("peak"), links.at("depth")) << name;
        EXPECT_LE(links.at("busiest_share").get<double>(), 1.0) << name;
    }
    std::uint64_t cells = 0;
    std::uint64_t voxels = 0;
    for (const Json& pair : json.at("voxels").at("cells_by_voxels")) {
        cells += pair[1].get<std::uint64_t>();
        voxels += pair[0].get<std::uint64_t>() * pair[1].get<std::uint64_t>();
    }
    EXPECT_EQ(cells, json.at("stages").at("cells").at("units"));
    EXPECT_EQ(voxels, json.at("voxels").at("stored"));
    const Json& first = json.at("wavefront").at("first_arrival");
    EXPECT_TRUE(std::is_sorted(first.begin(), first.end())) << "a wavefront goes from the left to the right";
    const Json& last = json.at("wavefront").at("last_arrival");
    EXPECT_TRUE(std::is_sorted(last.begin(), last.end()));
    EXPECT_LT(last.back().get<int>(), json.at("cycles").at("load").get<int>() + 1);
}

Json report(const Workshop& workshop, const Words& words, int exit_code = 0) {
    std::string command = "loading_tb";
    for (const std::string& word : words) command += " " + word;
    SCOPED_TRACE(command);
    const Finished finished =
        workshop.run_program(RAYCELL_LOADING_TB, joined(words, {"--quiet", "-o", "results/a"}));
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err.substr(0, 2000);
    EXPECT_EQ(finished.out, "") << "--quiet";
    EXPECT_EQ(workshop.results(), all_files);
    if (!fs::exists(workshop.result("a.json"))) return {};
    Json json = Json::parse(read_text(workshop.result("a.json")));
    if (exit_code == 0) expect_sound_loading(json);
    return json;
}

TEST(LoadingTb, ChecksAnOwnSceneAndTellsWhereTheCyclesWent) {
    const Workshop workshop;
    const Finished finished =
        workshop.run_program(RAYCELL_LOADING_TB, {own_scene("still_life.nff").string(), "--cells", "32x32"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    for (const char* part :
         {"verdict completed", "cycles per polygon", "bound", "geometry", "precomputation", "distribution",
          "cells", "starved", "blocked", "wavefront", "voxels per cell", "stores ok; content ok; order ok"}) {
        EXPECT_TRUE(contains(finished.out, part)) << part << "\n" << finished.out;
    }
    EXPECT_TRUE(workshop.results().empty()) << "no files unless they are asked for";
}

TEST(LoadingTb, LoadsAsRenderDoes) {
    const Workshop workshop;
    const Words machine = {own_scene("cornell.nff").string(),
                           "--cells",
                           "24x16",
                           "--cost",
                           "load_edge=30",
                           "--feed-lanes",
                           "6",
                           "--feed-bits",
                           "50",
                           "--load-queue",
                           "2"};
    const Json json = report(workshop, machine);
    const Finished rendered =
        workshop.run(joined(joined({"render"}, machine), {"--stage", "load", "--quiet", "-o", "results/b"}));
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    const Json other = Json::parse(read_text(workshop.result("b.json")));
    EXPECT_EQ(json.at("cycles").at("load"), other.at("cycles").at("load"));
    EXPECT_EQ(json.at("hash").at("schedule"), other.at("hash").at("schedule")) << "watching changes nothing";
    EXPECT_EQ(json.at("voxels").at("stored"), other.at("voxels").at("stored"));
    EXPECT_EQ(json.at("messages").at("hops"), other.at("hops").at("load"));
    EXPECT_EQ(json.at("items").at("sent_polygons"), other.at("stages").at("geometry").at("items"));
    EXPECT_EQ(json.at("items").at("sent_trapezes"), other.at("stages").at("precomputation").at("items"));
    EXPECT_EQ(json.at("stages").at("cells").at("voxels").at("most_kept"), other.at("load_queue").at("peak"));
    EXPECT_EQ(json.at("items").at("spans"), other.at("stages").at("distribution").at("items"));
    for (const char* stage : {"geometry", "precomputation", "distribution"}) {
        EXPECT_EQ(json.at("stages").at(stage).at("busy_cycles"),
                  other.at("stages").at(stage).at("busy_cycles"))
            << stage;
    }
}

TEST(LoadingTb, ChecksTeapotAtTheDefaults) {
    SKIP_WITHOUT_SHARED_SCENES();
    const Workshop workshop;
    const std::string teapot = (shared_scenes() / "spd" / "teapot-s4.nff").string();
    const auto efficiency = [](const Json& json) { return json.at("bound").at("efficiency").get<double>(); };
    // A cell takes long to make a voxel, and the fullest one has to make many.
    const Json whole = report(workshop, {teapot});
    EXPECT_TRUE(contains(whole.at("bound").at("of").get<std::string>(), "voxels of cell_"));
    EXPECT_GT(efficiency(whole), 0.7);
    // Where a span waits in each cell until the voxels before it are made, the same work takes far longer.
    const Json waiting = report(workshop, {teapot, "--load-queue", "1"});
    EXPECT_EQ(waiting.at("bound").at("cycles"), whole.at("bound").at("cycles"));
    EXPECT_GT(waiting.at("cycles").at("load").get<int>(), 2 * whole.at("cycles").at("load").get<int>());
    EXPECT_GT(waiting.at("stages").at("cells").at("waits").at("queue_full"), 0);
    EXPECT_EQ(whole.at("stages").at("cells").at("waits").at("queue_full"), 0);
    // With cells as fast as they were once estimated to be, the way into the array holds loading up: the only
    // lane's geometry, or its narrow wires.
    const Json single = report(workshop, {teapot, "--datapath", "estimate", "--feed-lanes", "1"});
    EXPECT_EQ(single.at("bound").at("of"), "geometry");
    const Words narrow = {teapot, "--datapath", "estimate", "--feed-lanes", "1", "--feed-bits",
                          "20",   "--buffer",   "1"};
    const Json json = report(workshop, narrow);
    EXPECT_EQ(json.at("bound").at("of"), "precomputation.out");
    // Messages are short: what lies between two of them, a row's work and a free place, counts for more.
    EXPECT_GT(efficiency(json), 0.65);
    // Trapezes are wide: with twice the buffer, a row takes the next one while it still sends the last one
    // on.
    const Json deeper = report(workshop, joined(Words(narrow.begin(), narrow.end() - 1), {"2"}));
    EXPECT_GT(efficiency(deeper), efficiency(json));
    EXPECT_EQ(deeper.at("bound").at("cycles"), json.at("bound").at("cycles"));
}

TEST(LoadingTb, LanesLoadTheSameInFewerCycles) {
    const Workshop workshop;
    const Words base = {"--random", "300", "--cells", "20x24", "--datapath", "estimate", "--most-size", "8"};
    const Json one = report(workshop, joined(base, {"--feed-lanes", "1"}));
    Json last = one;
    for (const std::string lanes : {"3", "8", "24", "100"}) {
        const Json json = report(workshop, joined(base, {"--feed-lanes", lanes}));
        EXPECT_EQ(json.at("stages").at("geometry").at("units"), std::min(std::stoi(lanes), 24));
        EXPECT_EQ(json.at("links").at("down").at("links"), 24 - std::min(std::stoi(lanes), 24));
        EXPECT_EQ(json.at("voxels"), one.at("voxels")) << lanes << " lanes";
        for (const char* items : {"polygons", "trapezes", "spans", "voxels"})
            EXPECT_EQ(json.at("items").at(items), one.at("items").at(items)) << items;
        EXPECT_GE(json.at("items").at("sent_polygons"), last.at("items").at("sent_polygons"));
        EXPECT_LE(json.at("cycles").at("load"), last.at("cycles").at("load")) << lanes << " lanes";
        last = json;
    }
    EXPECT_EQ(one.at("items").at("sent_polygons"), one.at("items").at("polygons"));
    EXPECT_LT(2 * last.at("cycles").at("load").get<int>(), one.at("cycles").at("load").get<int>());
}

TEST(LoadingTb, WiderFeedsAndLongerQueuesNeverNeedMoreWork) {
    const Workshop workshop;
    const Words base = {"--random", "250", "--cells", "18x18", "--feed-lanes", "4"};
    Json wires;
    for (const std::string bits : {"1", "20", "128", "4096"}) {
        const Json json = report(workshop, joined(base, {"--feed-bits", bits}));
        if (!wires.is_null()) {
            for (const char* links : {"polygons", "trapezes", "down"})
                EXPECT_LE(json.at("links").at(links).at("busy_share").get<double>() *
                              json.at("cycles").at("load").get<double>(),
                          wires.at("links").at(links).at("busy_share").get<double>() *
                              wires.at("cycles").at("load").get<double>())
                    << links;
        }
        wires = json;
    }
    const Json free = report(workshop, base);
    const auto most_kept = [](const Json& json) {
        return json.at("stages").at("cells").at("voxels").at("most_kept").get<int>();
    };
    EXPECT_GT(most_kept(free), 3);
    for (const int queue : {1, 3}) {
        const Json json = report(workshop, joined(base, {"--load-queue", std::to_string(queue)}));
        EXPECT_EQ(most_kept(json), queue);
        EXPECT_GT(json.at("cycles").at("load"), free.at("cycles").at("load"));
        EXPECT_EQ(json.at("voxels"), free.at("voxels"));
        for (const char* work : {"spans", "busy_cycles"})
            EXPECT_EQ(json.at("stages").at("cells").at("voxels").at(work),
                      free.at("stages").at("cells").at("voxels").at(work));
    }
}

TEST(LoadingTb, ChecksRandomPolygonsOnArraysOfAnyShape) {
    const Workshop workshop;
    for (const std::string cells : {"1x1", "1x40", "40x1", "17x9"}) {
        for (const std::string seed : {"1", "2", "3"}) {
            report(workshop, {"--random", "120", "--cells", cells, "--seed", seed});
            report(workshop, {"--random", "120", "--cells", cells, "--seed", seed, "--stall", "0.4",
                              "--display", "gouraud", "--sides", "7", "--most-size", "60", "--feed-lanes",
                              "4", "--load-queue", "2"});
        }
    }
}

TEST(LoadingTb, ChecksWhateverTheOptionsAre) {
    const Workshop workshop;
    const Words base = {"--random", "150", "--cells", "20x14", "--seed", "9"};
    const std::vector<Words> variants = {
        {"--hit", "mask"},
        {"--hit", "depth", "--depth", "7"},
        {"--hit", "interval", "--normals", "voxel"},
        {"--arithmetic", "exact", "--shadows", "memo"},
        {"--word-bits", "9", "--rounding", "truncate"},
        {"--buffer", "3", "--link-bits", "4096"},
        {"--link-bits", "7", "--stall", "0.9"},
        {"--slopes", "slope", "--most-slope", "1000", "--sizes", "uniform"},
        {"--slopes", "angle", "--least-size", "0.01", "--most-size", "0.5"},
        {"--objects", "150", "--cube-depth", "3"},
        {"--cost", "load_edge=400", "--cost", "distribution_span=90", "--cost", "distribution_pass=70"},
        {"--cost", "geometry_polygon=900"},
        {"--feed-lanes", "1", "--feed-bits", "20"},
        {"--feed-lanes", "5", "--feed-bits", "7", "--stall", "0.3"},
        {"--feed-lanes", "14", "--load-queue", "1"},
        {"--feed-lanes", "3", "--load-queue", "3", "--hit", "depth", "--buffer", "4"},
        {"--load-queue", "1", "--cost", "load_edge=1", "--cost", "load_advance=30"},
        {"--load-queue", "2", "--cost", "load_edge=40", "--cost", "load_advance=30", "--stall", "0.5"},
        {"--feed-lanes", "7", "--cost", "geometry_skip=50", "--objects", "30"},
        {"--cost", "precomputation_trapeze=1", "--cost", "load_edge=1"}};
    for (const Words& variant : variants) report(workshop, joined(base, variant));
}

TEST(LoadingTb, NamesTheStageThatHoldsLoadingUp) {
    const Workshop workshop;
    const Words base = {"--random",   "300",      "--cells",     "12x12", "--link-bits",  "2000",
                        "--datapath", "estimate", "--feed-bits", "2000",  "--feed-lanes", "1"};
    const auto busiest = [&](const Words& costs) {
        return report(workshop, joined(base, costs)).at("bound").at("busiest").at("of").get<std::string>();
    };
    EXPECT_EQ(busiest({"--cost", "geometry_polygon=500"}), "geometry");
    EXPECT_EQ(busiest({"--cost", "precomputation_trapeze=500"}), "precomputation");
    EXPECT_TRUE(contains(busiest({"--cost", "distribution_span=500"}), "distribution.row_"));
    EXPECT_TRUE(contains(busiest({"--cost", "load_edge=900"}), "voxels of cell_"));
    EXPECT_EQ(busiest({"--cost", "load_forward=900"}).substr(0, 5), "cell_");
    const Words lanes = {"--random", "300",          "--cells", "12x12",  "--datapath",
                         "estimate", "--feed-lanes", "4",       "--cost", "geometry_polygon=500"};
    EXPECT_TRUE(contains(report(workshop, lanes).at("bound").at("of").get<std::string>(), "geometry_"));
}

TEST(LoadingTb, StallsChangeTheCyclesAndNothingThatIsLoaded) {
    const Workshop workshop;
    const Words base = {"--random", "200", "--cells", "16x16"};
    const Json plain = report(workshop, base);
    const Json stalled = report(workshop, joined(base, {"--stall", "0.5"}));
    EXPECT_GT(stalled.at("cycles").at("load"), plain.at("cycles").at("load"));
    EXPECT_EQ(stalled.at("voxels"), plain.at("voxels"));
    EXPECT_EQ(stalled.at("bound"), [&] {
        Json bound = plain.at("bound");
        bound["efficiency"] = stalled.at("bound").at("efficiency");
        return bound;
    }());
}

TEST(LoadingTb, WritesTablesWhoseSumsAreTheReports) {
    const Workshop workshop;
    const Json json = report(workshop, {"--random", "200", "--cells", "11x7", "--feed-lanes", "3"});
    const auto columns = table(workshop.result("a.columns.csv"));
    const auto rows = table(workshop.result("a.rows.csv"));
    const auto links = table(workshop.result("a.links.csv"));
    EXPECT_EQ(columns.size(), 1u + 11);
    EXPECT_EQ(rows.size(), 1u + 7);
    EXPECT_EQ(links.size(), 1u + 2 * 3 + (7 - 3) + 7 + 7 * 10) << "no links between lanes";
    const auto sum = [](const auto& lines, const std::string& column) {
        const auto at = std::size_t(std::find(lines[0].begin(), lines[0].end(), column) - lines[0].begin());
        std::uint64_t total = 0;
        for (std::size_t i = 1; i < lines.size(); ++i) total += std::stoull(lines[i].at(at));
        return total;
    };
    EXPECT_EQ(sum(columns, "voxels"), json.at("voxels").at("stored"));
    EXPECT_EQ(sum(columns, "messages"), json.at("stages").at("cells").at("messages"));
    EXPECT_EQ(sum(rows, "busy_cycles"), json.at("stages").at("distribution").at("busy_cycles"));
    EXPECT_EQ(sum(rows, "sent_east"), json.at("messages").at("sent"));
    EXPECT_EQ(sum(links, "wire_cycles"), sum(links, "needed_cycles")) << "without stalls";
    for (const auto& lines : {columns, rows, links}) {
        for (const auto& line : lines) EXPECT_EQ(line.size(), lines[0].size());
    }
}

TEST(LoadingTb, EndsWithTheLimitsExitCodeWhereSomethingDidNotFit) {
    const Workshop workshop;
    const Json json = report(workshop, {"--random", "400", "--cells", "8x8", "--voxel-capacity", "3"}, 4);
    EXPECT_EQ(json.at("verdict"), "capacity");
    EXPECT_GT(json.at("voxels").at("overflowed"), 0);
    EXPECT_EQ(json.at("checks").at("stores").at("faults"), 0);
    const Json stopped = report(workshop, {"--random", "400", "--cells", "8x8", "--max-cycles", "500"}, 4);
    EXPECT_EQ(stopped.at("verdict"), "cycle_limit");
    EXPECT_FALSE(stopped.at("checks").contains("stores")) << "half a scene is not compared";
    EXPECT_EQ(stopped.at("checks").at("order").at("faults"), 0);
}

TEST(LoadingTb, DoesTheSameAgainFromItsConfigurationAndTakesRenders) {
    const Workshop workshop;
    const Json first = report(workshop, {"--random", "90", "--cells", "12x9", "--stall", "0.2", "--seed", "5",
                                         "--buffer", "2", "--cost", "load_forward=3"});
    fs::copy_file(workshop.result("a.toml"), workshop.path() / "first.toml");
    const Json second = report(workshop, {"--config", "first.toml"});
    EXPECT_EQ(schedule(second), schedule(first));
    EXPECT_EQ(second.at("config"), first.at("config"));
    EXPECT_NE(schedule(report(workshop, {"--config", "first.toml", "--seed", "6"})), schedule(first));
    const Finished rendered =
        workshop.render(own_scene("cornell.nff"), {"--cells", "8x8", "--stage", "load"}, "b");
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    fs::copy_file(workshop.result("b.toml"), workshop.path() / "render.toml");
    for (const std::string& name : workshop.results()) fs::remove(workshop.result(name));
    EXPECT_EQ(report(workshop, {"--config", "render.toml"}).at("stages").at("cells").at("units"), 64);
}

TEST(LoadingTb, RefusesWhatItCannotUnderstand) {
    const Workshop workshop;
    const std::vector<Words> wrong = {{},
                                      {"missing.nff"},
                                      {"--random", "-1"},
                                      {"--random", "5", own_scene("cornell.nff").string()},
                                      {"--random", "5", "--sides", "2"},
                                      {"--random", "5", "--least-size", "5", "--most-size", "4"},
                                      {"--random", "5", "--slopes", "steep"},
                                      {"--random", "5", "--buffer", "0"},
                                      {"--random", "5", "--feed-lanes", "0"},
                                      {"--random", "5", "--feed-bits", "0"},
                                      {"--random", "5", "--load-queue", "-1"},
                                      {"--random", "5", "--ray-store", "8"},
                                      {"--random", "5", "--cells", "0x4"},
                                      {"--random", "5", "--config", "missing.toml"},
                                      {"--random", "5", "-o", "/dev/null/a"},
                                      {"--nonsense"}};
    for (const Words& words : wrong) {
        const Finished finished = workshop.run_program(RAYCELL_LOADING_TB, words);
        EXPECT_EQ(finished.exit_code, 1) << (words.empty() ? "" : words.back());
        EXPECT_GE(finished.error_lines(), 1u);
        EXPECT_LE(finished.error_lines(), 3u) << finished.err;
        EXPECT_EQ(finished.out, "");
    }
    EXPECT_TRUE(workshop.results().empty());
}

}  // namespace
}  // namespace raycell::system_test
