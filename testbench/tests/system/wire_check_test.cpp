// --wire-check: every ray and answer packed into its bits at every link, and the receivers' results the same.
#include "program.hpp"

namespace raycell::system_test {
namespace {

void expect_same_when_packed(const fs::path& scene, const Words& words) {
    const Workshop workshop;
    std::string said;
    for (const std::string& word : words) said += word + " ";
    SCOPED_TRACE(scene.filename().string() + " " + said);
    const Json plain = workshop.report(scene, words, 0, "plain");
    const Json packed = workshop.report(scene, joined(words, {"--wire-check"}), 0, "packed");
    EXPECT_EQ(image(packed), image(plain));
    EXPECT_EQ(schedule(packed), schedule(plain));
    EXPECT_EQ(packed.at("cycles"), plain.at("cycles"));
    EXPECT_EQ(packed.at("hops"), plain.at("hops"));
    EXPECT_FALSE(plain.at("messages").contains("packed"));
    EXPECT_GE(packed.at("messages").at("packed_load"), plain.at("hops").at("load"));
    // Every hop of a ray or an answer, the exterior's included, is one message packed.
    EXPECT_EQ(packed.at("messages").at("packed"), plain.at("hops").at("ray").get<std::int64_t>() +
                                                      plain.at("hops").at("return").get<std::int64_t>());
}

TEST(WireCheck, EveryRungAndWordLengthGivesTheSamePictureInTheSameCycles) {
    const Words rungs = {"edge", "mask", "plane", "interval", "depth"};
    const Words lengths = {"8", "12", "16", "20", "24", "32"};
    const Words networks = {"half", "quadrant"};
    const Words shadows = {"per-hit", "memo", "precast"};
    const Words normals = {"linear", "voxel"};
    std::size_t turn = 0;
    for (const std::string& rung : rungs) {
        for (const std::string& bits : lengths) {
            expect_same_when_packed(
                own_scene(turn % 2 == 0 ? "still_life.nff" : "facing_mirrors.nff"),
                {"--cells", "14x11", "--hit", rung, "--word-bits", bits, "--networks", networks[turn % 2],
                 "--shadows", shadows[turn % 3], "--normals", normals[turn / 2 % 2], "--ray-store", "6"});
            ++turn;
        }
    }
}

TEST(WireCheck, PostponedRaysRandomStallsAndLostRaysAreTheSame) {
    const Words mirrors = {"--cells", "20x20"};
    for (const Words& words :
         std::vector<Words>{{"--ray-store", "5", "--buffer", "3"},
                            {"--stall", "0.2", "--seed", "7"},
                            {"--exterior", "none"},
                            {"--networks", "shared", "--ray-store", "40", "--buffer", "40"},
                            {"--granularity", "cell", "--link-bits", "7"},
                            {"--rounding", "truncate", "--max-depth", "20", "--ray-store", "21"}}) {
        expect_same_when_packed(own_scene("facing_mirrors.nff"), joined(mirrors, words));
    }
}

TEST(WireCheck, TheProceduralDatabasesScenesAreTheSame) {
    SKIP_WITHOUT_SHARED_SCENES();
    for (const char* name :
         {"balls-s2", "gears-s1", "mount-s4", "rings-s2", "teapot-s4", "tetra-s4", "tree-s3"}) {
        const fs::path scene = shared_scenes() / "spd" / (std::string(name) + ".nff");
        if (fs::exists(scene)) expect_same_when_packed(scene, {"--cells", "16x16"});
    }
}

TEST(WireCheck, AVoxelThatHasNoCodeEndsTheRunWithTheFieldsName) {
    const Workshop workshop;  // a cell with 4671 voxels, whose numbers have 10 bits in messages
    const Finished finished =
        workshop.render(own_scene("still_life.nff"),
                        {"--cells", "1x1", "--chord-error", "0.001", "--shadows", "precast", "--wire-check"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_TRUE(contains(finished.err, "the field slot of 10 bits has no code for 1024")) << finished.err;
    EXPECT_EQ(workshop.results(), std::vector<std::string>());
}

TEST(WireCheck, WithoutWiresOrWordsItIsRefused) {
    const Workshop workshop;
    const Finished untimed =
        workshop.render(own_scene("cornell.nff"), {"--wire-check", "--engine", "untimed"});
    EXPECT_EQ(untimed.exit_code, 1);
    EXPECT_TRUE(contains(untimed.err, "--wire-check: the untimed engine has no links")) << untimed.err;
    const Finished exact =
        workshop.render(own_scene("cornell.nff"), {"--wire-check", "--arithmetic", "exact"});
    EXPECT_EQ(exact.exit_code, 1);
    EXPECT_TRUE(contains(exact.err, "--wire-check: exact numbers are no words")) << exact.err;
}

}  // namespace
}  // namespace raycell::system_test
