// Loaded arrays: a run that starts with a saved one tells the same as the run that loaded it.
#include "program.hpp"

namespace raycell::system_test {
namespace {

/// A report without what may differ: wall times, the options themselves, loading's activity over time.
Json told(const Workshop& workshop, const std::string& name) {
    Json json = Json::parse(read_text(workshop.result(name + ".json")));
    json.erase("model");
    json.erase("config");
    json["activity"].erase("load");
    return json;
}

Finished render(const Workshop& workshop, const Words& words, const std::string& name) {
    return workshop.render(own_scene("still_life.nff"), joined({"--cells", "24x20"}, words), name);
}

class LoadedArray : public ::testing::TestWithParam<Words> {};

TEST_P(LoadedArray, GoesOnAsIfItHadJustBeenLoaded) {
    const Workshop workshop;
    const Words same = GetParam();
    ASSERT_EQ(render(workshop, joined(same, {"--save-array", "results/array"}), "saved").exit_code, 0);
    const Finished again = render(workshop, joined(same, {"--load-array", "results/array"}), "again");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(told(workshop, "again"), told(workshop, "saved"));
    EXPECT_EQ(read_text(workshop.result("again.cells.csv")), read_text(workshop.result("saved.cells.csv")));
    EXPECT_EQ(read_text(workshop.result("again.exr")), read_text(workshop.result("saved.exr")));
}

INSTANTIATE_TEST_SUITE_P(Machines, LoadedArray,
                         ::testing::Values(Words{}, Words{"--shadows", "precast", "--hit", "mask"},
                                           Words{"--arithmetic", "exact", "--granularity", "cell"},
                                           Words{"--shadows", "memo", "--display", "gouraud", "--word-bits",
                                                 "27"},
                                           Words{"--stage", "load"}));

TEST(LoadedArrayFile, ServesAnotherTraceOfTheSameScene) {
    const Workshop workshop;
    ASSERT_EQ(render(workshop, {"--save-array", "results/array"}, "saved").exit_code, 0);
    const Words other{"--ray-store", "4", "--networks", "quadrant", "--max-depth", "2"};
    ASSERT_EQ(render(workshop, joined(other, {"--load-array", "results/array"}), "loaded").exit_code, 0);
    ASSERT_EQ(render(workshop, other, "whole").exit_code, 0);
    EXPECT_EQ(image(told(workshop, "loaded")), image(told(workshop, "whole")));
    EXPECT_EQ(schedule(told(workshop, "loaded")), schedule(told(workshop, "whole")));
}

TEST(LoadedArrayFile, OfSomethingElseIsRefused) {
    const Workshop workshop;
    ASSERT_EQ(render(workshop, {"--save-array", "results/array"}, "saved").exit_code, 0);
    const Words load{"--load-array", "results/array"};
    for (const Words& other : {Words{"--cells", "20x24"}, Words{"--hit", "mask"}, Words{"--word-bits", "19"},
                               Words{"--link-bits", "40"}, Words{"--stall", "0.1"},
                               Words{"--engine", "untimed"}, Words{"--golden", "0,0"}}) {
        const Finished finished = render(workshop, joined(load, other), "b");
        EXPECT_EQ(finished.exit_code, 1) << other.front();
        EXPECT_TRUE(contains(finished.err, "--load-array")) << finished.err;
        EXPECT_EQ(finished.error_lines(), 1u);
    }
    std::string damaged = read_text(workshop.result("array"));
    damaged[damaged.size() / 2] = char(damaged[damaged.size() / 2] ^ 4);
    const fs::path file = workshop.write("damaged", damaged);
    EXPECT_EQ(render(workshop, {"--load-array", file.string()}, "b").exit_code, 1);
    EXPECT_EQ(render(workshop, {"--load-array", "nowhere"}, "b").exit_code, 1);
    EXPECT_FALSE(fs::exists(workshop.result("b.json")));
}

TEST(LoadedArrayFile, IsNotLeftHalfWritten) {
    const Workshop workshop;
    const Finished finished = render(workshop, {"--save-array", "results/nowhere/array"}, "a");
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(workshop.results().empty());
    EXPECT_EQ(render(workshop, {"--save-array", "results/array", "--max-cycles", "100"}, "a").exit_code, 4);
    EXPECT_FALSE(fs::exists(workshop.result("array"))) << "nothing was loaded";
}

}  // namespace
}  // namespace raycell::system_test
