// --pixels and --own-rays: cells that own a block of pixels.
#include "program.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

const fs::path scene = own_scene("cornell.nff");

TEST(Pixels, OfAsManyAsThereAreCellsAreTheSameRunWhateverTheOwnRays) {
    const Workshop workshop;
    const Json plain = workshop.report(scene, {"--cells", "12x10"}, 0, "a");
    const Json same =
        workshop.report(scene, {"--cells", "12x10", "--pixels", "12x10", "--own-rays", "7"}, 0, "b");
    for (const char* key : {"cycles", "hash", "message_bits", "storage_bits", "hops", "rays", "pixels"})
        EXPECT_EQ(same.at(key), plain.at(key)) << key;
    EXPECT_EQ(plain.at("config").at("pixels"), "cells");
    EXPECT_FALSE(plain.at("storage_bits").at("registers").contains("pixels"));
}

TEST(Pixels, HaveOnePictureInBothEnginesAndUnderEveryHost) {
    const Workshop workshop;
    const Words size = {"--cells", "9x6", "--pixels", "36x18"};
    const Json timed = workshop.report(scene, size, 0, "a");
    EXPECT_EQ(timed.at("pixels").at("all"), 36 * 18);
    EXPECT_EQ(timed.at("rays").at("primary"), 36 * 18);
    EXPECT_EQ(timed.at("storage_bits").at("registers").at("pixels"), 12 * 60);
    const Picture picture = read_exr(workshop.result("a.exr"));
    EXPECT_EQ(picture.width, 36);
    EXPECT_EQ(picture.height, 18);
    const Json untimed = workshop.report(scene, joined(size, {"--engine", "untimed"}), 0, "b");
    EXPECT_EQ(image(untimed), image(timed));
    for (const Words& host : {Words{"--granularity", "cell"}, Words{"--wire-check"}}) {
        const Json other = workshop.report(scene, joined(size, host), 0, "c");
        EXPECT_EQ(image(other), image(timed)) << host.front();
        EXPECT_EQ(schedule(other), schedule(timed)) << host.front();
    }
    for (const Words& shadows : {Words{"--shadows", "precast"}, Words{"--shadows", "memo"}}) {
        const Json bits = workshop.report(scene, joined(size, shadows), 0, "d");
        EXPECT_EQ(
            image(workshop.report(scene, joined(joined(size, shadows), {"--engine", "untimed"}), 0, "e")),
            image(bits))
            << shadows.back();
    }
}

TEST(Pixels, AreMetByTheTruthAndByTheSample) {
    const Workshop workshop;
    const Json report =
        workshop.report(scene, {"--cells", "8x8", "--pixels", "24x24", "--truth", "--arithmetic", "exact"});
    EXPECT_GT(report.at("accuracy").at("psnr_db").get<double>(), 150);
    EXPECT_GT(report.at("losses").at("sample").at("psnr_db").get<double>(), 150);
    const Finished truth = workshop.run(
        {"truth", scene.string(), "--cells", "8x8", "--pixels", "24x24", "-o", "results/t", "--quiet"});
    EXPECT_EQ(truth.exit_code, 0) << truth.err;
    EXPECT_EQ(read_text(workshop.result("t.exr")), read_text(workshop.result("a.truth.exr")));
}

TEST(Pixels, AreRecordedWatchedAndLoadedOnceLikeThoseOfOneACell) {
    const Workshop workshop;
    const Words size = {"--cells", "8x6", "--pixels", "16x18"};
    const Json first = workshop.report(
        scene, joined(size, {"--film", "8", "--rays", "--save-array", "results/array"}), 0, "a");
    const Json film = Json::parse(read_text(workshop.result("a.film.json")));
    int done = 0;
    for (const Json& frame : film.at("layers").at("pixels_done")) {  // pairs of a cell and its value
        for (std::size_t i = 1; i < frame.size(); i += 2) done = std::max(done, frame[i].get<int>());
    }
    EXPECT_EQ(done, 6) << "pixels of a cell";
    EXPECT_TRUE(contains(read_text(workshop.result("a.rays.csv")), "\n287/0,,primary,0,7,5,"))
        << "the last pixel";
    const Json again = workshop.report(scene, joined(size, {"--load-array", "results/array"}), 0, "b");
    EXPECT_EQ(again.at("hash"), first.at("hash"));
    const Finished watched = workshop.run(
        joined({"render", scene.string(), "-o", "results/w", "--watch-pixel", "15,17", "--quiet"}, size));
    EXPECT_EQ(watched.exit_code, 0) << watched.err;
    EXPECT_TRUE(contains(watched.out, "(7, 5)") && contains(watched.out, "287/0")) << watched.out;
}

TEST(Pixels, AreTracedBySyntheticTrafficToo) {
    const Workshop workshop;
    const Finished finished =
        workshop.run_program(RAYCELL_DEADLOCK_TB, {"--cells", "8x8", "--pixels", "16x32", "--own-rays", "3"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(contains(finished.out, "512 of 512 pixels, the untimed picture equal")) << finished.out;
}

TEST(Pixels, AreRefusedWithWhatWasAllowed) {
    const Workshop workshop;
    const auto refused = [&](const Words& words, const std::string& part) {
        const Finished finished = workshop.render(scene, joined({"--cells", "16x16"}, words));
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, part)) << finished.err;
        EXPECT_EQ(workshop.results(), std::vector<std::string>());
    };
    refused({"--pixels", "40x16"}, "--pixels 40x16: expected a whole multiple of --cells 16x16 each way");
    refused({"--pixels", "8x8"}, "--pixels 8x8: expected a whole multiple of --cells 16x16 each way");
    refused({"--pixels", "many"}, "expected cells or WxH from 1x1 to 4096x4096, not 'many'");
    refused({"--pixels", "32x32", "--golden", "1,1"},
            "--golden: records are of cells with a primary ray each");
    refused({"--pixels", "32x32", "--watch-pixel", "32,0"}, "there is no pixel (32, 0); expected X below 32");
    refused({"--own-rays", "17"}, "from 1 to 16");
}

}  // namespace
}  // namespace raycell::system_test
