// raycell sweep, end to end: designs, runs, resumption, tables.
#include <algorithm>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

Words synthetic(const Words& more) {
    return joined({"sweep", "--synthetic", "--cells", "8x8", "--buffer", "1", "-o", "results/s", "--quiet"},
                  more);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> files_of_runs(const Workshop& workshop) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(workshop.result("s.runs")))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

TEST(Sweep, RunsEveryCombinationAndTellsThemApart) {
    const Workshop workshop;
    const Finished finished =
        workshop.run(synthetic({"--ray-store", "1..3", "--networks", "half,shared", "--seeds", "2"}));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const auto rows = lines_of(read_text(workshop.result("s.csv")));
    ASSERT_EQ(rows.size(), 1u + 3 * 2 * 2);
    EXPECT_EQ(rows[0].rfind("ray-store,networks,seed,verdict,", 0), 0u) << rows[0];
    EXPECT_EQ(rows[1].rfind("1,half,1,", 0), 0u) << rows[1];
    EXPECT_EQ(files_of_runs(workshop).size(), 2u * 12) << "a report and a configuration each";
    const std::string table = read_text(workshop.result("s.md"));
    for (const char* part : {"| 3 | shared | 1 deadlock, 1 completed | no |", "smallest M that ended",
                             "certain to end", "| 3 | half | completed | yes |", "| shared | none | | | | |"}) {
        EXPECT_TRUE(contains(table, part)) << part << '\n' << table;
    }
    const std::string chart = read_text(workshop.result("s.svg"));
    for (const char* part : {"<svg ", "runs that completed, %", "--ray-store (M)", "networks half", "</svg>"})
        EXPECT_TRUE(contains(chart, part)) << part;
}

TEST(Sweep, HasOfEachRunWhatThatRunAloneTells) {
    const Workshop workshop;
    EXPECT_EQ(workshop.run(synthetic({"--ray-store", "2,4", "--recovery", "none"})).exit_code, 0);
    const auto rows = lines_of(read_text(workshop.result("s.csv")));
    ASSERT_EQ(rows.size(), 3u);
    for (const std::string m : {"2", "4"}) {
        const Finished alone =
            workshop.run_program(RAYCELL_DEADLOCK_TB, {"--cells", "8x8", "--buffer", "1", "--ray-store", m,
                                                       "--recovery", "none", "--quiet", "-o", "alone"});
        EXPECT_TRUE(alone.exit_code == 0 || alone.exit_code == 3) << alone.err;
        const Json report = Json::parse(read_text(workshop.path() / "alone.json"));
        const std::string& row = rows[m == "2" ? 1 : 2];
        EXPECT_TRUE(contains(row, report.at("verdict").get<std::string>())) << row;
        EXPECT_TRUE(contains(row, report.at("hash").at("schedule").get<std::string>())) << row;
        EXPECT_TRUE(contains(row, "," + report.at("cycles").at("trace").dump() + ",")) << row;
    }
}

TEST(Sweep, SweepsASceneToo) {
    const Workshop workshop;
    const Finished finished = workshop.run({"sweep", own_scene("cornell.nff").string(), "--cells", "8x8",
                                            "--hit", "edge,depth", "--truth", "-o", "results/s"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(contains(finished.out, "| hit | verdict |")) << finished.out;
    EXPECT_TRUE(contains(finished.out, "| dB |")) << finished.out;
    EXPECT_EQ(lines_of(read_text(workshop.result("s.csv"))).size(), 3u);
}

TEST(Sweep, MakesOnlyTheRunsThatAreNotThere) {
    const Workshop workshop;
    const Words words = synthetic({"--ray-store", "1..3"});
    EXPECT_EQ(workshop.run(words).exit_code, 0);
    const std::string csv = read_text(workshop.result("s.csv"));
    const auto files = files_of_runs(workshop);
    ASSERT_EQ(files.size(), 6u);
    const auto written = [&](std::size_t i) {
        return fs::last_write_time(workshop.result("s.runs") / files[i]);
    };
    const auto first = written(0);
    const auto last = written(5);
    fs::remove(workshop.result("s.runs") / files[0]);
    EXPECT_EQ(workshop.run(words).exit_code, 0);
    EXPECT_EQ(files_of_runs(workshop), files);
    EXPECT_NE(written(0), first);
    EXPECT_EQ(written(5), last);
    EXPECT_EQ(read_text(workshop.result("s.csv")), csv);
}

TEST(Sweep, MakesARunAgainWhoseSceneHasChanged) {
    const Workshop workshop;
    const std::string scene = read_text(own_scene("cornell.nff"));
    workshop.write("mine.nff", scene);
    const Words words = {"sweep", "mine.nff", "--cells", "4x4", "-o", "results/s", "--quiet"};
    EXPECT_EQ(workshop.run(words).exit_code, 0);
    EXPECT_EQ(workshop.run(words).exit_code, 0);
    EXPECT_EQ(files_of_runs(workshop).size(), 2u) << "one run";
    workshop.write("mine.nff", scene + "# another\n");
    EXPECT_EQ(workshop.run(words).exit_code, 0);
    EXPECT_EQ(files_of_runs(workshop).size(), 4u) << "and one of the changed scene";
}

TEST(Sweep, TakesNumbersFromAFileToTheirLastDigit) {
    const Workshop workshop;
    workshop.write("s.toml", "synthetic = true\ncells = \"4x4\"\nhit-probability = 0.123456789012\n");
    const Finished finished = workshop.run({"sweep", "--config", "s.toml", "--dry-run"});
    EXPECT_TRUE(contains(finished.out, "--hit-probability=0.123456789012")) << finished.out << finished.err;
}

TEST(Sweep, IsRepeatedFromTheConfigurationThatItWrote) {
    const Workshop workshop;
    EXPECT_EQ(
        workshop.run(synthetic({"--ray-store", "1,2", "--branching", "0.9,0.4", "--seed", "7"})).exit_code,
        0);
    const Finished again =
        workshop.run({"sweep", "--config", "results/s.toml", "-o", "results/t", "--quiet"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_text(workshop.result("t.csv")), read_text(workshop.result("s.csv")));
    EXPECT_EQ(read_text(workshop.result("t.toml")), read_text(workshop.result("s.toml")));
}

TEST(Sweep, TakesTheConfigurationOfARun) {
    const Workshop workshop;
    EXPECT_EQ(
        workshop.render(own_scene("cornell.nff"), {"--cells", "8x8", "--cost", "walk_step=9"}).exit_code, 0);
    const Finished finished = workshop.run(
        {"sweep", "--config", "results/a.toml", "--ray-store", "8,9", "-o", "results/s", "--quiet"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(lines_of(read_text(workshop.result("s.csv"))).size(), 3u);
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_TRUE(
        contains(read_text(workshop.result("s.csv")), report.at("hash").at("schedule").get<std::string>()))
        << "M is 8 by default";
}

TEST(Sweep, WithDryRunSaysWhatItWouldRunAndWritesNothing) {
    const Workshop workshop;
    const Finished finished = workshop.run(synthetic({"--ray-store", "1..2", "--dry-run"}));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const auto lines = lines_of(finished.out);
    ASSERT_EQ(lines.size(), 3u) << finished.out;
    EXPECT_TRUE(contains(lines[0], "to do") && contains(lines[0], "--ray-store=1")) << lines[0];
    EXPECT_EQ(lines[2], "2 runs, 0 done");
    EXPECT_TRUE(workshop.results().empty());
}

TEST(Sweep, RefusesWhatNoRunWouldTake) {
    const Workshop workshop;
    const std::vector<std::pair<Words, std::string>> cases = {
        {synthetic({"--ray-stor", "1..3"}), "perhaps --ray-store"},
        {synthetic({"--ray-store", "0..3"}), "expected a number from 1 to 1024, not '0'"},
        {synthetic({"--networks", "half,whole"}), "not 'whole'"},
        {synthetic({"--save-array", "x"}), "can't be swept"},
        {synthetic({"scene.nff"}), "expected no scene"},
        {synthetic({"--ray-store"}), "expected a value"},
        {synthetic({"--ray-store", "1..1000", "--buffer", "1..1000"}), "expected fewer values"},
        {{"sweep", "-o", "results/s"}, "expected one or several, or --synthetic"},
        {{"sweep", "--config", "none.toml", "-o", "results/s"}, "none.toml"}};
    for (const auto& [words, part] : cases) {
        const Finished finished = workshop.run(words);
        EXPECT_EQ(finished.exit_code, 1) << part;
        EXPECT_TRUE(contains(finished.err, part)) << finished.err;
        EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
        EXPECT_TRUE(workshop.results().empty()) << part;
    }
}

TEST(Sweep, NamesTheRunThatFailedAndKeepsTheOthers) {
    const Workshop workshop;
    const Finished finished = workshop.run({"sweep", own_scene("cornell.nff").string(), "none.nff", "--cells",
                                            "4x4", "-j", "1", "-o", "results/s", "--quiet"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "a run ended without results") && contains(finished.err, "none.nff"))
        << finished.err;
    EXPECT_FALSE(fs::exists(workshop.result("s.csv")));
    EXPECT_EQ(files_of_runs(workshop).size(), 2u);
}

TEST(Sweep, ThatIsInterruptedGoesOnWhereItWas) {
    const Workshop workshop;
    const Words words = {"sweep", "--synthetic", "--cells", "48x48", "--ray-store",
                         "3..14", "-j",          "1",       "-o",    "results/s"};
    Running running(workshop, RAYCELL_PROGRAM, words);
    ASSERT_TRUE(running.says("1 of 12 runs"));
    running.send(SIGTERM);
    EXPECT_EQ(running.finish().exit_code, 5);
    EXPECT_FALSE(fs::exists(workshop.result("s.csv")));
    // Nothing is left of the run that was under way, not even its results as far as they had come.
    for (const std::string& name : files_of_runs(workshop)) {
        ASSERT_TRUE(contains(name, ".json") || contains(name, ".toml")) << name;
        if (contains(name, ".toml")) continue;
        EXPECT_NE(Json::parse(read_text(workshop.result("s.runs") / name)).at("verdict"), "interrupted");
    }
    const Finished finished = workshop.run(joined(words, {"--quiet"}));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const auto rows = lines_of(read_text(workshop.result("s.csv")));
    EXPECT_EQ(rows.size(), 13u);
    for (const std::string& row : rows) EXPECT_FALSE(contains(row, "interrupted")) << row;
}

}  // namespace
}  // namespace raycell::system_test
