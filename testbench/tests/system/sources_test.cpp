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
