// The picture does not depend on settings of time and transport (invariant 2); the schedule does.
#include <map>
#include <set>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const Words square = {"--cells", "32x32"};

const std::vector<Words>& settings_of_time() {
    static const std::vector<Words> all = {
        {},
        {"--buffer", "2"},
        {"--buffer", "5"},
        {"--ray-store", "5"},
        {"--ray-store", "20"},
        {"--networks", "quadrant"},
        {"--networks", "quadrant", "--buffer", "2", "--ray-store", "5"},
        {"--recovery", "none", "--ray-store", "20"},
        {"--slots", "free"},
        {"--link-bits", "1"},
        {"--link-bits", "400"},
        {"--link-bits", "7"},
        {"--cost", "walk_step=1", "--cost", "compare_edge=1", "--cost", "per_edge=1"},
        {"--cost", "shade_setup=300", "--cost", "source_view=1"},
        {"--cost", "route_return=9", "--cost", "backoff=1"},
        {"--cost", "load_edge=90", "--cost", "distribution_pass=30"},
        {"--feed-lanes", "1"},
        {"--feed-lanes", "5", "--feed-bits", "1"},
        {"--feed-lanes", "4096", "--feed-bits", "4096", "--load-queue", "3"},
        {"--load-queue", "1", "--cost", "geometry_skip=30", "--cost", "load_advance=20"},
        {"--cost", "load_order=40", "--start-within", "3000"},
        {"--exterior-processors", "1"},
        {"--exterior-latency", "5000"},
        {"--seed", "2"},
        {"--max-cycles", "100000000"},
    };
    return all;
}

class PictureOf : public ::testing::TestWithParam<const char*> {};

TEST_P(PictureOf, DoesNotDependOnTimeAndTransport) {
    const Workshop workshop;
    std::set<std::string> images;
    std::set<std::string> schedules;
    for (const Words& words : settings_of_time()) {
        const Json report = workshop.report(own_scene(GetParam()), joined(square, words));
        if (report.is_null()) continue;
        EXPECT_EQ(report.at("verdict"), "completed");
        images.insert(image(report));
        schedules.insert(schedule(report));
        EXPECT_EQ(images.size(), 1u) << report.at("config");
    }
    EXPECT_GE(schedules.size(), settings_of_time().size() / 2) << "time changes the schedule";
}

TEST(ExteriorProcessors, ThatAreNeverBusyCostNeitherTimeNorMemory) {
    // If a step visited all processors, a million of them would take minutes. No run here has that many rays
    // outside.
    const Workshop workshop;
    const Words words = {"--cells", "128x128", "--exterior-processors"};
    const Json some = workshop.report(own_scene("still_life.nff"), joined(words, {"5000"}));
    const Json many = workshop.report(own_scene("still_life.nff"), joined(words, {"1000000"}));
    ASSERT_FALSE(some.is_null() || many.is_null());
    EXPECT_GT(some.at("stages").at("exterior").at("items"), 1000) << "else this tests nothing";
    EXPECT_EQ(schedule(many), schedule(some));
    EXPECT_EQ(image(many), image(some));
    const auto memory = [](const Json& report) {
        return report.at("model").at("peak_memory_bytes").get<double>();
    };
    if (!sanitized) {
        EXPECT_LT(memory(many), memory(some) + 20e6);
    }
}

INSTANTIATE_TEST_SUITE_P(Own, PictureOf, ::testing::Values("still_life.nff", "facing_mirrors.nff"),
                         [](const auto& test) {
                             const std::string name = test.param;
                             return name.substr(0, name.find('.'));
                         });

TEST(Picture, DoesNotDependOnTimeAndTransportWithPrecastShadowsEither) {
    const Workshop workshop;
    std::set<std::string> images;
    for (const std::string shadows : {"precast", "memo"}) {
        for (const Words& words :
             {Words{}, Words{"--buffer", "5"}, Words{"--ray-store", "5"}, Words{"--networks", "quadrant"},
              Words{"--link-bits", "400"}, Words{"--slots", "free"}}) {
            images.insert(image(workshop.report(own_scene("still_life.nff"),
                                                joined(joined(square, {"--shadows", shadows}), words))));
        }
    }
    EXPECT_EQ(images.size(), 1u);
}

TEST(Picture, DoesNotDependOnWordsAndOperatorsInExactArithmetic) {
    // In exact arithmetic they only determine how long messages and operators take.
    const Workshop workshop;
    std::set<std::string> images;
    std::set<std::string> schedules;
    const std::vector<Words> all = {{},
                                    {"--word-bits", "8"},
                                    {"--word-bits", "32"},
                                    {"--reciprocal", "rounded"},
                                    {"--root", "table"},
                                    {"--power", "schlick"},
                                    {"--cost", "root_newton=9"}};
    const Words exact = joined(square, {"--arithmetic", "exact"});
    for (const Words& words : all) {
        const Json report = workshop.report(own_scene("still_life.nff"), joined(exact, words));
        images.insert(image(report));
        schedules.insert(schedule(report));
    }
    EXPECT_EQ(images.size(), 1u);
    EXPECT_EQ(schedules.size(), all.size());
    for (const Words& words : {Words{"--rounding", "truncate"}, Words{"--root-table", "4"}}) {
        const Json report = workshop.report(own_scene("still_life.nff"), joined(exact, words));
        EXPECT_EQ(images.count(image(report)), 1u);
        EXPECT_EQ(schedules.count(schedule(report)), 1u) << "nor does the schedule on these";
    }
}

TEST(Schedule, IsEqualForEqualConfigurationsAndForWhatIsNoTime) {
    const Workshop workshop;
    const auto of = [&](const Words& words) {
        return schedule(workshop.report(own_scene("still_life.nff"), joined(square, words)));
    };
    const std::string first = of({});
    EXPECT_EQ(of({}), first);
    EXPECT_EQ(of({"--clock-mhz", "100"}), first) << "cycles don't know how long they last";
    EXPECT_EQ(of({"--truth"}), first);
    EXPECT_EQ(of({"--buffer", "2", "--ray-store", "8", "--networks", "half"}), first)
        << "the defaults, spelt out";
}

TEST(Schedule, DiffersWithBuffersRayStoreNetworksAndLinks) {
    const Workshop workshop;
    std::set<std::string> schedules;
    const std::vector<Words> all = {{},
                                    {"--buffer", "1"},
                                    {"--traversal-units", "1"},
                                    {"--loading-units", "4"},
                                    {"--ray-store", "5"},
                                    {"--networks", "quadrant"},
                                    {"--link-bits", "400"},
                                    {"--cost", "walk_step=5"}};
    for (const Words& words : all) {
        schedules.insert(schedule(workshop.report(own_scene("still_life.nff"), joined(square, words))));
    }
    EXPECT_EQ(schedules.size(), all.size());
}

TEST(Cost, AFasterClockShortensSecondsAndNotCycles) {
    const Workshop workshop;
    const Json slow = workshop.report(own_scene("cornell.nff"), joined(square, {"--clock-mhz", "10"}));
    const Json fast = workshop.report(own_scene("cornell.nff"), joined(square, {"--clock-mhz", "40"}));
    EXPECT_EQ(slow.at("cycles"), fast.at("cycles"));
    EXPECT_NEAR(slow.at("simulated_seconds").get<double>(), 4 * fast.at("simulated_seconds").get<double>(),
                1e-9);
}

/// A CSV table with a header line, by column.
std::map<std::string, std::vector<std::int64_t>> columns(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    std::vector<std::string> names;
    std::string word;
    for (std::istringstream header(line); std::getline(header, word, ',');) names.push_back(word);
    std::map<std::string, std::vector<std::int64_t>> all;
    while (std::getline(lines, line)) {
        std::istringstream row(line);
        for (std::size_t i = 0; std::getline(row, word, ','); ++i)
            all[names.at(i)].push_back(std::stoll(word));
    }
    return all;
}

TEST(Cells, TheTableOfCellsAddsUpToTheReport) {
    const Workshop workshop;
    for (const std::string engine : {"timed", "untimed"}) {
        const Json report =
            workshop.report(own_scene("still_life.nff"), {"--cells", "20x11", "--engine", engine});
        const auto table = columns(read_text(workshop.result("a.cells.csv")));
        ASSERT_TRUE(table.count("voxels") && table.count("x") && table.count("y"));
        std::set<std::pair<std::int64_t, std::int64_t>> cells;
        std::int64_t voxels = 0;
        std::int64_t most = 0;
        for (std::size_t i = 0; i < table.at("x").size(); ++i) {
            cells.insert({table.at("x")[i], table.at("y")[i]});
            voxels += table.at("voxels")[i];
            most = std::max(most, table.at("voxels")[i]);
        }
        EXPECT_EQ(cells.size(), 20u * 11u) << "one row per cell";
        EXPECT_EQ(voxels, report.at("voxels").at("stored").get<std::int64_t>());
        EXPECT_EQ(most, report.at("voxels").at("max_per_cell").get<std::int64_t>());
        if (engine == "untimed") continue;
        const auto& peaks = table.at("ray_store_peak");
        EXPECT_EQ(*std::max_element(peaks.begin(), peaks.end()),
                  report.at("ray_store").at("peak").get<std::int64_t>());
    }
}

}  // namespace
}  // namespace raycell::system_test
