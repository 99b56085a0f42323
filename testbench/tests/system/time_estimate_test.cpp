// Estimates before a run starts: hops close to the real ones, and a message if the run will be long.
#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Expects estimated and real hops to differ by at most a factor of `most`.
void expect_foretold(const Json& report, double most) {
    const Json& expected = report.at("model").at("expected");
    const Json& foretold = expected.at("hops");
    const double load = report.at("hops").at("load");
    const double rays =
        report.at("hops").at("ray").get<double>() + report.at("hops").at("return").get<double>();
    const auto expect_near = [&](double said, double made, const char* what) {
        EXPECT_LT(said, most * made) << what;
        EXPECT_GT(said, made / most) << what;
    };
    expect_near(foretold.at("load"), load, "load");
    expect_near(foretold.at("precast").get<double>() + foretold.at("trace").get<double>(), rays, "rays");
    expect_near(expected.at("voxels"), report.at("voxels").at("stored"), "voxels");
    for (const auto& [phase, seconds] : expected.at("seconds").items()) {
        const bool there = phase != "precast" || report.at("rays").at("precast") > 0;
        EXPECT_EQ(seconds > 0, there) << phase;
    }
}

// ---- hops

class ForetoldOwnScene : public ::testing::TestWithParam<Words> {};

TEST_P(ForetoldOwnScene, MakesAboutSoManyHops) {
    const Workshop workshop;
    for (const char* scene : {"still_life.nff", "cornell.nff"}) {
        SCOPED_TRACE(scene);
        expect_foretold(workshop.report(own_scene(scene), joined({"--cells", "40x56"}, GetParam())), 1.5);
    }
}

INSTANTIATE_TEST_SUITE_P(With, ForetoldOwnScene,
                         ::testing::Values(Words{}, Words{"--shadows", "precast"}, Words{"--shadows", "memo"},
                                           Words{"--exterior", "none"}, Words{"--viewer", "infinity"},
                                           Words{"--max-depth", "0"}, Words{"--min-weight", "0.3"}));

struct SharedScene {
    const char* name;
    const char* cells;
};

class ForetoldSharedScene : public ::testing::TestWithParam<SharedScene> {};

TEST_P(ForetoldSharedScene, MakesAboutSoManyHops) {
    const fs::path scene = shared_scenes() / "spd" / (std::string(GetParam().name) + ".nff");
    if (!fs::exists(scene)) GTEST_SKIP() << scene << " is not here";
    const Workshop workshop;
    expect_foretold(workshop.report(scene, {"--cells", GetParam().cells}), 2);
}

INSTANTIATE_TEST_SUITE_P(Of, ForetoldSharedScene,
                         ::testing::Values(SharedScene{"balls-s1", "64x64"}, SharedScene{"balls-s3", "64x64"},
                                           SharedScene{"gears-s1", "64x64"}, SharedScene{"mount-s4", "64x64"},
                                           SharedScene{"rings-s1", "64x64"},
                                           SharedScene{"teapot-s2", "64x64"}, SharedScene{"tree-s7", "64x64"},
                                           SharedScene{"tetra-s4", "64x64"},
                                           SharedScene{"tetra-s4", "128x128"},
                                           SharedScene{"tetra-s6", "128x128"}),
                         [](const auto& test) {
                             std::string name = std::string(test.param.name) + "_" + test.param.cells;
                             for (char& c : name) c = c == '-' ? '_' : c;
                             return name;
                         });

TEST(Foretold, GrowsWithTheArrayAsTheHopsDo) {
    const Workshop workshop;
    const auto trace = [&](const char* cells) {
        const Words words{"--cells", cells, "--max-cycles", "10"};
        return workshop.report(own_scene("still_life.nff"), words, 4)
            .at("model")
            .at("expected")
            .at("hops")
            .at("trace")
            .get<double>();
    };
    // Rays times path lengths: eight times as many for twice the side.
    EXPECT_NEAR(trace("128x128") / trace("64x64"), 8, 1);
}

TEST(Foretold, OfTreesThatHardlyEndTakesNoTime) {
    const Workshop workshop;
    const Words words{"--cells", "16x16", "--max-depth", "62", "--min-weight", "0", "--max-cycles", "10"};
    const Finished finished = workshop.render(own_scene("still_life.nff"), words);
    EXPECT_LT(finished.seconds, sanitized ? 60 : 10) << "of processor time; measured: 0.5";
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    // A usual pixel of this scene takes 20 hops.
    EXPECT_GT(report.at("model").at("expected").at("hops").at("trace"), 16 * 16 * 1000);
}

TEST(Foretold, LoadsInNoTimeWhereAnotherRunHasLoaded) {
    const Workshop workshop;
    const fs::path scene = own_scene("still_life.nff");
    const Words small{"--cells", "16x16"};
    workshop.report(scene, joined(small, {"--save-array", "results/array"}));
    const Json report = workshop.report(scene, joined(small, {"--load-array", "results/array"}));
    EXPECT_EQ(report.at("model").at("expected").at("seconds").at("load"), 0);
}

// ---- messages

const Words long_run{"render",       own_scene("still_life.nff").string(),
                     "--cells",      "448x448",
                     "--shadows",    "precast",
                     "--max-cycles", "10",
                     "-o",           "results/a"};

TEST(Foretold, IsSaidBeforeALongRun) {
    const Workshop workshop;
    const Finished finished = workshop.run(long_run);
    ASSERT_EQ(finished.exit_code, 4) << finished.err;
    EXPECT_TRUE(contains(finished.err, " M hops: load ")) << finished.err;
    EXPECT_TRUE(contains(finished.err, ", precast ")) << finished.err;
    EXPECT_TRUE(contains(finished.err, ", trace ")) << finished.err;
    EXPECT_LT(finished.err.find(" M hops"), finished.err.find("verdict"));
}

TEST(Foretold, IsNotSaidToTheQuietNorOfAShortRun) {
    const Workshop workshop;
    EXPECT_FALSE(contains(workshop.run(joined(long_run, {"--quiet"})).err, "hops"));
    EXPECT_FALSE(contains(workshop.run(joined(long_run, {"--cells", "32x32"})).err, "hops"));
    EXPECT_FALSE(contains(workshop.run(joined(long_run, {"--stage", "load"})).err, "hops"))
        << "what takes long here is the tracing";
}

}  // namespace
}  // namespace raycell::system_test
