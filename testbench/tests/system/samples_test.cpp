// --samples, --filter and --sample-until.
#include "program.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

const fs::path scene = own_scene("cornell.nff");

double psnr(const Json& report) { return report.at("accuracy").at("scene").at("psnr_db").get<double>(); }

TEST(Samples, ComeNearerToTheirTruthAndAreCountedInAChannel) {
    const Workshop workshop;
    const Words size = {"--cells", "16x16", "--truth"};
    workshop.report(scene, size, 0, "one");
    const Json few = workshop.report(scene, joined(size, {"--samples", "4"}), 0, "a");
    const Json many = workshop.report(scene, joined(size, {"--samples", "16"}), 0, "b");
    EXPECT_GT(psnr(many), psnr(few) + 3);
    EXPECT_EQ(many.at("rays").at("primary"), 16 * 16 * 16);
    EXPECT_GT(many.at("losses").at("sample").at("psnr_db").get<double>(), 45) << "the words' share alone";
    EXPECT_EQ(many.at("storage_bits").at("registers").at("pixels"), 3 * (20 + 4) + 5);
    for (const Pixel& pixel : read_exr(workshop.result("b.exr")).pixels) ASSERT_EQ(pixel.samples, 16u);
    EXPECT_TRUE(contains(read_text(workshop.result("b.exr")), "samples"));
    EXPECT_FALSE(contains(read_text(workshop.result("one.exr")), "samples"));
    for (const Pixel& pixel : read_exr(workshop.result("one.exr")).pixels) ASSERT_EQ(pixel.samples, 1u);
}

TEST(Samples, StopWhereTheFirstFourAgreeAndElsewhereDoNot) {
    const Workshop workshop;
    const Words size = {"--cells", "16x16", "--truth", "--samples", "16"};
    const Json all = workshop.report(scene, size, 0, "a");
    const Json some = workshop.report(scene, joined(size, {"--sample-until", "0.02"}), 0, "b");
    const int sent = some.at("rays").at("primary").get<int>();
    EXPECT_LT(sent, 16 * 16 * 15);
    EXPECT_GT(sent, 16 * 16 * 4);
    EXPECT_GT(psnr(some), psnr(all) - 3);
    EXPECT_LT(some.at("cycles").at("trace"), all.at("cycles").at("trace"));
    int counted = 0;
    for (const Pixel& pixel : read_exr(workshop.result("b.exr")).pixels) counted += int(pixel.samples);
    EXPECT_EQ(counted, sent);
    const Json none = workshop.report(scene, joined(size, {"--sample-until", "8"}), 0, "c");
    EXPECT_EQ(none.at("rays").at("primary"), 16 * 16 * 4);
}

TEST(Samples, HaveOnePictureInBothEnginesAndUnderEveryHost) {
    const Workshop workshop;
    const Words size = {"--cells",  "8x6",  "--pixels",   "16x6", "--samples",      "7",
                        "--filter", "tent", "--own-rays", "3",    "--sample-until", "0.05"};
    const Json timed = workshop.report(scene, size, 0, "a");
    EXPECT_EQ(image(workshop.report(scene, joined(size, {"--engine", "untimed"}), 0, "b")), image(timed));
    for (const Words& host : {Words{"--granularity", "cell"}, Words{"--wire-check"}}) {
        const Json other = workshop.report(scene, joined(size, host), 0, "c");
        EXPECT_EQ(image(other), image(timed)) << host.front();
        EXPECT_EQ(schedule(other), schedule(timed)) << host.front();
    }
    EXPECT_EQ(image(workshop.report(scene, joined(size, {"--stall", "0.2"}), 0, "d")), image(timed));
}

TEST(Samples, AreTheTruthsTooWhichHas256) {
    const Workshop workshop;
    workshop.report(scene, {"--cells", "8x8", "--truth", "--samples", "4", "--filter", "tent"});
    const Finished truth = workshop.run({"truth", scene.string(), "--cells", "8x8", "--samples", "4",
                                         "--filter", "tent", "-o", "results/t", "--quiet"});
    EXPECT_EQ(truth.exit_code, 0) << truth.err;
    const Picture picture = read_exr(workshop.result("t.exr"));
    EXPECT_EQ(read_text(workshop.result("t.exr")), read_text(workshop.result("a.truth.exr")));
    for (const Pixel& pixel : picture.pixels) ASSERT_EQ(pixel.samples, 256u);
}

TEST(Samples, AreWatchedByTheirNumber) {
    const Workshop workshop;
    const Words size = {"--cells", "8x8", "--samples", "4"};
    const Finished finished = workshop.run(joined(
        {"render", scene.string(), "-o", "results/a", "--watch-ray", "9.3/0", "--watch-ray", "9/0"}, size));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(contains(finished.out, "9.3/0")) << finished.out;
    EXPECT_TRUE(contains(finished.out, "9/0"));
}

TEST(Samples, ThatCanNotBeAreRefusedWithWhatIsAllowed) {
    const Workshop workshop;
    const auto refused = [&](const Words& words, const std::string& part) {
        const Finished finished = workshop.render(scene, joined({"--cells", "4x4"}, words));
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, part)) << finished.err;
    };
    refused({"--sample-until", "0"},
            "--sample-until: the first 4 samples of a pixel are sent in any case; expected --samples above "
            "that, not 1");
    refused({"--samples", "4", "--sample-until", "0.1"}, "expected --samples above that, not 4");
    refused({"--samples", "3", "--watch-ray", "9.3/0"}, "there is no sample 3; expected SAMPLE from 0 to 2");
}

TEST(Samples, OfBrightSourcesDoNotOverflowInExactArithmetic) {
    const Workshop workshop;
    workshop.write("sun.toml",
                   "[[source]]\nkind = 'point'\nposition = [0, 1, 3]\ncolour = [1e6, 1e6, 1e6]\n");
    const Words words = {"--cells", "8x8",       "--arithmetic", "exact",    "--engine",
                         "untimed", "--sources", "sun.toml",     "--samples"};
    workshop.report(scene, joined(words, {"64"}), 0, "a");
    for (const Pixel& pixel : read_exr(workshop.result("a.exr")).pixels)
        for (int i = 0; i < 3; ++i) ASSERT_GE(pixel.colour[i], 0);
}

TEST(Samples, OfMoreThanOneAreNotRecordedForACellAlone) {
    const Workshop workshop;
    const Finished finished = workshop.render(scene, {"--cells", "4x4", "--samples", "2", "--golden", "1,1"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "expected --pixels to be the --cells, and --samples 1"))
        << finished.err;
}

}  // namespace
}  // namespace raycell::system_test
