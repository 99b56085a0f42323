// Tessellation by need: the accuracy that is asked for is reached, and no finer than it must be.
#include "model/truth/fineness.hpp"

#include <gtest/gtest.h>

#include "model/picture/compare.hpp"
#include "model/truth/truth.hpp"
#include "scenes/nff_reader.hpp"

namespace raycell {
namespace {

/// A mirror, a glass and a matt ball, and a cone, on a floor.
Scene four_objects() {
    Diagnostics diagnostics;
    return read_nff_text(
        "b .2 .3 .5 v from 1 -9 4 at 0 0 1 up 0 0 1 angle 30 hither 1 resolution 9 9 l 5 -6 9 l -6 -3 5 "
        "f .8 .7 .6 .9 0 20 0 1 p 4 -4 -4 0 4 -4 0 4 4 0 -4 4 0 "
        "f .9 .9 1 .1 .9 60 0 1 s -1.5 0 1 1 f 1 1 1 .1 .1 60 .9 1.5 s .2 -2 .7 .6 "
        "f .9 .2 .1 .8 0 9 0 1 s 1.6 -.5 .8 .8 f .1 .6 .2 .8 0 9 0 1 c .4 1.2 0 .7 .4 1.2 2 .2 ",
        "four objects", diagnostics);
}

PictureSettings asking_for(double psnr_db, int side = 96) {
    PictureSettings settings;
    settings.width = settings.height = side;
    settings.tessellate_for = psnr_db;
    return settings;
}

TEST(TessellateFor, GivesThePolygonsTheAccuracyThatIsAskedForAndLittleMore) {
    const Scene scene = four_objects();
    std::size_t fewer = 0;
    for (const double goal : {36.0, 40.0, 44.0}) {
        const PictureSettings settings = asking_for(goal);
        const Frame frame = place_frame(scene, settings);
        const Fineness fineness = fineness_for(scene, frame, settings);
        const CellScene placed = place_scene(scene, frame, settings, fineness.chord_errors);
        const TruthRenderer itself(placed);
        const TruthRenderer polygons(placed, {4, 1.0 / 256, false, TruthOf::polygons, &itself});
        const double psnr = compare(polygons.render(), itself.render()).psnr_db;
        EXPECT_TRUE(fineness.reached);
        EXPECT_NEAR(psnr, fineness.psnr_db, 1e-6) << "it looks at every pixel of so small a picture";
        EXPECT_GE(psnr, goal - 0.5);
        EXPECT_LE(psnr, goal + 6);
        EXPECT_GT(placed.polygons.size(), fewer);
        fewer = placed.polygons.size();
    }
}

TEST(TessellateFor, SaysWhatItCantReach) {
    const Scene scene = four_objects();
    const PictureSettings settings = asking_for(100, 24);
    const Fineness fineness = fineness_for(scene, place_frame(scene, settings), settings);
    if (fineness.psnr_db < 99.5) {
        EXPECT_FALSE(fineness.reached);
    }
    for (const double error : fineness.chord_errors) EXPECT_GE(error, finest_chord_error);
}

TEST(TessellateFor, MakesConesFinerThanSpheresAndNoneTooFineOrTooCoarse) {
    const Scene scene = four_objects();
    const PictureSettings settings = asking_for(40);
    const Frame frame = place_frame(scene, settings);
    const std::vector<double> errors = chord_errors_at(scene, frame, 0.05, 0.001);
    ASSERT_EQ(errors.size(), 5u);
    for (const std::size_t sphere : {1, 2, 3}) EXPECT_EQ(errors[sphere], 0.05) << "whatever it is made of";
    EXPECT_LT(errors[4], 0.05);
    for (const double level : {1e-6, 10.0}) {
        for (const double error : chord_errors_at(scene, frame, level, 0.002)) {
            EXPECT_GE(error, 0.002);
            EXPECT_LE(error, coarsest_chord_error);
        }
    }
}

TEST(TessellateFor, MakesNoFacetsThatWordsCantTellApart) {
    const Scene scene = four_objects();
    PictureSettings settings = asking_for(40);
    const Frame frame = place_frame(scene, settings);
    EXPECT_LT(told_chord_error(frame, settings), finest_chord_error) << "20 bits";
    settings.numbers.word_bits = 8;
    EXPECT_GT(told_chord_error(frame, settings), 0.02);
    settings.tessellate_for = 60;
    for (const double error : fineness_for(scene, frame, settings).chord_errors)
        EXPECT_GE(error, told_chord_error(frame, settings));
    settings.numbers.arithmetic = Numbers::exact;
    EXPECT_EQ(told_chord_error(frame, settings), 0);
}

TEST(TessellateFor, LeavesASceneWithoutCurvedObjectsAlone) {
    Diagnostics diagnostics;
    const Scene flat = read_nff_text(
        "v from 0 -9 0 at 0 0 0 up 0 0 1 angle 30 hither 1 resolution 9 9 l 5 -6 9 f .8 .7 .6 .9 0 20 0 1 "
        "p 3 -1 0 -1 1 0 -1 0 0 1 ",
        "flat", diagnostics);
    const PictureSettings settings = asking_for(60);
    const Fineness fineness = fineness_for(flat, place_frame(flat, settings), settings);
    EXPECT_TRUE(fineness.chord_errors.empty());
    EXPECT_TRUE(fineness.reached);
}

}  // namespace
}  // namespace raycell
