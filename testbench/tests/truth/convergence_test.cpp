// The machine against the truth, on whole scenes: exact arithmetic hits the same surfaces, ties included, and
// longer words come nearer to the truth.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "model/machine/untimed.hpp"
#include "model/picture/compare.hpp"
#include "model/truth/exterior.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {
namespace {

struct SceneCase {
    std::string folder;
    std::string name;
    bool edges_on_pixels =
        false;  ///< edges run through pixel centres, so the last bit of a direction decides between surfaces
};
void PrintTo(const SceneCase& scene, std::ostream* out) { *out << scene.name; }

const std::vector<SceneCase> scenes = {{"own", "cornell", true},  {"own", "still_life"},
                                       {"own", "facing_mirrors"}, {"found", "edge_on_pixels", true},
                                       {"found", "flat_facing"},  {"found", "thin_cylinders"},
                                       {"found", "tir_black"},    {"spd", "balls-s2"},
                                       {"spd", "gears-s1"},       {"spd", "lattice-s2"},
                                       {"spd", "mount-s4"},       {"spd", "rings-s1"},
                                       {"spd", "teapot-s2"},      {"spd", "tetra-s4"},
                                       {"spd", "tree-s3"}};

std::filesystem::path path_of(const SceneCase& scene) {
    const std::filesystem::path root(RAYCELL_SOURCE_DIR);
    const std::filesystem::path folder =
        scene.folder == "own" ? root / "scenes" : root / ".." / "shared" / "scenes" / scene.folder;
    return folder / (scene.name + ".nff");
}

Accuracy accuracy_of(const SceneCase& scene, int side, const NumberSettings& numbers) {
    Diagnostics diagnostics;
    const Scene read = load_scene(path_of(scene), std::nullopt, diagnostics);
    PictureSettings settings;
    settings.width = settings.height = side;
    settings.numbers = numbers;
    const CellScene placed = place_scene(read, place_frame(read, settings), settings);
    const TruthRenderer truth(placed, {settings.max_depth, settings.min_weight});
    const ClassicalExterior exterior(placed, truth);
    UntimedMachine machine(placed, settings, &exterior);
    const TruthRenderer polygons(placed,
                                 {settings.max_depth, settings.min_weight, false, TruthOf::polygons, &truth});
    return compare(machine.render(), polygons.render());
}

Accuracy in_words(const SceneCase& scene, int side, int word_bits) {
    NumberSettings numbers;
    numbers.word_bits = word_bits;
    return accuracy_of(scene, side, numbers);
}

class WholeScenes : public ::testing::TestWithParam<SceneCase> {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(path_of(GetParam())))
            GTEST_SKIP() << path_of(GetParam()) << " is missing";
    }
};

TEST_P(WholeScenes, HaveNoOtherFirstHitThanTheTruthInExactArithmetic) {
    NumberSettings exact;
    exact.arithmetic = Numbers::exact;
    for (const int side : {16, 31, 32, 64, 100}) {
        const Accuracy accuracy = accuracy_of(GetParam(), side, exact);
        EXPECT_EQ(accuracy.wrong_hit_percent, 0) << side << " cells a side";
        EXPECT_GE(accuracy.psnr_db, 100) << side << " cells a side";
    }
}

/// Scenes without edges through pixel centres, which no word length can settle.
class WholeScenesInWords : public WholeScenes {};

TEST_P(WholeScenesInWords, GainWithEveryFourBitsAndComeWithinReachOfTheTruth) {
    double before = 0;
    for (const int word_bits : {20, 24, 28, 32}) {
        const double psnr = in_words(GetParam(), 32, word_bits).psnr_db;
        EXPECT_GE(psnr, std::min(before, 199.0)) << word_bits << " bits";
        before = psnr;
    }
    EXPECT_GE(before, 90);
}

std::vector<SceneCase> settled_by_words() {
    std::vector<SceneCase> settled;
    for (const SceneCase& scene : scenes) {
        if (!scene.edges_on_pixels) settled.push_back(scene);
    }
    return settled;
}

const auto name_of_case = [](const auto& about) {
    std::string name = about.param.name;
    for (char& c : name) c = c == '-' ? '_' : c;
    return name;
};
INSTANTIATE_TEST_SUITE_P(All, WholeScenes, ::testing::ValuesIn(scenes), name_of_case);
INSTANTIATE_TEST_SUITE_P(All, WholeScenesInWords, ::testing::ValuesIn(settled_by_words()), name_of_case);

TEST(TotalReflection, KeepsAGlassBoxWithoutKsFromBeingBlack) {
    const SceneCase scene{"found", "tir_black"};
    if (!std::filesystem::exists(path_of(scene))) GTEST_SKIP() << path_of(scene) << " is missing";
    Diagnostics diagnostics;
    const Scene read = load_scene(path_of(scene), std::nullopt, diagnostics);
    PictureSettings settings;
    settings.width = settings.height = 32;
    const CellScene placed = place_scene(read, place_frame(read, settings), settings);
    const Picture truth = TruthRenderer(placed, {settings.max_depth, settings.min_weight}).render();
    double darkest = 1;
    for (const Pixel& pixel : truth.pixels) darkest = std::min(darkest, pixel.colour.r);
    EXPECT_GT(darkest, 0.9) << "white surroundings";
    EXPECT_GE(in_words(scene, 32, 20).psnr_db, 60);
}

}  // namespace
}  // namespace raycell
