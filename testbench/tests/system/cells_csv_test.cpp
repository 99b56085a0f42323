// name.cells.csv and the activity over time: their sums equal the report's totals.
#include <algorithm>
#include <map>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const std::vector<std::string> causes = {"stall_traversal",   "stall_output_full", "stall_output_busy",
                                         "stall_no_slot",     "stall_shading",     "stall_store_port",
                                         "stall_answer_full", "stall_answer_busy"};

/// The columns of a cells.csv.
using Columns = std::map<std::string, std::vector<double>>;

Columns read_columns(const fs::path& path) {
    std::istringstream text(read_text(path));
    std::string line;
    std::getline(text, line);
    std::vector<std::string> names;
    std::istringstream head(line);
    for (std::string name; std::getline(head, name, ',');) names.push_back(name);
    Columns columns;
    while (std::getline(text, line)) {
        std::istringstream fields(line);
        std::size_t i = 0;
        for (std::string field; std::getline(fields, field, ','); ++i)
            columns[names.at(i)].push_back(std::stod(field));
        EXPECT_EQ(i, names.size()) << line;
    }
    return columns;
}

double sum(const std::vector<double>& values) {
    double all = 0;
    for (const double value : values) all += value;
    return all;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

struct Outcome {
    Json report;
    Columns cells;
};

Outcome run(const std::string& scene, const Words& words, int exit_code = 0) {
    const Workshop workshop;
    Outcome done;
    done.report = workshop.report(own_scene(scene), words, exit_code);
    done.cells = read_columns(workshop.result("a.cells.csv"));
    return done;
}

/// Completed runs of several kinds, and one that ends in a deadlock.
std::vector<Outcome> runs() {
    return {run("still_life.nff", {"--cells", "24x16", "--ray-store", "5"}),
            run("cornell.nff", {"--cells", "16x24", "--shadows", "precast", "--networks", "quadrant",
                                "--buffer", "3", "--exterior", "none"}),
            run("still_life.nff", {"--cells", "16x16", "--shadows", "memo", "--slots", "free"}),
            run("facing_mirrors.nff", {"--cells", "32x32", "--buffer", "1", "--networks", "shared"}, 3)};
}

TEST(CellsCsv, CellsAddUpToTheReport) {
    for (Outcome& r : runs()) {
        SCOPED_TRACE(r.report.at("config").dump());
        Columns& c = r.cells;
        const Json& hops = r.report.at("hops");
        const Json& cycles = r.report.at("cycles");
        EXPECT_EQ(sum(c["hops_ray"]), hops.at("ray").get<double>());
        EXPECT_EQ(sum(c["hops_load"]), hops.at("load").get<double>());
        // Answers that the exterior sends over the border are counted by no cell.
        const double exterior = hops.at("return").get<double>() - sum(c["hops_return"]);
        const double handed_over = r.report.at("rays").at("exterior").get<double>();
        EXPECT_GE(exterior, 0);
        EXPECT_LE(exterior, handed_over);
        if (r.report.at("verdict") == "completed" && r.report.at("rays").at("precast") == 0) {
            EXPECT_EQ(exterior, handed_over);
        }
        EXPECT_EQ(sum(c["postponed"]), r.report.at("deadlock").at("postponed").get<double>());
        EXPECT_EQ(sum(c["voxels"]), r.report.at("voxels").at("stored").get<double>());
        EXPECT_EQ(most(c["ray_store_peak"]), r.report.at("ray_store").at("peak").get<double>());
        const double cells = double(c["x"].size());
        EXPECT_NEAR(sum(c["ray_store_mean"]) / cells, r.report.at("ray_store").at("mean").get<double>(),
                    1e-5);
        const double cell_cycles =
            cells * (cycles.at("precast").get<double>() + cycles.at("trace").get<double>());
        for (const std::string unit : {"traversal", "shading"}) {
            const double units =
                unit == "traversal" ? r.report.at("config").at("traversal-units").get<double>() : 1;
            EXPECT_NEAR(sum(c[unit + "_cycles"]) / (cell_cycles * units),
                        r.report.at("units").at(unit).at("utilisation").get<double>(), 1e-9);
        }
    }
}

TEST(CellsCsv, NoMeanIsAboveItsPeakAndNoPeakAboveTheDepth) {
    for (Outcome& r : runs()) {
        SCOPED_TRACE(r.report.at("config").dump());
        const double depth = r.report.at("buffers").at("depth").get<double>();
        for (const std::string what : {"ray_store", "ray_buffers", "answer_buffers"}) {
            const auto& peaks = r.cells[what + "_peak"];
            const auto& means = r.cells[what + "_mean"];
            ASSERT_EQ(peaks.size(), means.size());
            for (std::size_t i = 0; i < peaks.size(); ++i) {
                ASSERT_LE(means[i], peaks[i]) << what << " of cell " << i;
                ASSERT_EQ(means[i] > 0, peaks[i] > 0) << what << " of cell " << i;
                if (what != "ray_store") {
                    ASSERT_LE(peaks[i], depth);
                }
            }
            const bool no_such_buffer =
                what == "answer_buffers" && r.report.at("config").at("networks") == "shared";
            EXPECT_EQ(most(peaks) > 0, !no_such_buffer) << what;
        }
    }
}

TEST(CellsCsv, WaitingIsTheSumOfItsCauses) {
    for (Outcome& r : runs()) {
        SCOPED_TRACE(r.report.at("config").dump());
        const auto& all = r.cells["stall_cycles"];
        EXPECT_GT(sum(all), 0);
        // Upper limit: everything that a cell can hold waits all the time. That is the buffers' heads, the
        // slots, their children, an own ray and an answer in the shading unit.
        const Json& cycles = r.report.at("cycles");
        const double places = 4 * 5 + 2 * r.report.at("ray_store").at("capacity").get<double>() + 2;
        const double limit =
            places * (cycles.at("precast").get<double>() + cycles.at("trace").get<double>() + 2);
        for (std::size_t i = 0; i < all.size(); ++i) {
            double parts = 0;
            for (const std::string& cause : causes) {
                ASSERT_GE(r.cells[cause][i], 0);
                parts += r.cells[cause][i];
            }
            ASSERT_EQ(all[i], parts) << "cell " << i;
            ASSERT_LE(all[i], limit) << "cell " << i;
        }
        EXPECT_EQ(sum(r.cells["stall_no_slot"]), 0) << "a ray without a slot is destroyed";
    }
}

TEST(CellsCsv, HitsWithoutASlotWaitWhereNothingIsPostponed) {
    Outcome r = run("facing_mirrors.nff", {"--cells", "32x32", "--recovery", "none", "--ray-store", "1"}, 3);
    EXPECT_GT(sum(r.cells["stall_no_slot"]), 0);
    EXPECT_EQ(sum(r.cells["postponed"]), 0);
}

TEST(CellsCsv, NothingWaitsInACellWithOneRayAtATime) {
    Outcome r = run("cornell.nff", {"--cells", "1x1", "--max-depth", "0", "--exterior", "none"});
    EXPECT_GT(sum(r.cells["traversal_cycles"]), 0);
    EXPECT_GT(sum(r.cells["shading_cycles"]), 0);
    for (const std::string& cause : causes) EXPECT_EQ(sum(r.cells[cause]), 0) << cause;
}

TEST(CellsCsv, DeeperBuffersLeaveFewerRaysWaitingForRoom) {
    const Words words = {"--cells", "24x24"};
    Outcome shallow = run("still_life.nff", words);
    Outcome deep = run("still_life.nff", joined(words, {"--buffer", "64"}));
    EXPECT_LT(sum(deep.cells["stall_output_full"]), sum(shallow.cells["stall_output_full"]) / 10);
}

TEST(CellsCsv, TheUntimedEngineTellsVoxelsAndEdgesAlone) {
    const Words words = {"--cells", "9x7"};
    Outcome untimed = run("still_life.nff", joined(words, {"--engine", "untimed"}));
    Outcome timed = run("still_life.nff", words);
    EXPECT_EQ(untimed.cells.size(), 4u);
    for (const std::string column : {"x", "y", "voxels", "edges"}) {
        EXPECT_EQ(untimed.cells[column], timed.cells[column]) << column;
    }
    EXPECT_FALSE(untimed.report.contains("activity"));
}

// ---- activity

double total(const Json& list) {
    double all = 0;
    for (const auto& value : list) all += value.get<double>();
    return all;
}

void expect_whole_buckets(const Json& series, const Words& lists) {
    const double width = series.at("bucket_cycles");
    const double cycles = series.at("cycles");
    for (const std::string& name : lists) {
        const std::size_t buckets = series.at(name).size();
        EXPECT_LE(buckets, 200u) << name;
        EXPECT_GE(double(buckets) * width, cycles) << name;
        EXPECT_LT(double(buckets - 1) * width, cycles) << name << ": the last one is empty";
        if (width > 1) {
            EXPECT_GE(buckets, 100u) << name << ": wider than needed";
        }
        for (const auto& value : series.at(name)) ASSERT_GE(value.get<double>(), 0) << name;
    }
}

TEST(Activity, BucketsAddUpToTheReport) {
    for (const Outcome& r : runs()) {
        SCOPED_TRACE(r.report.at("config").dump());
        const Json& a = r.report.at("activity");
        const Json& hops = r.report.at("hops");
        expect_whole_buckets(
            a, {"rays_in_flight", "answers_in_flight", "slots_used", "hops", "pixels_done", "postponed"});
        expect_whole_buckets(a.at("load"), {"hops", "cells_loaded"});
        EXPECT_EQ(total(a.at("hops")), hops.at("ray").get<double>() + hops.at("return").get<double>());
        EXPECT_EQ(total(a.at("load").at("hops")), hops.at("load").get<double>());
        EXPECT_EQ(total(a.at("load").at("cells_loaded")), double(r.cells.at("x").size()));
        EXPECT_EQ(total(a.at("postponed")), r.report.at("deadlock").at("postponed").get<double>());
        if (r.report.at("verdict") == "completed") {
            EXPECT_EQ(total(a.at("pixels_done")), double(r.cells.at("x").size()));
        }
        // Slots over all cells and cycles; the last bucket may be shorter than the others.
        const double width = a.at("bucket_cycles");
        double slots = 0;
        for (std::size_t i = 0; i < a.at("slots_used").size(); ++i) {
            const double cycles = std::min(width, a.at("cycles").get<double>() - double(i) * width);
            slots += a.at("slots_used")[i].get<double>() * cycles;
        }
        const double mean = slots / r.report.at("cycles").at("trace").get<double>();
        EXPECT_NEAR(mean, sum(r.cells.at("ray_store_mean")), 1e-3 * mean + 1e-3);
        EXPECT_GE(a.at("trace_start"), a.at("start_cycle"));
    }
}

TEST(Activity, WhatIsStuckStaysInFlightToTheEnd) {
    const Outcome r =
        run("facing_mirrors.nff", {"--cells", "32x32", "--buffer", "1", "--networks", "shared"}, 3);
    EXPECT_GT(r.report.at("activity").at("rays_in_flight").back(), 0);
    EXPECT_GT(r.report.at("activity").at("slots_used").back(), 0);
    const Outcome done = run("facing_mirrors.nff", {"--cells", "32x32"});
    EXPECT_LT(done.report.at("activity").at("rays_in_flight").back(), 32);
}

}  // namespace
}  // namespace raycell::system_test
