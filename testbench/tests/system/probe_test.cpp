// --probe, --window and --vcd-on-deadlock of raycell render: files, refusals; watching changes nothing.
#include <set>

#include "../vcd.hpp"
#include "program.hpp"

namespace raycell::system_test {
namespace {

constexpr std::uint64_t period_ps = 50000;  // of the default clock, 20 MHz

vcd::Dump read_dump(const Workshop& workshop, std::uint64_t period = period_ps) {
    return vcd::parse(read_text(workshop.result("a.vcd")), period);
}

std::set<std::string> cells_of(const vcd::Dump& dump) {
    std::set<std::string> cells;
    for (const auto& [path, kind] : dump.kinds) {
        const auto at = path.find(".cell_");
        if (at != std::string::npos) cells.insert(path.substr(at + 1, path.find('.', at + 1) - at - 1));
    }
    return cells;
}

/// The signal paths that a save file shows, without their ranges.
std::vector<std::string> shown(const std::string& save_file) {
    std::vector<std::string> paths;
    std::istringstream lines(save_file);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || contains("[*@-", line.substr(0, 1))) continue;
        paths.push_back(line.substr(0, line.find('[')));
    }
    return paths;
}

TEST(Probe, MakesADumpAndASaveFileThatShowsItsSignalsAndLeavesTheRunAsItIs) {
    const Workshop workshop;
    const Words words = {"--cells", "24x24", "--buffer", "2"};
    const Json plain = workshop.report(own_scene("still_life.nff"), words);
    const Json probed = workshop.report(own_scene("still_life.nff"),
                                        joined(words, {"--probe", "0,3", "--probe", "10..11,12..13"}));
    EXPECT_EQ(image(probed), image(plain));
    EXPECT_EQ(schedule(probed), schedule(plain));
    EXPECT_EQ(probed.at("cycles"), plain.at("cycles"));
    const vcd::Dump dump = read_dump(workshop);
    EXPECT_EQ(cells_of(dump),
              (std::set<std::string>{"cell_0_3", "cell_10_12", "cell_11_12", "cell_10_13", "cell_11_13"}));
    EXPECT_FALSE(dump.of("raycell.cell_0_3.distributor.load.occupancy").size() < 3) << "loading is shown";
    const auto paths = shown(read_text(workshop.result("a.gtkw")));
    EXPECT_EQ(paths.size(), dump.kinds.size());
    for (const std::string& path : paths) EXPECT_EQ(dump.kinds.count(path), 1u) << path;
    EXPECT_EQ(workshop.usual_results(), (std::vector<std::string>{"a.cells.csv", "a.exr", "a.gtkw", "a.json",
                                                                  "a.png", "a.toml", "a.vcd"}));
}

TEST(Probe, TimesAreCyclesOfTheClockThatWasAskedFor) {
    const Workshop workshop;
    const Words words = {"--cells", "8x8", "--probe", "3,3", "--window", ":2000", "--clock-mhz"};
    for (const auto& [mhz, period] :
         {std::pair<std::string, std::uint64_t>{"100", 10000}, {"0.001", 1000000000}, {"3", 333333}}) {
        workshop.report(own_scene("cornell.nff"), joined(words, {mhz}));
        const vcd::Dump dump = read_dump(workshop, period);
        EXPECT_EQ(dump.stamps.back(), 2001u) << mhz;
        EXPECT_GT(dump.stamps.size(), 10u);
    }
}

TEST(Probe, IsRefusedOutsideTheArrayWithoutTimeAndInContradictions) {
    const Workshop workshop;
    const std::vector<std::pair<Words, std::string>> wrongs = {
        {{"--probe", "8,0"}, "--probe: cell (8, 0) lies outside"},
        {{"--probe", "0..3,0..8"}, "y from 0 to 7"},
        {{"--probe", "3"}, "--probe"},
        {{"--probe", "1,1", "--engine", "untimed"}, "untimed"},
        {{"--vcd-on-deadlock", "--engine", "untimed"}, "untimed"},
        {{"--vcd-on-deadlock", "--probe", "1,1"}, "no --probe"},
        {{"--window", "3:4"}, "--window: expected --probe"},
        {{"--probe", "1,1", "--window", "5:4"}, "--window"},
        {{"--probe", "1,1", "--window", "5"}, "--window"},
        {{"--probe", "1,1", "--window", "-1:"}, "--window"},
        {{"--probe", "1,1", "--vcd-limit", "0"}, "--vcd-limit"}};
    for (const auto& [words, part] : wrongs) {
        const Finished finished =
            workshop.render(own_scene("cornell.nff"), joined({"--cells", "8x8"}, words));
        EXPECT_EQ(finished.exit_code, 1) << part;
        EXPECT_TRUE(contains(finished.err, part)) << finished.err;
        EXPECT_EQ(workshop.usual_results(), std::vector<std::string>());
    }
}

TEST(Probe, ADumpThatReachesItsLimitEndsThereAndTheRunGoesOn) {
    const Workshop workshop;
    const Words words = {"--cells", "32x32"};
    const Json plain = workshop.report(own_scene("still_life.nff"), words);
    const Finished finished = workshop.render(own_scene("still_life.nff"),
                                              joined(words, {"--probe", "8..15,8..15", "--vcd-limit", "1"}));
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(contains(finished.err, "has reached --vcd-limit (1.0 MB) and ends before cycle "))
        << finished.err;
    EXPECT_EQ(schedule(Json::parse(read_text(workshop.result("a.json")))), schedule(plain));
    EXPECT_LE(fs::file_size(workshop.result("a.vcd")), 1000000u);
    EXPECT_GT(fs::file_size(workshop.result("a.vcd")), 300000u);
}

TEST(Probe, AWindowBehindTheEndMakesADumpWithoutValuesAndAWarning) {
    const Workshop workshop;
    const Finished finished = workshop.render(own_scene("cornell.nff"),
                                              {"--cells", "8x8", "--probe", "1,1", "--window", "999999999:"});
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(contains(finished.err, "before --window begins")) << finished.err;
    for (const auto& [path, changes] : read_dump(workshop).changes) EXPECT_TRUE(changes.empty()) << path;
}

TEST(Probe, OfADeadlockShowsSomeCellsAndTheCyclesBeforeIt) {
    const Workshop workshop;
    const Words words = {"--cells", "24x24", "--buffer", "1", "--networks", "shared"};
    const Json plain = workshop.report(own_scene("facing_mirrors.nff"), words, 3);
    const Json dumped = workshop.report(own_scene("facing_mirrors.nff"),
                                        joined(words, {"--vcd-on-deadlock", "--vcd-last", "700"}), 3);
    EXPECT_EQ(schedule(dumped), schedule(plain));
    EXPECT_EQ(workshop.usual_results(), (std::vector<std::string>{"a.cells.csv", "a.exr", "a.gtkw", "a.json",
                                                                  "a.png", "a.toml", "a.vcd"}));
    const vcd::Dump dump = read_dump(workshop);
    const auto cells = cells_of(dump);
    EXPECT_GE(cells.size(), 2u);
    EXPECT_LT(cells.size(), 24u * 24u);
    // Every cell shown holds something at the end.
    std::set<std::string> holding;
    for (const auto& [path, changes] : dump.changes) {
        const auto at = path.find(".occupancy");
        if (at == std::string::npos || changes.back().value == "0") continue;
        holding.insert(path.substr(8, path.find('.', 8) - 8));
    }
    EXPECT_EQ(holding, cells);
    const std::uint64_t end = dump.stamps.back() - 1;
    EXPECT_GT(dump.stamps.front(), 0u);
    EXPECT_LE(end - dump.stamps.front(), dumped.at("cycles").at("trace").get<std::uint64_t>() + 700);
    EXPECT_GE(end - dump.stamps.front(), 700u);
    EXPECT_EQ(dump.of("raycell.phase").back().value, "trace");
}

TEST(Probe, OfADeadlockThatDoesNotComeMakesNoDump) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8", "--vcd-on-deadlock"});
    EXPECT_FALSE(fs::exists(workshop.result("a.vcd")));
}

TEST(Probe, AConfigurationRepeatsAProbedRun) {
    const Workshop workshop;
    const Words words = {"--cells", "8x8", "--probe", "2..3,4", "--window", "100:2000"};
    workshop.report(own_scene("cornell.nff"), words);
    const std::string first = read_text(workshop.result("a.vcd"));
    const Finished again = workshop.run(
        {"render", "--config", workshop.result("a.toml").string(), "-o", workshop.result("b").string()});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_text(workshop.result("b.vcd")), first);
}

}  // namespace
}  // namespace raycell::system_test
