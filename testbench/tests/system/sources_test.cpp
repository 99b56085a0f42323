// Light sources that are no points, through the whole program.
#include <algorithm>
#include <cstdio>

#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Words of --sources with a file of the project's own.
Words lit_by(const std::string& name) { return {"--sources", own_scene(name).string()}; }

TEST(Sources, BothEnginesAndBothKindsOfShadowBitsAgree) {
    const Workshop workshop;
    for (const std::string file : {"sources.toml", "lamp.toml"}) {
        std::map<std::string, std::string> pictures;
        for (const std::string shadows : {"per-hit", "precast", "memo"}) {
            SCOPED_TRACE(file + " " + shadows);
            const Words words = joined(lit_by(file), {"--cells", "20x20", "--shadows", shadows,
                                                      "--source-samples", "7", "--word-bits", "18"});
            const Json untimed =
                workshop.report(own_scene("cornell.nff"), joined(words, {"--engine", "untimed"}));
            const Json timed = workshop.report(own_scene("cornell.nff"), joined(words, {"--wire-check"}));
            ASSERT_FALSE(timed.is_null() || untimed.is_null());
            EXPECT_EQ(image(timed), image(untimed));
            EXPECT_EQ(timed.at("rays"), untimed.at("rays"));
            pictures[shadows] = image(timed);
        }
        EXPECT_EQ(pictures["precast"], pictures["memo"]);
        EXPECT_NE(pictures["precast"], pictures["per-hit"]);
    }
}

TEST(Sources, ASlotAndAVoxelHaveABitForEverySample) {
    const Workshop workshop;
    const auto bits = [&](const std::string& samples, const std::string& shadows) {
        const Json report = workshop.report(
            own_scene("cornell.nff"),
            joined(lit_by("lamp.toml"), {"--cells", "6x6", "--engine", "untimed", "--shadows", shadows,
                                         "--hit", "plane", "--source-samples", samples}));
        return std::pair(report.at("storage_bits").at("slot").get<int>(),
                         report.at("voxels").at("bits_each").get<double>());
    };
    const auto [slot, voxel] = bits("1", "per-hit");
    const auto [more, same] = bits("32", "per-hit");
    EXPECT_EQ(more - slot, 3 * 2 * 31);  // of two areas: to ask, awaited, lit
    EXPECT_EQ(same, voxel);
    EXPECT_EQ(bits("32", "memo").second - bits("1", "memo").second, 2 * 2 * 31);  // lit, known
    EXPECT_EQ(bits("32", "precast").second - bits("1", "precast").second, 2 * 31);
}

TEST(Sources, MoreShadowRaysThanAWordHasBitsAreRefused) {
    const Workshop workshop;
    const Finished finished = workshop.render(
        own_scene("cornell.nff"), joined(lit_by("lamp.toml"), {"--cells", "4x4", "--source-samples", "33"}));
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "66 shadow rays")) << finished.err;
    EXPECT_TRUE(contains(finished.err, "--source-samples 32 or less")) << finished.err;
    EXPECT_TRUE(workshop.results().empty());
    const fs::path wrong = workshop.write("wrong.toml", "[[source]]\nkind = 'sphere'\ncentre = [0, 0, 0]\n");
    const Finished refused =
        workshop.render(own_scene("cornell.nff"), {"--cells", "4x4", "--sources", wrong.string()});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(contains(refused.err, "wrong.toml:1: 'radius' is missing")) << refused.err;
}

// The disc of a sphere lies across the way from the hit to its middle, wherever a ray leaves the cube.
TEST(Sources, ASphereBehindAWallBeyondTheCubeIsHiddenInWordsAsInExactArithmetic) {
    const Workshop workshop;
    workshop.write("ext.nff",
                   "b 0 0 0\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 20\nhither 0.1\nresolution 16 16\n"
                   "l 0 0 5\nf 1 1 1 1 0 0 0 1\np 4\n-3 -3 -1\n3 -3 -1\n3 3 -1\n-3 3 -1\n"
                   "p 4\n4.2 -2 -1\n4.2 2 -1\n4.2 2 3\n4.2 -2 3\n");
    workshop.write("sphere.toml", "[[source]]\nkind = 'sphere'\ncentre = [5, 0, 0.5]\nradius = 2.5\n");
    const Words words = {"--cells",   "12x12",       "--engine",         "untimed",
                         "--sources", "sphere.toml", "--source-samples", "32"};
    workshop.report("ext.nff", words, 0, "words");
    workshop.report("ext.nff", joined(words, {"--arithmetic", "exact"}), 0, "exact");
    const Finished compared = workshop.run({"compare", "results/words.exr", "results/exact.exr", "--json"});
    EXPECT_GT(Json::parse(compared.out).at("psnr_db").get<double>(), 60);
}

TEST(Sources, ThatAreAreasHaveTheSamplesThatSizeIsAskedFor) {
    const Workshop workshop;
    std::string nine;
    for (int i = 0; i < 9; ++i)
        nine += "[[source]]\nkind = 'sphere'\ncentre = [0, 1, " + std::to_string(i) + "]\nradius = 0.1\n";
    workshop.write("nine.toml", nine);
    const Words words = {"size",      own_scene("cornell.nff").string(),
                         "--cells",   "4x4",
                         "--sources", "nine.toml",
                         "--psnr",    "10",
                         "-o",        "results/a"};
    const Finished many = workshop.run(words);
    EXPECT_EQ(many.exit_code, 1);
    EXPECT_TRUE(contains(many.err, "--source-samples 7 or less")) << many.err;
    const Finished few = workshop.run(joined(words, {"--source-samples", "3"}));
    EXPECT_EQ(few.exit_code, 0) << few.err;
    EXPECT_TRUE(contains(read_text(workshop.result("a.toml")), "source-samples = 3"));
}

TEST(Sources, AreNotTakenForWordsThatAreTooShort) {
    const Workshop workshop;
    const Finished one = workshop.run(joined(
        {"render", own_scene("cornell.nff").string(), "-o", "results/a"},
        joined(lit_by("lamp.toml"), {"--cells", "16x16", "--source-samples", "1", "--engine", "untimed"})));
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_FALSE(contains(one.err, "--word-bits")) << one.err;
}

/// The lamp of the data set's own file, with samples of the machine against many of the truth.
TEST(Sources, TheCornellBoxIsLitByItsOwnLamp) {
    SKIP_WITHOUT_SHARED_SCENES();
    const Workshop workshop;
    double before = 0;
    for (const std::string samples : {"4", "16", "64"}) {
        const Json report = workshop.report(
            shared_scenes() / "obj/CornellBox-Original.obj",
            {"--cells", "64x64", "--engine", "untimed", "--truth", "--source-samples", samples});
        ASSERT_FALSE(report.is_null());
        const double psnr = report.at("accuracy").at("scene").at("psnr_db");
        std::printf("%s samples: %.2f dB\n", samples.c_str(), psnr);
        EXPECT_GT(psnr, before);
        before = psnr;
        EXPECT_GT(report.at("rays").at("shadow"), 0);
    }
    EXPECT_GE(before, 35);
}

}  // namespace
}  // namespace raycell::system_test
