// --preset: machines as files, and what has precedence over them.
#include <algorithm>
#include <set>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

fs::path preset_folder() { return fs::path(RAYCELL_SOURCE_DIR) / "presets"; }

std::vector<std::string> presets() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(preset_folder())) names.push_back(entry.path().stem());
    return names;
}

/// Keys and values of a configuration file as they stand there, comments left out.
std::map<std::string, std::string> entries_of(const std::string& toml) {
    std::map<std::string, std::string> entries;
    std::istringstream stream(toml);
    for (std::string line; std::getline(stream, line);) {
        const auto equals = line.find(" = ");
        if (line.empty() || line[0] == '#' || equals == std::string::npos) continue;
        std::string value = line.substr(equals + 3);
        value = value.substr(0, value.find(" #"));
        value.resize(value.find_last_not_of(' ') + 1);
        entries[line.substr(0, equals)] = value;
    }
    return entries;
}

/// Options of a run, not of a machine or its picture: no preset has them.
const std::set<std::string> of_a_run = {
    "scene",         "view",      "frames",   "frame",     "output",      "quiet",           "sources",
    "truth-samples", "stage",     "engine",   "detail",    "granularity", "wire-check",      "truth",
    "clip-truth",    "watch-ray", "film",     "rays",      "watch-pixel", "vcd-on-deadlock", "probe",
    "window",        "vcd-last",  "vcd-mark", "vcd-limit", "golden",      "golden-part",     "save-array",
    "load-array",    "cost"};  // the datapath's

TEST(Preset, DefaultIsTheDefaultOfEveryOptionOfAMachine) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8"});
    const auto effective = entries_of(read_text(workshop.result("a.toml")));
    auto preset = entries_of(read_text(preset_folder() / "default.toml"));
    EXPECT_TRUE(contains(workshop.run({"render", "--help"}).out, "--cells WxH=128x128"));
    EXPECT_EQ(preset["cells"], "\"128x128\"");
    preset["cells"] = "\"8x8\"";
    for (const auto& [key, value] : effective) {
        if (of_a_run.count(key) > 0) {
            EXPECT_EQ(preset.count(key), 0U) << key;
        } else {
            EXPECT_EQ(preset.count(key), 1U) << key << " is an option, but not in default.toml";
            EXPECT_EQ(preset[key], value) << key;
        }
    }
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8", "--preset", "default", "-o", "results/a"},
                    0);
    EXPECT_EQ(entries_of(read_text(workshop.result("a.toml"))), effective);
}

TEST(Preset, PaperIsTheMachineThatThePaperDescribes) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("cornell.nff"), {"--cells", "16x16", "--preset", "paper"});
    const Json& config = report["config"];
    const std::map<std::string, std::string> words = {
        {"hit", "depth"},        {"normals", "voxel"},     {"shadows", "precast"}, {"networks", "shared"},
        {"arithmetic", "fixed"}, {"recovery", "postpone"}, {"exterior", "host"},   {"datapath", "word"}};
    for (const auto& [key, value] : words) EXPECT_EQ(config[key], value) << key;
    EXPECT_EQ(config["buffer"], 1);
    EXPECT_EQ(config["word-bits"], 20);
    EXPECT_EQ(config["feed-lanes"], 1);
    EXPECT_EQ(config["feed-bits"], config["link-bits"]);
    // Its spans are X1, Xr, Z, DZ, N, DN: no edges.
    const Json other = workshop.report(own_scene("cornell.nff"), {"--cells", "16x16"}, 0, "b");
    EXPECT_LT(report["message_bits"]["span"], other["message_bits"]["span"]);
}

TEST(Preset, ThePrototypeHoldsSixteenVoxelsInEachOfItsCells) {
    const Workshop workshop;
    // At its own rung no cell needs so many; at `edge` some need more.
    const Json report = workshop.report(own_scene("still_life.nff"),
                                        {"--preset", "prototype", "--hit", "edge", "--stage", "load"}, 4);
    EXPECT_EQ(report["pixels"]["all"], 1024 * 1024);
    EXPECT_GT(report["voxels_needed"], 16) << "how many voxels its fullest cell would have to hold";
    EXPECT_EQ(report["config"]["depth"], 1024);
    EXPECT_EQ(report["voxels"]["max_per_cell"], 16);
    EXPECT_EQ(report["verdict"], "capacity");
}

TEST(Preset, TheConfigurationOfARunRepeatsItWithoutThePreset) {
    const Workshop workshop;
    const Words words = {"--preset", "paper", "--cells", "16x16", "--max-depth", "2"};
    const Json first = workshop.report(own_scene("cornell.nff"), words);
    EXPECT_FALSE(contains(read_text(workshop.result("a.toml")), "preset"));
    const Finished again = workshop.run({"render", "--config", "results/a.toml", "-o", "results/b"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const Json second = Json::parse(read_text(workshop.result("b.json")));
    EXPECT_EQ(second["hash"], first["hash"]);
    EXPECT_EQ(second["cycles"], first["cycles"]);
}

TEST(Preset, GoesBeforeTheConfigurationFileAndThatBeforeTheCommandLine) {
    const Workshop workshop;
    workshop.write("mine.toml", "hit = \"mask\"\nword-bits = 14\n");
    for (const Words& order : {Words{"--preset", "paper", "--config", "mine.toml", "--word-bits", "16"},
                               Words{"--word-bits=16", "--config=mine.toml", "--preset=paper"}}) {
        const Json report = workshop.report(own_scene("cornell.nff"), joined({"--cells", "8x8"}, order));
        EXPECT_EQ(report["config"]["normals"], "voxel") << "of the preset";
        EXPECT_EQ(report["config"]["hit"], "mask") << "of the file";
        EXPECT_EQ(report["config"]["word-bits"], 16) << "of the command line";
    }
}

TEST(Preset, IsRefusedWithWhatWasAllowed) {
    const Workshop workshop;
    const auto refused = [&](const Words& words, const std::string& part) {
        const Finished finished = workshop.render(own_scene("cornell.nff"), words);
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_EQ(finished.error_lines(), 1U) << finished.err;
        EXPECT_TRUE(contains(finished.err, part)) << finished.err;
    };
    refused({"--preset", "nothing"}, "expected one of default|paper|prototype, not 'nothing'");
    refused({"--preset", "presets/paper.toml"}, "--config takes any file");
    refused({"--preset", ""}, "expected one of default|paper|prototype");
    refused({"--preset"}, "--preset: expected a name");
    workshop.write("mine.toml", "preset = \"paper\"\n");
    refused({"--config", "mine.toml"}, "mine.toml:1: unknown key 'preset'");
    EXPECT_EQ(workshop.results(), std::vector<std::string>());
}

TEST(Preset, EveryOneIsTakenByEveryProgramThatHasTheOption) {
    const Workshop workshop;
    const std::string scene = own_scene("cornell.nff").string();
    ASSERT_EQ(presets().size(), 3U);
    for (const std::string& name : presets()) {
        const Words words = {"--preset", name,      "--cells", "6x6",      "--pixels",
                             "cells",    "--quiet", "-o",      "results/a"};
        const auto ends = [&](const Finished& finished) {
            EXPECT_TRUE(finished.exit_code == 0 || finished.exit_code == 3) << name << ": " << finished.err;
        };
        ends(workshop.run(joined({"render", scene}, words)));
        ends(workshop.run(joined({"truth", scene}, words)));
        ends(workshop.run(joined({"size", scene, "--psnr", "1"}, words)));
        ends(workshop.run_program(RAYCELL_LOADING_TB, joined({scene}, words)));
        ends(workshop.run_program(RAYCELL_DEADLOCK_TB, words));
    }
}

TEST(Preset, CanBeSwept) {
    const Workshop workshop;
    const Finished finished = workshop.run({"sweep", own_scene("cornell.nff").string(), "--cells", "8x8",
                                            "--preset", "default,paper", "-o", "results/s", "--quiet"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    const std::string table = read_text(workshop.result("s.csv"));
    EXPECT_TRUE(contains(table, "\ndefault,") && contains(table, "\npaper,")) << table;
}

}  // namespace
}  // namespace raycell::system_test
