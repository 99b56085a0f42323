// A run can be repeated from the configuration that it wrote, bit for bit.
#include <algorithm>
#include <map>
#include <set>

#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Names of the long options in `raycell render --help`, without --help and --config.
std::set<std::string> options_in_help() {
    const Workshop workshop;
    std::istringstream help(workshop.run({"render", "--help"}).out);
    std::set<std::string> names;
    std::string line;
    while (std::getline(help, line)) {
        if (line.rfind("  -", 0) != 0) continue;
        const std::size_t at = line.find("--");
        const std::size_t end = line.find_first_of(" :=,", at);
        names.insert(line.substr(at + 2, end - at - 2));
    }
    names.erase("help");
    names.erase("config");
    names.erase("preset");
    return names;
}

/// Keys of a configuration file as the program writes it, one per line.
std::set<std::string> keys_of(const std::string& toml) {
    std::istringstream lines(toml);
    std::set<std::string> keys;
    std::string line;
    while (std::getline(lines, line)) keys.insert(line.substr(0, line.find(" = ")));
    return keys;
}

Json without_model(const fs::path& report) {
    Json json = Json::parse(read_text(report));
    json.erase("model");
    return json;
}

TEST(Reproduction, TheConfigurationHoldsEveryOption) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("cornell.nff"), {"--cells", "4x4"});
    std::set<std::string> options = options_in_help();
    options.erase("jobs");       // frames at a time, on which no result depends
    options.erase("rank-rows");  // results depend neither on it nor on the number of ranks, which mpirun sets
    EXPECT_GE(options.size(), 30u);
    EXPECT_EQ(keys_of(read_text(workshop.result("a.toml"))), options);
    std::set<std::string> in_report;
    for (const auto& entry : report.at("config").items()) in_report.insert(entry.key());
    EXPECT_EQ(in_report, options);
}

TEST(Reproduction, ATracedRunFromItsConfigurationIsTheSameRun) {
    const Workshop workshop;
    const std::string view = workshop
                                 .write("view.nff",
                                        "b 0.1 0.2 0.3\nv\nfrom 1 3.5 9\nat 0 0.8 0\nup 0.1 1 0\nangle 33\n"
                                        "hither 0.1\nresolution 64 64\nl -5 8 6\nl 4 4 4 0.5 0.4 0.3\n")
                                 .string();
    const std::string sources =
        workshop
            .write(
                "lamp.toml",
                "add = true\n[[source]]\nkind = 'sphere'\ncentre = [3, 5, 2]\nradius = 0.7\n"
                "[[source]]\nkind = 'directional'\ndirection = [0.3, -1, -0.4]\ncolour = [0.1, 0.2, 0.3]\n")
            .string();
    const std::vector<Words> runs = {
        {},
        {"--hit", "mask", "--shadows", "memo", "--exterior", "none", "--ray-store", "5", "--buffer", "3"},
        {"--arithmetic", "exact", "--normal-offset", "-1"},
        {"--normal-offset", "-1", "--word-bits", "9"},
        // No option at its default, and numbers that need all their digits.
        {"--view",
         view,
         "--sources",
         sources,
         "--source-samples",
         "3",
         "--samples",
         "5",
         "--filter",
         "tent",
         "--sample-until",
         "0.0123456789012345",
         "--viewer",
         "infinity",
         "--chord-error",
         "0.1234567890123",
         "--tessellate-for",
         "30.12345678901",
         "--max-depth",
         "3",
         "--min-weight",
         "0.0123456789012345",
         "--depth",
         "777",
         "--hit",
         "plane",
         "--normals",
         "voxel",
         "--shadows",
         "precast",
         "--exterior",
         "none",
         "--word-bits",
         "17",
         "--rounding",
         "truncate",
         "--reciprocal",
         "table",
         "--root",
         "rounded",
         "--power",
         "schlick",
         "--reciprocal-table",
         "128",
         "--root-table",
         "16",
         "--power-table",
         "4096",
         "--ray-store",
         "9",
         "--buffer",
         "2",
         "--networks",
         "quadrant",
         "--slots",
         "free",
         "--link-bits",
         "33",
         "--clock-mhz",
         "33.333333333333336",
         "--max-cycles",
         "99999999",
         "--voxel-capacity",
         "999",
         "--normal-offset",
         "1.2345678901234567e-05",
         "--exterior-processors",
         "3",
         "--exterior-latency",
         "77",
         "--seed",
         "9223372036854775807",
         "--cost",
         "walk_step=5",
         "--cost",
         "backoff=99",
         "--truth",
         "--clip-truth"},
    };
    for (const Words& words : runs) {
        const Json first = workshop.report(own_scene("still_life.nff"), joined({"--cells", "24x16"}, words));
        const Finished finished = workshop.run({"render", "--config", "results/a.toml", "-o", "results/b"});
        ASSERT_EQ(finished.exit_code, 0) << finished.err;
        const Json second = Json::parse(read_text(workshop.result("b.json")));
        EXPECT_EQ(image(second), image(first));
        EXPECT_EQ(schedule(second), schedule(first));
        Json first_config = first.at("config");
        Json second_config = second.at("config");
        first_config.erase("output");
        second_config.erase("output");
        EXPECT_EQ(second_config, first_config);
        EXPECT_EQ(read_text(workshop.result("b.exr")), read_text(workshop.result("a.exr")));
    }
}

TEST(Reproduction, ALoadedPictureFromItsConfigurationIsTheSamePicture) {
    const Workshop workshop;
    const Json first = workshop.report(own_scene("still_life.nff"),
                                       {"--cells", "24x16", "--stage", "load", "--display", "gouraud"});
    ASSERT_EQ(workshop.run({"render", "--config", "results/a.toml", "-o", "results/b"}).exit_code, 0);
    EXPECT_EQ(image(Json::parse(read_text(workshop.result("b.json")))), image(first));
}

TEST(Reproduction, ATruthFromItsConfigurationIsTheSamePicture) {
    const Workshop workshop;
    const Finished first = workshop.run({"truth", own_scene("cornell.nff").string(), "--cells", "24x16",
                                         "--clip", "-o", "results/a", "--quiet"});
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const Finished second = workshop.run({"truth", "--config", "results/a.toml", "-o", "results/b"});
    ASSERT_EQ(second.exit_code, 0) << second.err;
    EXPECT_EQ(read_text(workshop.result("b.exr")), read_text(workshop.result("a.exr")));
}

TEST(Reproduction, NamesWithSpecialCharactersSurviveTheConfiguration) {
    const Workshop workshop;
    const std::string text = read_text(own_scene("cornell.nff"));
    for (const std::string name :
         {"a b.nff", "it's.nff", "a=b.nff", "a,b.nff", "[x].nff", "{y}.nff", "\xc3\xa9.nff", "%s.nff",
          "a#b.nff", "q\"uote.nff", "back\\slash.nff", "ta\tb.nff"}) {
        SCOPED_TRACE(name);
        workshop.write(name, text);
        ASSERT_EQ(workshop.render(name, {"--cells", "4x4"}).exit_code, 0);
        const Finished again = workshop.run({"render", "--config", "results/a.toml", "-o", "results/b"});
        EXPECT_EQ(again.exit_code, 0) << again.err;
    }
}

void expect_the_same_files_twice(const fs::path& scene, const Words& words) {
    const Workshop workshop;
    const auto run = [&] {
        const Finished finished = workshop.render(scene, words);
        ASSERT_EQ(finished.exit_code, 0) << finished.err;
    };
    run();
    const std::vector<std::string> names = workshop.results();
    std::map<std::string, std::string> first;
    for (const std::string& name : names) first[name] = read_text(workshop.result(name));
    const Json report = without_model(workshop.result("a.json"));
    run();
    EXPECT_EQ(workshop.results(), names);
    for (const std::string& name : names) {
        if (name == "a.json") continue;
        EXPECT_TRUE(read_text(workshop.result(name)) == first[name]) << name << " differs";
    }
    EXPECT_EQ(without_model(workshop.result("a.json")), report);
}

TEST(Reproduction, TheSameCommandTwiceWritesTheSameBytes) {
    expect_the_same_files_twice(own_scene("still_life.nff"), {"--cells", "32x32"});
    expect_the_same_files_twice(own_scene("still_life.nff"), {"--cells", "32x32", "--engine", "untimed"});
    expect_the_same_files_twice(own_scene("facing_mirrors.nff"),
                                {"--cells", "24x32", "--shadows", "precast", "--ray-store", "5", "--truth"});
    expect_the_same_files_twice(own_scene("cornell.nff"), {"--cells", "32x32", "--stage", "load"});
}

TEST(Reproduction, ARunWritesTheFilesThatItPromisesAndNoOthers) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "4x4"});
    EXPECT_EQ(workshop.results(),
              (std::vector<std::string>{"a.cells.csv", "a.exr", "a.json", "a.png", "a.toml"}));
}

// ---- the command line has precedence

TEST(Precedence, TheCommandLineOverridesTheConfigurationInEveryKindOfOption) {
    const Workshop workshop;
    workshop.write("run.toml",
                   "# a comment\nscene = \"" + own_scene("cornell.nff").string() +
                       "\"\ncells = \"4x4\"\noutput = \"results/from-file\"\nquiet = true\ndepth = 77\n"
                       "min-weight = 0.25\nhit = \"plane\"\ntruth = true\nbuffer = 3 # another\n"
                       "cost = [\"walk_step=7\", \"reflect=9\"]\n");
    ASSERT_EQ(workshop.run({"render", "--config", "run.toml"}).exit_code, 0);
    const Json file = Json::parse(read_text(workshop.result("from-file.json"))).at("config");
    EXPECT_EQ(file.at("depth"), 77);
    EXPECT_EQ(file.at("hit"), "plane");
    EXPECT_EQ(file.at("buffer"), 3);
    EXPECT_EQ(file.at("truth"), true);
    EXPECT_EQ(file.at("cost").at(0), "walk_step=7");
    const Words line = {"--scene",
                        own_scene("still_life.nff").string(),
                        "--cells",
                        "6x5",
                        "-o",
                        "results/line",
                        "--depth",
                        "78",
                        "--hit",
                        "edge",
                        "--cost",
                        "walk_step=8",
                        "--truth=false",
                        "--min-weight=0.5"};
    // --config may stand anywhere.
    for (const Words& words : {joined({"render", "--config", "run.toml"}, line),
                               joined(joined({"render"}, line), {"--config=run.toml"})}) {
        const Finished finished = workshop.run(words);
        ASSERT_EQ(finished.exit_code, 0) << finished.err;
        const Json config = Json::parse(read_text(workshop.result("line.json"))).at("config");
        EXPECT_EQ(config.at("scene"), own_scene("still_life.nff").string());
        EXPECT_EQ(config.at("cells"), "6x5");
        EXPECT_EQ(config.at("depth"), 78);
        EXPECT_EQ(config.at("min-weight"), 0.5);
        EXPECT_EQ(config.at("hit"), "edge");
        EXPECT_EQ(config.at("truth"), false);
        EXPECT_EQ(config.at("buffer"), 3);
        EXPECT_EQ(config.at("cost").at(0), "walk_step=8");
        EXPECT_TRUE(contains(config.at("cost").dump(), "reflect=9")) << "other costs stay";
    }
}

TEST(Precedence, ASceneWithoutDashesOverridesTheConfigurationToo) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "4x4"});
    const std::string other = own_scene("still_life.nff").string();
    for (const Words& words : {Words{"render", other, "--config", "results/a.toml", "-o", "results/b"},
                               Words{"render", "--config", "results/a.toml", other, "-o", "results/b"}}) {
        const Finished finished = workshop.run(words);
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        if (finished.exit_code != 0) continue;
        EXPECT_EQ(Json::parse(read_text(workshop.result("b.json"))).at("config").at("scene"), other);
    }
}

TEST(Precedence, ASceneAfterACostIsStillTheScene) {
    const Workshop workshop;
    const Finished finished = workshop.run({"render", "--cells", "4x4", "-o", "results/a", "--cost",
                                            "walk_step=5", own_scene("cornell.nff").string()});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
}

}  // namespace
}  // namespace raycell::system_test
