// Loaded arrays: a run that starts from a saved array reports the same as the run that saved it.
#include "program.hpp"

namespace raycell::system_test {
namespace {

/// A report without the parts that may differ: wall times, the options, and, if `as_if_loaded`, the source of
/// the loading and its activity over time.
Json told(const Workshop& workshop, const std::string& name, bool as_if_loaded = true) {
    Json json = Json::parse(read_text(workshop.result(name + ".json")));
    json.erase("model");
    json.erase("config");
    if (as_if_loaded) {
        EXPECT_EQ(json.at("activity").at("load").is_null(), json.at("loading") != "run");
        EXPECT_NE(json.at("loading"), "saved_other_timing");
        json.at("activity").erase("load");
        json.erase("loading");
    }
    return json;
}

Finished render(const Workshop& workshop, const Words& words, const std::string& name) {
    return workshop.render(own_scene("still_life.nff"), joined({"--cells", "24x20"}, words), name);
}

class LoadedArray : public ::testing::TestWithParam<Words> {};

TEST_P(LoadedArray, GoesOnAsIfItHadJustBeenLoaded) {
    const Workshop workshop;
    const Words same = GetParam();
    const Finished saved = render(workshop, joined(same, {"--save-array", "results/array"}), "saved");
    const bool all_fits = same.empty() || same.front() != "--voxel-capacity";
    ASSERT_EQ(saved.exit_code, all_fits ? 0 : 4) << saved.err;
    const Finished again = render(workshop, joined(same, {"--load-array", "results/array"}), "again");
    ASSERT_EQ(again.exit_code, saved.exit_code) << again.err;
    EXPECT_EQ(again.err, saved.err);
    EXPECT_EQ(Json::parse(read_text(workshop.result("again.json"))).at("loading"), "saved");
    EXPECT_EQ(told(workshop, "again"), told(workshop, "saved"));
    EXPECT_EQ(read_text(workshop.result("again.cells.csv")), read_text(workshop.result("saved.cells.csv")));
    EXPECT_EQ(read_text(workshop.result("again.exr")), read_text(workshop.result("saved.exr")));
}

INSTANTIATE_TEST_SUITE_P(
    Machines, LoadedArray,
    ::testing::Values(Words{}, Words{"--shadows", "precast", "--hit", "mask"},
                      Words{"--arithmetic", "exact", "--granularity", "cell"},
                      Words{"--shadows", "memo", "--display", "gouraud", "--word-bits", "27"},
                      Words{"--stage", "load"}, Words{"--voxel-capacity", "2", "--exterior", "none"}));

/// Saves the array that `saving` loads, runs `other` with it, and expects the report of a whole run of
/// `other`.
void expect_other_trace(const Words& saving, const Words& other) {
    SCOPED_TRACE(other.front());
    const Workshop workshop;
    ASSERT_EQ(render(workshop, joined(saving, {"--save-array", "results/array"}), "saved").exit_code, 0);
    ASSERT_EQ(render(workshop, joined(other, {"--load-array", "results/array"}), "loaded").exit_code, 0);
    ASSERT_EQ(render(workshop, other, "whole").exit_code, 0);
    EXPECT_EQ(told(workshop, "loaded"), told(workshop, "whole"));
}

TEST(LoadedArrayFile, ServesAnotherTraceOfTheSameScene) {
    expect_other_trace({}, {"--ray-store", "4", "--networks", "quadrant", "--max-depth", "2"});
    expect_other_trace({"--max-depth", "0"}, {"--shadows", "precast", "--exterior", "none"});
    expect_other_trace({"--stage", "load"}, {"--granularity", "cell", "--seed", "9", "--slots", "free"});
    expect_other_trace({"--shadows", "memo"}, {"--stage", "load"});
}

TEST(LoadedArrayFile, OfOtherBuffersLinksOrCostsServesWithAWarning) {
    const Workshop workshop;
    ASSERT_EQ(render(workshop, {"--save-array", "results/array"}, "saved").exit_code, 0);
    const Json saved = told(workshop, "saved");
    for (const Words& other :
         {Words{"--buffer", "3"}, Words{"--link-bits", "40"}, Words{"--cost", "load_edge=90"}}) {
        SCOPED_TRACE(other.front());
        const Finished finished = render(workshop, joined(other, {"--load-array", "results/array"}), "b");
        ASSERT_EQ(finished.exit_code, 0);
        EXPECT_TRUE(contains(finished.err, "warning: it was loaded with other buffers")) << finished.err;
        ASSERT_EQ(render(workshop, other, "whole").exit_code, 0);
        const Json loaded = told(workshop, "b", false);
        const Json whole = told(workshop, "whole");
        EXPECT_EQ(loaded.at("loading"), "saved_other_timing");
        EXPECT_EQ(loaded.at("cycles").at("trace"), whole.at("cycles").at("trace"));
        EXPECT_EQ(loaded.at("messages"), whole.at("messages"));
        EXPECT_EQ(loaded.at("hops"), whole.at("hops"));
        EXPECT_EQ(image(loaded), image(whole));
        EXPECT_EQ(loaded.at("cycles").at("load"), saved.at("cycles").at("load"));
        EXPECT_NE(loaded.at("cycles").at("load"), whole.at("cycles").at("load"))
            << "the loading is that of the run that saved it";
    }
}

/// Expects one message that names the option, exit code 1, and no results but the array.
void expect_refused(const Workshop& workshop, const Words& words, const std::string& said) {
    SCOPED_TRACE(said);
    const Finished finished = render(workshop, words, "b");
    EXPECT_EQ(finished.exit_code, 1) << words.back();
    EXPECT_TRUE(contains(finished.err, "-array")) << finished.err;
    EXPECT_TRUE(contains(finished.err, said)) << finished.err;
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_EQ(workshop.results(), Words{"array"});
}

class LoadedArrayRefused : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(render(workshop, {"--save-array", "array"}, "saved").exit_code, 0);
        ASSERT_EQ(workshop
                      .run({"render", own_scene("still_life.nff").string(), "--cells", "24x20", "--quiet",
                            "-o", "saved", "--save-array", "results/array"})
                      .exit_code,
                  0);
        for (const std::string& name : workshop.results()) {
            if (name != "array") fs::remove(workshop.result(name));
        }
    }
    const Workshop workshop;
};

TEST_F(LoadedArrayRefused, WhereTheSceneTheViewOrTheSizeIsAnother) {
    const Words load{"--load-array", "results/array"};
    expect_refused(workshop, joined(load, {"--cells", "24x21"}), "holds 480 cells; expected 504");
    expect_refused(workshop, joined(load, {"--cells", "20x24"}), "is of another scene, view or size");
    expect_refused(workshop, joined(load, {"--viewer", "infinity"}), "is of another scene");
    expect_refused(workshop, joined(load, {"--view", own_scene("cornell.nff").string()}), "another scene");
    expect_refused(workshop, joined(load, {"--chord-error", "0.2"}), "is of another scene");
    std::string text = read_text(own_scene("still_life.nff"));
    const fs::path same = workshop.write("same.nff", text + "# nothing else\n");
    const Finished again = workshop.run(
        {"render", same.string(), "--cells", "24x20", "--quiet", "-o", "c", "--load-array", "results/array"});
    EXPECT_EQ(again.exit_code, 0) << again.err << "what counts is the scene, not its file";
}

TEST_F(LoadedArrayRefused, WhereVoxelsOrWordsAreOthers) {
    for (const Words& other :
         {Words{"--depth", "512"}, Words{"--hit", "mask"}, Words{"--hit", "depth"},
          Words{"--normals", "voxel"}, Words{"--arithmetic", "exact"}, Words{"--word-bits", "19"},
          Words{"--rounding", "truncate"}, Words{"--voxel-capacity", "30"}, Words{"--display", "gouraud"}})
        expect_refused(workshop, joined({"--load-array", "results/array"}, other),
                       "was loaded with other voxels or words");
}

TEST_F(LoadedArrayRefused, WhereTheRunCannotGoOnFromIt) {
    for (const Words& load :
         {Words{"--load-array", "results/array"}, Words{"--save-array", "results/other"}}) {
        expect_refused(workshop, joined(load, {"--stall", "0.1"}), "expected --stall 0");
        expect_refused(workshop, joined(load, {"--engine", "untimed"}), "expected --engine timed");
        expect_refused(workshop, joined(load, {"--golden", "0,0"}), "expected no --golden");
    }
    expect_refused(workshop, {"--load-array", "results/array", "--save-array", "results/other"},
                   "expected one of the two");
}

TEST_F(LoadedArrayRefused, WhereTheFileIsDamaged) {
    const std::string whole = read_text(workshop.result("array"));
    const auto file = [&](const std::string& bytes) {
        return Words{"--load-array", workshop.write("damaged", bytes).string()};
    };
    expect_refused(workshop, file(whole.substr(0, whole.size() - 1)), "is cut off");
    expect_refused(workshop, file(whole.substr(0, whole.size() / 2)), "is cut off");
    expect_refused(workshop, file(""), "is cut off");
    expect_refused(workshop, file("no array at all"), "is no loaded array");
    expect_refused(workshop, file(whole + "x"), "is longer");
    for (const std::size_t at : {whole.size() / 3, whole.size() / 2, whole.size() - 9, whole.size() - 1}) {
        std::string damaged = whole;
        damaged[at] = char(damaged[at] ^ 4);
        expect_refused(workshop, file(damaged), "damaged");
    }
    expect_refused(workshop, {"--load-array", "nowhere"}, "no such file");
}

TEST(LoadedArrayFile, IsNotLeftHalfWritten) {
    const Workshop workshop;
    const Finished finished = render(workshop, {"--save-array", "stdout.txt/array"}, "a");
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "in a folder that can be written to")) << finished.err;
    EXPECT_TRUE(workshop.results().empty());
    EXPECT_EQ(render(workshop, {"--save-array", "results/array", "--max-cycles", "100"}, "a").exit_code, 4);
    EXPECT_FALSE(fs::exists(workshop.result("array"))) << "nothing was loaded";
    for (const std::string& name : workshop.results()) EXPECT_FALSE(contains(name, ".part")) << name;
}

TEST(LoadedArrayFile, OfALockedRunServesItsSecondRun) {
    const Workshop workshop;
    const Words words{"--cells",           "32x32",        "--buffer",     "1", "--networks", "split",
                      "--vcd-on-deadlock", "--save-array", "results/array"};
    const Finished finished = workshop.render(own_scene("facing_mirrors.nff"), words, "a");
    ASSERT_EQ(finished.exit_code, 3) << finished.err;
    EXPECT_TRUE(fs::exists(workshop.result("a.vcd")));
    const Finished again = workshop.render(own_scene("facing_mirrors.nff"),
                                           {"--cells", "32x32", "--buffer", "1", "--networks", "split",
                                            "--vcd-on-deadlock", "--load-array", "results/array"},
                                           "b");
    ASSERT_EQ(again.exit_code, 3) << again.err;
    EXPECT_EQ(told(workshop, "b"), told(workshop, "a"));
    EXPECT_EQ(read_text(workshop.result("b.vcd")), read_text(workshop.result("a.vcd")));
}

TEST(LoadedArrayFile, OfALongerLoadingThanTheLimitEndsAtTheLimit) {
    const Workshop workshop;
    ASSERT_EQ(render(workshop, {"--save-array", "results/array"}, "saved").exit_code, 0);
    const Finished finished = render(workshop, {"--load-array", "results/array", "--max-cycles", "100"}, "b");
    EXPECT_EQ(finished.exit_code, 4);
    EXPECT_EQ(told(workshop, "b", false).at("verdict"), "cycle_limit");
}

}  // namespace
}  // namespace raycell::system_test
