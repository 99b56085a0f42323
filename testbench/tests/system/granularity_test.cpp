// --granularity and --detail of raycell render and deadlock_tb: files do not depend on the host of the cells.
#include <algorithm>
#include <sstream>

#include "limited.hpp"

namespace raycell::system_test {
namespace {

const std::vector<Words> every_granularity = {{"--granularity", "auto"},
                                              {"--granularity", "tile"},
                                              {"--granularity", "cell"},
                                              {"--detail", "0..3,0..23"},
                                              {"--detail", "5,7", "--detail", "20..23,10..30"},
                                              {"--granularity", "tile", "--detail", "9..12,9..12"}};

/// The sorted events of a golden file; within a cycle their order is that in which the cells ran.
std::string events(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind("config ", 0) != 0) lines.push_back(line + '\n');
    }
    std::sort(lines.begin(), lines.end());
    std::string sorted;
    for (const std::string& line : lines) sorted += line;
    return sorted;
}

/// What a run writes beside the picture, without the parts that may differ.
std::string telling(const Workshop& workshop, const std::vector<std::string>& suffixes) {
    Json report = Json::parse(read_text(workshop.result("a.json")));
    report.erase("model");
    report.erase("config");
    std::string all = report.dump();
    for (const std::string& suffix : suffixes) {
        const std::string text = read_text(workshop.result("a" + suffix));
        EXPECT_FALSE(text.empty()) << suffix;
        all += contains(suffix, ".golden") ? events(text) : text;
    }
    return all;
}

void expect_equal_files(const std::string& scene, const Words& words, int exit_code,
                        const std::vector<std::string>& suffixes) {
    const Workshop workshop;
    std::string first;
    for (const Words& granularity : every_granularity) {
        SCOPED_TRACE(granularity.back());
        workshop.report(own_scene(scene), joined(words, granularity), exit_code);
        const std::string now = telling(workshop, suffixes);
        if (first.empty()) first = now;
        EXPECT_TRUE(now == first);
    }
}

TEST(Granularity, DoesNotShowInReportsAndCells) {
    expect_equal_files("still_life.nff", {"--cells", "24x31", "--stall", "0.2"}, 0, {".cells.csv"});
}

TEST(Granularity, DoesNotShowInWaveformsAndGoldenVectors) {
    expect_equal_files("cornell.nff",
                       {"--cells", "24x31", "--probe", "3..5,7", "--golden", "0,0", "--golden", "5,7"}, 0,
                       {".vcd", ".gtkw", ".cells.csv", ".golden_0_0.txt", ".golden_5_7.txt"});
}

TEST(Granularity, DoesNotShowInADeadlockItsGraphAndItsWaveforms) {
    expect_equal_files("facing_mirrors.nff",
                       {"--cells", "24x31", "--ray-store", "1", "--recovery", "none", "--vcd-on-deadlock"}, 3,
                       {".waits.json", ".knot.svg", ".vcd", ".cells.csv"});
}

TEST(Granularity, DoesNotShowInSyntheticTraffic) {
    const Workshop workshop;
    std::string first;
    for (const Words& granularity : every_granularity) {
        SCOPED_TRACE(granularity.back());
        const Finished finished = workshop.run_program(
            RAYCELL_DEADLOCK_TB, joined({"--cells", "24x31", "--buffer", "1", "--networks", "shared", "-o",
                                         workshop.result("a").string(), "--quiet"},
                                        granularity));
        EXPECT_EQ(finished.exit_code, 3) << finished.err;
        const std::string now = telling(workshop, {});
        if (first.empty()) first = now;
        EXPECT_TRUE(now == first);
    }
}

// The sanitizer's own memory would be measured with that of the cells.
#ifndef __SANITIZE_ADDRESS__
TEST(Granularity, OfTilesTakesAFractionOfTheMemoryOfModules) {
    const Workshop workshop;
    const auto bytes = [&](const Words& granularity) {
        const Json report = workshop.report(
            own_scene("cornell.nff"), joined({"--cells", "200x200", "--max-cycles", "1"}, granularity), 4);
        return report.at("model").at("bytes_per_cell").get<double>();
    };
    const double tile = bytes({"--granularity", "tile"});
    EXPECT_LT(tile, 2200);
    EXPECT_GT(bytes({"--granularity", "cell"}), 3 * tile);
    EXPECT_LT(bytes({"--detail", "0..9,0..9"}), 1.2 * tile);
}
#endif

#ifndef __SANITIZE_ADDRESS__
TEST(Granularity, OfModulesIsRefusedWhereTheirMemoryIsNotThere) {
    const Workshop workshop;
    const Finished finished = run_within(8000, workshop, RAYCELL_PROGRAM,
                                         {"render", own_scene("cornell.nff").string(), "--cells", "4096x4096",
                                          "--granularity", "cell", "-o", "results/a"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "or --granularity tile")) << finished.err;
    EXPECT_LT(finished.megabytes, 100);
}
#endif

TEST(Granularity, IsRefusedInContradictionsAndOutsideTheArray) {
    const Workshop workshop;
    const std::vector<std::pair<Words, std::string>> wrongs = {
        {{"--detail", "8,0"}, "--detail: cell (8, 0) lies outside"},
        {{"--detail", "1,1", "--granularity", "cell"}, "every cell is a module already"},
        {{"--detail", "1,1", "--engine", "untimed"}, "untimed"},
        {{"--granularity", "block"}, "auto|cell|tile"}};
    for (const auto& [words, message] : wrongs) {
        const Finished finished =
            workshop.render(own_scene("cornell.nff"), joined({"--cells", "8x8"}, words));
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, message)) << finished.err;
        EXPECT_TRUE(workshop.results().empty());
    }
}

}  // namespace
}  // namespace raycell::system_test
