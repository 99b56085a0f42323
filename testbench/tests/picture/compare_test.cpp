#include "model/picture/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace raycell {
namespace {

Picture grey(int width, int height, double value) {
    Picture picture(width, height);
    for (Pixel& pixel : picture.pixels) {
        pixel.colour = dvec3(value);
        pixel.polygon = 3;
    }
    return picture;
}

TEST(Compare, EqualPicturesHaveNoErrorAndTwoHundredDecibels) {
    const Accuracy accuracy = compare(grey(4, 3, 0.4), grey(4, 3, 0.4));
    EXPECT_EQ(accuracy.psnr_db, 200);
    EXPECT_EQ(accuracy.rmse, 0);
    EXPECT_EQ(accuracy.max_error, 0);
    EXPECT_EQ(accuracy.off_by_1_255_percent, 0);
    EXPECT_EQ(accuracy.off_by_0_1_percent, 0);
    EXPECT_EQ(accuracy.wrong_hit_percent, 0);
}

TEST(Compare, ATenthOffEverywhereIsTwentyDecibels) {
    const Accuracy accuracy = compare(grey(4, 3, 0.5), grey(4, 3, 0.4));
    EXPECT_NEAR(accuracy.psnr_db, 20, 1e-9);
    EXPECT_NEAR(accuracy.rmse, 0.1, 1e-12);
    EXPECT_EQ(accuracy.off_by_1_255_percent, 100);
    EXPECT_EQ(accuracy.off_by_0_1_percent, 0);  // not more than 0.1
}

TEST(Compare, OneChannelOfOnePixelCountsAsATwelfthOfTheSquaresAndAQuarterOfThePixels) {
    Picture test = grey(2, 2, 0.25);
    test.at(1, 0).colour.g = 0.75;
    const Accuracy accuracy = compare(test, grey(2, 2, 0.25));
    EXPECT_NEAR(accuracy.rmse, std::sqrt(0.25 / 12), 1e-15);
    EXPECT_EQ(accuracy.max_error, 0.5);
    EXPECT_EQ(accuracy.off_by_0_1_percent, 25);
}

TEST(Compare, OneStepOfAnEightBitPictureIsNotOffByMoreThanAStep) {
    for (int step = 0; step < 255; ++step)
        EXPECT_EQ(compare(grey(1, 1, step / 255.0), grey(1, 1, (step + 1) / 255.0)).off_by_1_255_percent, 0);
    EXPECT_EQ(compare(grey(1, 1, 0), grey(1, 1, 2 / 255.0)).off_by_1_255_percent, 100);
}

TEST(Compare, ColoursBeyondWhatIsShownAreEqual) {
    EXPECT_EQ(compare(grey(2, 2, 1.5), grey(2, 2, 7)).rmse, 0);
    EXPECT_EQ(compare(grey(2, 2, -1), grey(2, 2, 0)).rmse, 0);
    EXPECT_EQ(compare(grey(2, 2, std::numeric_limits<double>::infinity()), grey(2, 2, 1)).rmse, 0);
}

TEST(Compare, AnotherPolygonSeenIsAWrongHitThoughItLooksTheSame) {
    Picture test = grey(2, 2, 0.5);
    test.at(0, 1).polygon = no_polygon;
    EXPECT_EQ(compare(test, grey(2, 2, 0.5)).wrong_hit_percent, 25);
}

TEST(Compare, PicturesOfDifferentSizesAreRefused) {
    EXPECT_THROW(compare(grey(2, 3, 0), grey(3, 2, 0)), std::invalid_argument);
    EXPECT_THROW(difference(grey(2, 3, 0), grey(3, 2, 0)), std::invalid_argument);
    EXPECT_THROW(compare(Picture(), Picture()), std::invalid_argument);
}

TEST(Compare, ANumberThatIsNoneIsReportedWithItsPixel) {
    Picture broken = grey(4, 4, 0.5);
    broken.at(3, 1).normal.y = std::numeric_limits<double>::quiet_NaN();
    for (const bool tested : {true, false}) {
        try {
            tested ? compare(broken, grey(4, 4, 0.5)) : compare(grey(4, 4, 0.5), broken);
            FAIL();
        } catch (const std::domain_error& error) {
            EXPECT_NE(std::string(error.what()).find("(3, 1)"), std::string::npos) << error.what();
        }
    }
}

TEST(Compare, TheDifferenceImageShowsTheClampedErrorAmplified) {
    Picture test = grey(2, 1, 0.25);
    test.at(1, 0).colour = {0.5, 3, 0.25};
    const Picture picture = difference(test, grey(2, 1, 0.25), 4);
    EXPECT_EQ(picture.at(0, 0).colour, dvec3(0));
    EXPECT_EQ(picture.at(1, 0).colour, dvec3(1, 3, 0));
}

}  // namespace
}  // namespace raycell
