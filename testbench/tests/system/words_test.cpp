// The machine in fixed-point words: how near it comes to the truth, and the effect of every option of its
// numbers.
#include <cmath>
#include <cstdio>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

struct WordsCase {
    const char* scene;
    double least_psnr;  ///< at `edge`, 20 bits, 128x128, dB
};
void PrintTo(const WordsCase& each, std::ostream* out) { *out << each.scene; }

class TwentyBits : public ::testing::TestWithParam<WordsCase> {
  protected:
    double psnr(const Words& words) const {
        const Json report =
            workshop.report(shared_scenes() / "spd" / (std::string(GetParam().scene) + ".nff"),
                            joined({"--cells", "128x128", "--engine", "untimed", "--truth"}, words));
        if (report.is_null()) return 0;
        const double found = report.at("accuracy").at("psnr_db");
        std::string line;
        for (const std::string& word : words) line += " " + word;
        std::printf("%-10s%s: %.2f dB\n", GetParam().scene, line.c_str(), found);
        return found;
    }
    Workshop workshop;
};

TEST_P(TwentyBits, ComeNearToTheTruthAtTheTopOfTheLadder) {
    SKIP_WITHOUT_SHARED_SCENES();
    EXPECT_GE(psnr({"--word-bits", "20"}), GetParam().least_psnr);
}

TEST_P(TwentyBits, CostNothingAtMaskWhereDiscretisationCostsMore) {
    SKIP_WITHOUT_SHARED_SCENES();
    EXPECT_NEAR(psnr({"--hit", "mask"}), psnr({"--hit", "mask", "--arithmetic", "exact"}), 1);
}

INSTANTIATE_TEST_SUITE_P(Shared, TwentyBits,
                         ::testing::Values(WordsCase{"teapot-s4", 42}, WordsCase{"balls-s2", 40},
                                           WordsCase{"mount-s4", 45}, WordsCase{"tetra-s4", 45},
                                           WordsCase{"gears-s1", 45}),
                         [](const auto& test) {
                             std::string name = test.param.scene;
                             name[name.find('-')] = '_';
                             return name;
                         });

// ---- options

const Words square = {"--cells", "32x32"};

struct Effect {
    Words words;
    Words instead_of;  ///< if empty: the defaults
    bool picture;      ///< whether the picture must differ; if not, it must be the same
    bool cycles;       ///< whether the cycles must differ, where the pictures are the same
};

TEST(Options, OfNumbersEachDoWhatTheySay) {
    const Workshop workshop;
    const auto run = [&](const Words& words) {
        return workshop.report(own_scene("still_life.nff"), joined(square, words));
    };
    const Words by_table = {"--reciprocal", "table", "--root", "table"};
    const std::vector<Effect> effects = {
        {{"--arithmetic", "fixed"}, {}, false, false},
        {{"--word-bits", "20"}, {}, false, false},
        {{"--rounding", "nearest"}, {}, false, false},
        {{"--reciprocal", "newton", "--root", "newton", "--power", "tables"}, {}, false, false},
        {{"--reciprocal-table", "64", "--root-table", "64", "--power-table", "32"}, {}, false, false},
        {{"--arithmetic", "exact"}, {}, true, false},
        {{"--word-bits", "21"}, {}, true, true},
        {{"--word-bits", "12"}, {}, true, true},
        {{"--rounding", "truncate"}, {}, true, false},
        {{"--reciprocal", "table"}, {}, true, true},
        {{"--reciprocal", "rounded"}, {}, true, true},
        {{"--root", "table"}, {}, true, true},
        {{"--root", "rounded"}, {}, true, true},
        {{"--power", "schlick"}, {}, true, true},
        {{"--power", "rounded"}, {}, true, true},
        {joined(by_table, {"--reciprocal-table", "16"}), by_table, true, false},
        {joined(by_table, {"--root-table", "16"}), by_table, true, false},
        {{"--power-table", "16"}, {}, true, false},
        // The size of a table that is not used has no effect.
        {{"--reciprocal", "rounded", "--reciprocal-table", "4"}, {"--reciprocal", "rounded"}, false, false},
        {{"--root", "rounded", "--root-table", "4"}, {"--root", "rounded"}, false, false},
        {{"--power", "schlick", "--power-table", "4"}, {"--power", "schlick"}, false, false},
        // Cycles of operators: only the method in use counts.
        {{"--cost", "reciprocal_newton=9"}, {}, false, true},
        {{"--cost", "root_newton=9"}, {}, false, true},
        {{"--cost", "power_tables=9"}, {}, false, true},
        {{"--cost", "power_schlick=9", "--cost", "root_rounded=9"}, {}, false, false},
        // 8 last bits of 2^-18 each.
        {{"--normal-offset", "-1"}, {}, false, false},
        {{"--normal-offset", "-0.5"}, {}, false, false},
        {{"--normal-offset", "3.0517578125e-05"}, {}, false, false},
        {{"--normal-offset", "0.02"}, {}, true, false},
        {{"--arithmetic", "exact", "--normal-offset", "0"}, {"--arithmetic", "exact"}, false, false},
    };
    for (const Effect& effect : effects) {
        std::string line;
        for (const std::string& word : effect.words) line += " " + word;
        SCOPED_TRACE(line);
        const Json with = run(effect.words);
        const Json without = run(effect.instead_of);
        EXPECT_EQ(image(with) != image(without), effect.picture);
        if (effect.cycles) {
            EXPECT_NE(with.at("cycles"), without.at("cycles"));
        } else if (!effect.picture) {
            EXPECT_EQ(with.at("cycles"), without.at("cycles"));
        }
    }
}

TEST(Options, FormatsAndBitsOfAReportFollowTheWord) {
    const Workshop workshop;
    for (const int word : {8, 20, 32}) {
        const Json report = workshop.report(own_scene("still_life.nff"),
                                            joined(square, {"--word-bits", std::to_string(word)}));
        EXPECT_EQ(report.at("formats").at("unit"), "Q2." + std::to_string(word - 2));
        // A verdict contains no word; an intensity contains three.
        const Json& bits = report.at("message_bits");
        EXPECT_EQ(bits.at("intensity").get<int>() - bits.at("verdict").get<int>(), 3 * word);
    }
}

// ---- warnings

/// The warnings about numbers that the cell's words can't hold.
std::string range_warnings(const std::string& light, const std::string& material, const Words& words) {
    const Workshop workshop;
    workshop.write("ball.nff",
                   "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 0.1 resolution 8 8\n"
                   "l 3 3 5 " +
                       light + "\nf " + material + "\ns 0 0 0 1\n");
    const Finished finished =
        workshop.run(joined({"render", "ball.nff", "--cells", "8x8", "--quiet", "-o", "results/a"}, words));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    std::istringstream lines(finished.err);
    std::string found;
    for (std::string line; std::getline(lines, line);) {
        if (contains(line, "words of ")) found += line + "\n";
    }
    return found;
}

TEST(RangeWarnings, NameWhatAWordCannotHoldAndWhatItIsHeldAs) {
    const std::string plain = "1 1 1 0.7 0.3 10 0.5 1.5";
    EXPECT_EQ(range_warnings("1 1 1", plain, {}), "");
    EXPECT_TRUE(contains(range_warnings("1 1 1", "5 1 1 0.7 0.3 10 0.5 1.5", {}),
                         "words of 20 bits: a colour or coefficient of 5 is held as 3.99"));
    EXPECT_TRUE(contains(range_warnings("30 1 1", plain, {}), "a light of 30 is held as 7.99"));
    const std::string bends = range_warnings("1 1 1", "1 1 1 0.7 0.3 10 0.5 9", {"--word-bits", "16"});
    EXPECT_TRUE(contains(bends, "words of 16 bits: an index of refraction outside 0.125")) << bends;
    // The index of refraction does not matter where nothing is transmitted.
    EXPECT_EQ(range_warnings("1 1 1", "1 1 1 0.7 0.3 10 0 9", {}), "");
    EXPECT_EQ(range_warnings("30 1 1", "5 1 1 0.7 0.3 10 0.5 9", {"--arithmetic", "exact"}), "");
}

TEST(RangeWarnings, SayHowFarRaysMayGoAstrayInADeepCubeOfShortWords) {
    const std::string plain = "1 1 1 0.7 0.3 10 0.5 1.5";
    EXPECT_EQ(range_warnings("1 1 1", plain, {"--word-bits", "12", "--cells", "8x8"}), "");
    const std::string far = range_warnings("1 1 1", plain, {"--word-bits", "8", "--cells", "64x64"});
    EXPECT_TRUE(contains(far, "words of 8 bits: rays may be off by 0.")) << far;
}

// ---- losses

TEST(Losses, AreCountedByCauseAndThePictureIsComparedWithTheTruthAtSomePixels) {
    const Workshop workshop;
    const Json fixed = workshop.report(own_scene("still_life.nff"), {"--cells", "24x24"}).at("losses");
    EXPECT_GT(fixed.at("drift_cells").get<double>(), 0);
    EXPECT_GT(fixed.at("exterior_rays").get<int>(), 0);
    EXPECT_EQ(fixed.at("sample").at("pixels"), 512);
    EXPECT_GT(fixed.at("sample").at("psnr_db").get<double>(), 50);
    EXPECT_LT(fixed.at("sample").at("psnr_db").get<double>(), 200);
    const Json exact =
        workshop.report(own_scene("cornell.nff"), {"--cells", "16x16", "--arithmetic", "exact"}).at("losses");
    EXPECT_EQ(exact.at("drift_cells"), 0);
    EXPECT_EQ(exact.at("sample").at("pixels"), 256) << "all that there are";
    EXPECT_EQ(exact.at("sample").at("psnr_db"), 200) << "equal";
    EXPECT_GT(exact.at("ties").get<int>(), 0) << "walls that meet on the diagonals";
    const Json loaded =
        workshop.report(own_scene("cornell.nff"), {"--cells", "16x16", "--stage", "load"}).at("losses");
    EXPECT_TRUE(loaded.at("sample").at("psnr_db").is_null());
}

TEST(Losses, AreTheSameTimedAndUntimed) {
    const Workshop workshop;
    const Words words = {"--cells", "20x20", "--ray-store", "16"};
    Json timed = workshop.report(own_scene("still_life.nff"), words).at("losses");
    Json untimed =
        workshop.report(own_scene("still_life.nff"), joined(words, {"--engine", "untimed"}), 0, "b")
            .at("losses");
    EXPECT_EQ(timed, untimed);
}

TEST(Losses, OfWordsTooShortForASceneAreSaidAfterTheRunWhereNothingElseIsTheReason) {
    const auto said = [](const Words& words) {
        const Workshop workshop;
        const Finished finished = workshop.run(joined(
            {"render", own_scene("still_life.nff").string(), "--cells", "24x24", "-o", "results/a"}, words));
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return contains(finished.err, "sampled pixels are");
    };
    EXPECT_TRUE(said({"--word-bits", "10"}));
    EXPECT_FALSE(said({"--word-bits", "10", "--quiet"}));
    EXPECT_FALSE(said({}));
    EXPECT_FALSE(said({"--word-bits", "10", "--hit", "plane"})) << "the rung costs more than the words";
}

}  // namespace
}  // namespace raycell::system_test
