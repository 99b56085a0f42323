// The published counts of the Standard Procedural Databases (Haines, 512 × 512 pixels, rays through their
// corners).
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "model/truth/truth.hpp"
#include "scenes/nff_reader.hpp"

namespace raycell {
namespace {

struct Published {
    const char* file;
    double eye_hits, reflected, refracted, shadow;
};

void PrintTo(const Published& published, std::ostream* out) { *out << published.file; }

class SpdCounts : public ::testing::TestWithParam<Published> {};

TEST_P(SpdCounts, TheTruthSendsAsManyRaysAsPublishedWithinTwoPercent) {
    const Published& published = GetParam();
    const auto path =
        std::filesystem::path(RAYCELL_SOURCE_DIR) / ".." / "shared" / "scenes" / "spd" / published.file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
    Diagnostics diagnostics;
    const Scene scene = read_nff(path, diagnostics);
    PictureSettings settings;
    settings.width = settings.height = 512;
    settings.chord_error = 0.5;  // few polygons: they are not what is met
    const CellScene placed = place_scene(scene, place_frame(scene, settings), settings);
    const TruthCounts counts = TruthRenderer(placed).count(513);
    EXPECT_EQ(counts.eye, 513u * 513u);
    EXPECT_NEAR(double(counts.eye_hits), published.eye_hits, 0.02 * published.eye_hits);
    EXPECT_NEAR(double(counts.reflected), published.reflected, 0.02 * published.reflected);
    EXPECT_NEAR(double(counts.shadow), published.shadow, 0.02 * published.shadow);
    // Whether a ray is transmitted or totally reflected depends on the last bits of the many equal angles of
    // gears.
    EXPECT_NEAR(double(counts.refracted), published.refracted, 0.04 * published.refracted);
}

INSTANTIATE_TEST_SUITE_P(Haines, SpdCounts,
                         ::testing::Values(Published{"balls-s4.nff", 263169, 175095, 0, 954368},
                                           Published{"gears-s4.nff", 245086, 304643, 207564, 2246955},
                                           Published{"tetra-s6.nff", 49788, 0, 0, 46112}),
                         [](const auto& about) { return std::string(about.param.file).substr(0, 5); });

}  // namespace
}  // namespace raycell
