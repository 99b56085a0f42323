// PSNR between the machine's picture and the truth, and no ray leaks through a wall.
#include <cmath>
#include <cstdio>
#include <map>

#include "model/picture/compare.hpp"
#include "program.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

constexpr double least_psnr =
    60;  ///< at `edge`, dB; measured: at least 126. One wrong pixel costs 20 or more.

constexpr double least_in_words = 40;  ///< dB, in words of 20 bits

struct AccuracyCase {
    const char* scene;
    Words words;
    const char* name;
};
void PrintTo(const AccuracyCase& accuracy, std::ostream* out) { *out << accuracy.name; }

class Accuracy : public ::testing::TestWithParam<AccuracyCase> {
  protected:
    /// PSNR in dB and share of wrong first hits in percent, at a rung.
    std::pair<double, double> at(const std::string& hit, const std::string& engine = "untimed") const {
        const Json report = workshop.report(
            shared_scenes() / "spd" / (std::string(GetParam().scene) + ".nff"),
            joined({"--cells", "64x64", "--truth", "--arithmetic", "exact", "--engine", engine, "--hit", hit},
                   GetParam().words));
        if (report.is_null() || !report.contains("accuracy")) {
            ADD_FAILURE() << "no accuracy reported";
            return {0, 100};
        }
        const Json& accuracy = report.at("accuracy");
        for (const char* key : {"psnr_db", "rmse", "max_error", "off_by_1_255_percent", "off_by_0_1_percent",
                                "wrong_hit_percent"}) {
            EXPECT_TRUE(accuracy.contains(key)) << key;
        }
        std::printf("%-10s %-9s %7.2f dB, other first hit in %.3f %%\n", GetParam().scene, hit.c_str(),
                    accuracy.at("psnr_db").get<double>(), accuracy.at("wrong_hit_percent").get<double>());
        return {accuracy.at("psnr_db"), accuracy.at("wrong_hit_percent")};
    }
    Workshop workshop;
};

TEST_P(Accuracy, GrowsWithEveryRungAndAtTheTopEveryFirstHitIsTheTruths) {
    SKIP_WITHOUT_SHARED_SCENES();
    const auto [edge, wrong] = at("edge");
    EXPECT_GE(edge, least_psnr);
    EXPECT_EQ(wrong, 0);
    const double mask = at("mask").first;
    const double plane = at("plane").first;
    const double interval = at("interval").first;
    EXPECT_GE(edge, mask);
    EXPECT_GE(mask, plane);
    EXPECT_GE(plane, interval);
}

const Words inside = {"--clip-truth", "--exterior", "none"};
const Words all = {"--exterior", "host"};

INSTANTIATE_TEST_SUITE_P(Shared, Accuracy,
                         ::testing::Values(AccuracyCase{"teapot-s4", inside, "teapot_inside_the_cube"},
                                           AccuracyCase{"teapot-s4", all, "teapot_with_its_exterior"},
                                           AccuracyCase{"balls-s2", inside, "balls_inside_the_cube"},
                                           AccuracyCase{"balls-s2", all, "balls_with_their_exterior"},
                                           AccuracyCase{"mount-s4", inside, "mount_inside_the_cube"},
                                           AccuracyCase{"mount-s4", all, "mount_with_its_exterior"},
                                           AccuracyCase{"tetra-s4", inside, "tetra_inside_the_cube"},
                                           AccuracyCase{"tetra-s4", all, "tetra_with_its_exterior"},
                                           AccuracyCase{"gears-s1", inside, "gears_inside_the_cube"},
                                           AccuracyCase{"gears-s1", all, "gears_with_their_exterior"}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TruthBeside, TheTimedMachineReportsTheSameAccuracyAsTheUntimedOne) {
    const Workshop workshop;
    const Words words = {"--cells", "48x32", "--truth"};
    for (const std::string arithmetic : {"exact", "fixed"}) {
        const Words own = joined(words, {"--arithmetic", arithmetic});
        const Json timed = workshop.report(own_scene("still_life.nff"), own);
        const Json untimed =
            workshop.report(own_scene("still_life.nff"), joined(own, {"--engine", "untimed"}));
        EXPECT_EQ(timed.at("accuracy"), untimed.at("accuracy"));
        EXPECT_GE(timed.at("accuracy").at("psnr_db"), arithmetic == "exact" ? least_psnr : least_in_words);
        if (arithmetic == "exact") {
            EXPECT_EQ(timed.at("accuracy").at("wrong_hit_percent"), 0);
        }
    }
}

double psnr(const Json& accuracy) { return accuracy.at("psnr_db").get<double>(); }

TEST(TruthOfTheScene, IsThatOfItsPolygonsUnlessAnythingIsCurved) {
    const Workshop workshop;
    const Words words = {"--cells", "48x48", "--engine", "untimed", "--truth"};
    const Json flat = workshop.report(own_scene("cornell.nff"), words);
    const Json curved = workshop.report(own_scene("still_life.nff"), words);
    ASSERT_FALSE(flat.is_null() || curved.is_null());
    EXPECT_EQ(psnr(flat.at("accuracy").at("tessellation")), 200);
    EXPECT_EQ(psnr(flat.at("accuracy").at("scene")), psnr(flat.at("accuracy")));
    const double polygons = psnr(curved.at("accuracy").at("tessellation"));
    EXPECT_GT(polygons, 30);
    EXPECT_LT(polygons, 50);
    EXPECT_NEAR(psnr(curved.at("accuracy").at("scene")), polygons, 1) << "polygons cost more than words";
    Words finer = words;
    finer.insert(finer.end(), {"--chord-error", "0.005"});
    const Json close = workshop.report(own_scene("still_life.nff"), finer);
    EXPECT_GT(psnr(close.at("accuracy").at("tessellation")), polygons + 5);
}

TEST(TruthOfTheScene, IsTheDefaultAndThatOfThePolygonsIsAskedForByName) {
    const Workshop workshop;
    const auto picture = [&](const std::string& scene, const Words& more) {
        const Words words =
            joined({"truth", own_scene(scene).string(), "--cells", "32x32", "-o", "results/t"}, more);
        EXPECT_EQ(workshop.run(words).exit_code, 0);
        return read_exr(workshop.result("t.exr").string());
    };
    const auto apart = [](const Picture& a, const Picture& b) { return compare(a, b).psnr_db; };
    const Picture flat = picture("cornell.nff", {});
    EXPECT_EQ(image_hash(picture("cornell.nff", {"--truth-of", "polygons"})), image_hash(flat));
    const Picture scene = picture("still_life.nff", {});
    EXPECT_EQ(image_hash(picture("still_life.nff", {"--truth-of", "scene"})), image_hash(scene));
    EXPECT_LT(apart(picture("still_life.nff", {"--truth-of", "polygons"}), scene), 60);
    EXPECT_EQ(apart(picture("still_life.nff", {"--chord-error", "0.2"}), scene), 200) << "no polygon is met";
    EXPECT_LT(apart(picture("still_life.nff", {"--clip"}), scene), 60) << "curved surfaces are clipped, too";
}

TEST(TessellateFor, BringsTheWholePictureToTheAccuracyThatIsAskedFor) {
    const Workshop workshop;
    const Words words = {"--cells", "96x96", "--engine", "untimed", "--truth"};
    const Json fixed = workshop.report(own_scene("still_life.nff"), words);
    const Json finer =
        workshop.report(own_scene("still_life.nff"), joined(words, {"--tessellate-for", "47"}));
    ASSERT_FALSE(fixed.is_null() || finer.is_null());
    EXPECT_GE(psnr(finer.at("accuracy").at("tessellation")), 46.5);
    EXPECT_GE(psnr(finer.at("accuracy").at("scene")), 46);
    EXPECT_GT(finer.at("cube").at("polygons"), fixed.at("cube").at("polygons"));
}

TEST(TruthBeside, IsThePictureThatTruthRendersAlone) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("still_life.nff"), {"--cells", "24x32", "--truth"});
    ASSERT_EQ(
        workshop.run({"truth", own_scene("still_life.nff").string(), "--cells", "24x32", "-o", "results/t"})
            .exit_code,
        0);
    const Picture beside = read_exr(workshop.result("a.truth.exr").string());
    const Picture alone = read_exr(workshop.result("t.exr").string());
    EXPECT_EQ(image_hash(beside), image_hash(alone));
}

// ---- leaks

struct Direction {
    int turn;  ///< degrees round the vertical axis of the box
    int rise;  ///< degrees above the horizon
    int roll;  ///< degrees of the picture round its own axis
};
void PrintTo(const Direction& d, std::ostream* out) { *out << d.turn << ' ' << d.rise << ' ' << d.roll; }

/// cornell.nff seen from another direction, so that its walls stand at other angles to the array's axes.
std::string seen_from(const Direction& d) {
    const double degree = std::acos(-1) / 180;
    const dvec3 centre(0, 1, 0);
    const dvec3 back(std::sin(d.turn * degree) * std::cos(d.rise * degree), std::sin(d.rise * degree),
                     std::cos(d.turn * degree) * std::cos(d.rise * degree));
    const dvec3 right(std::cos(d.turn * degree), 0, -std::sin(d.turn * degree));
    const dvec3 above = glm::cross(back, right);
    const dvec3 from = centre + 4.0 * back;
    const dvec3 up = std::cos(d.roll * degree) * above + std::sin(d.roll * degree) * right;
    const auto line = [](const char* word, const dvec3& v) {
        char text[120];
        std::snprintf(text, sizeof text, "%s %.17g %.17g %.17g", word, v.x, v.y, v.z);
        return std::string(text);
    };
    std::istringstream scene(read_text(own_scene("cornell.nff")));
    std::string text;
    std::string words;
    int replaced = 0;
    while (std::getline(scene, words)) {
        if (words.rfind("from ", 0) == 0) words = line("from", from), ++replaced;
        if (words.rfind("at ", 0) == 0) words = line("at", centre), ++replaced;
        if (words.rfind("up ", 0) == 0) words = line("up", up), ++replaced;
        text += words + "\n";
    }
    EXPECT_EQ(replaced, 3);
    return text;
}

int leaks(const Picture& machine, const Picture& truth, int& hits) {
    int through = 0;
    hits = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        if (truth.pixels[i].polygon == no_polygon) continue;
        ++hits;
        through += machine.pixels[i].polygon == no_polygon;
    }
    return through;
}

class Walls : public ::testing::TestWithParam<Direction> {};

TEST_P(Walls, LetNoPrimaryRayThroughFromTheIntervalUp) {
    const Workshop workshop;
    const fs::path scene = workshop.write("walls.nff", seen_from(GetParam()));
    for (const std::string viewer : {"scene", "infinity"}) {
        for (const std::string hit : {"interval", "plane", "mask", "edge"}) {
            // Each viewer in both arithmetics, and every rung.
            const std::string arithmetic = (viewer == "scene") == (hit == "plane") ? "exact" : "fixed";
            SCOPED_TRACE("viewer " + viewer + ", " + hit + ", " + arithmetic);
            const Json report =
                workshop.report(scene, {"--cells", "64x64", "--engine", "untimed", "--truth", "--clip-truth",
                                        "--exterior", "none", "--max-depth", "0", "--viewer", viewer, "--hit",
                                        hit, "--arithmetic", arithmetic});
            ASSERT_FALSE(report.is_null());
            int hits = 0;
            EXPECT_EQ(leaks(read_exr(workshop.result("a.exr").string()),
                            read_exr(workshop.result("a.truth.exr").string()), hits),
                      0);
            EXPECT_GT(hits, 64 * 64 / 4) << "the box fills a good part of the picture";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Turned, Walls,
                         ::testing::Values(Direction{0, 0, 0}, Direction{7, 0, 0}, Direction{30, 0, 0},
                                           Direction{45, 0, 0}, Direction{0, 7, 0}, Direction{0, 30, 0},
                                           Direction{0, 45, 0}, Direction{0, 0, 7}, Direction{0, 0, 30},
                                           Direction{0, 0, 45}, Direction{30, 20, 10}, Direction{45, 35, 45},
                                           Direction{90, 0, 0}, Direction{0, 90, 0}, Direction{180, 0, 0}),
                         [](const auto& test) {
                             const Direction& d = test.param;
                             return "by_" + std::to_string(d.turn) + "_" + std::to_string(d.rise) + "_" +
                                    std::to_string(d.roll) + "_degrees";
                         });

}  // namespace
}  // namespace raycell::system_test
