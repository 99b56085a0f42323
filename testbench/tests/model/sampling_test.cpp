// The samples of a pixel: where they lie, and what is added up of them.
#include "model/geometry/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

#include "model/tracing/pixel_sum.hpp"
#include "testbench/tests/property.hpp"

namespace raycell {
namespace {

/// Share of the unit square in which n · p < offset, exactly: the integral of a clamped line, piece by piece.
double coverage(const dvec2& n, double offset) {
    if (std::abs(n.x) < std::abs(n.y)) return coverage({n.y, n.x}, offset);
    const auto at = [&](double y) { return (offset - n.y * y) / n.x; };
    std::vector<double> ends = {0, 1};
    for (const double x : {0.0, 1.0}) {
        const double y = n.y == 0 ? -1 : (offset - n.x * x) / n.y;
        if (y > 0 && y < 1) ends.push_back(y);
    }
    std::sort(ends.begin(), ends.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const double middle = std::clamp(at((ends[i] + ends[i + 1]) / 2), 0.0, 1.0);
        sum += (ends[i + 1] - ends[i]) * middle;
    }
    return n.x > 0 ? sum : 1 - sum;
}

double covered(const dvec2& n, double offset, int samples) {
    int inside = 0;
    for (int k = 0; k < samples; ++k)
        inside += glm::dot(n, sample_place(k, samples, PixelFilter::box)) < offset;
    return double(inside) / samples;
}

TEST(Samples, OneLiesInTheMiddleWithEitherFilter) {
    for (const PixelFilter filter : {PixelFilter::box, PixelFilter::tent})
        EXPECT_EQ(sample_place(0, 1, filter), dvec2(0.5, 0.5));
}

TEST(Samples, OfAPowerOfTwoHaveOneInEachRowColumnAndBox) {
    for (int samples = 2; samples <= 256; samples *= 2) {
        for (int across = 1; across <= samples; across *= 2) {
            std::set<std::pair<int, int>> boxes;
            for (int k = 0; k < samples; ++k) {
                const dvec2 at = sample_place(k, samples, PixelFilter::box);
                boxes.insert({int(at.x * across), int(at.y * (samples / across))});
            }
            EXPECT_EQ(boxes.size(), std::size_t(samples)) << samples << " samples, " << across << " across";
        }
    }
}

TEST(Samples, TheFirstFourLieInAQuarterEachAroundTheMiddle) {
    for (int samples = 4; samples <= 64; ++samples) {
        std::set<std::pair<int, int>> quarters;
        dvec2 mean(0);
        for (int k = 0; k < first_samples; ++k) {
            const dvec2 at = sample_place(k, samples, PixelFilter::box);
            quarters.insert({int(at.x * 2), int(at.y * 2)});
            mean += at / double(first_samples);
        }
        EXPECT_EQ(quarters.size(), 4u);
        EXPECT_LE(glm::length(mean - 0.5), samples > 4 ? 0.1 : 1e-12) << samples;
    }
}

TEST(Samples, OfATentLieInThePixelSymmetricallyAndCloserToItsMiddle) {
    double box = 0, tent = 0;
    dvec2 mean(0);
    for (int k = 0; k < 256; ++k) {
        const dvec2 at = sample_place(k, 256, PixelFilter::tent);
        EXPECT_TRUE(at.x > 0 && at.x < 1 && at.y > 0 && at.y < 1);
        mean += at / 256.0;
        tent += std::pow(at.x - 0.5, 2) / 256;
        box += std::pow(sample_place(k, 256, PixelFilter::box).x - 0.5, 2) / 256;
    }
    EXPECT_NEAR(mean.x, 0.5, 1e-12);
    EXPECT_NEAR(mean.y, 0.5, 1e-12);
    EXPECT_NEAR(box, 1.0 / 12, 1e-4);
    EXPECT_NEAR(tent, 1.0 / 24, 1e-4) << "the variance of a tent over (0, 1)";
}

// Sixteen samples know sixteenths. An edge that moves by a sixteenth from row to row, and by whole ones
// from pixel to pixel, covers just that: the samples must not miss by another one.
TEST(Samples, SixteenCountAnEdgeThatCoversSixteenthsWithin64thsInEveryPixel) {
    double worst = 0;
    for (const int sign : {1, -1}) {
        for (const bool turned : {false, true}) {
            for (int row = -16; row <= 32; ++row) {
                const dvec2 across(1, sign / 16.0);
                const dvec2 n = turned ? dvec2(across.y, across.x) : across;
                const double offset = row / 16.0 + sign / 32.0;
                worst = std::max(worst, std::abs(covered(n, offset, 16) - coverage(n, offset)));
            }
        }
    }
    std::cout << "largest error " << worst << '\n';
    EXPECT_LE(worst, 1.0 / 64);
}

TEST(Samples, OfAnyEdgeComeNearerTheMoreThereAre) {
    property::Random random(7);
    std::cout << "seed 7\n";
    double before = 1;
    for (const auto& [samples, rms_allowed] :
         {std::pair(4, 0.13), std::pair(16, 0.052), std::pair(64, 0.017)}) {
        double squares = 0, worst = 0;
        constexpr int edges = 4000;
        for (int i = 0; i < edges; ++i) {
            const double angle = random.uniform(0, 6.283185307179586);
            const dvec2 n(std::cos(angle), std::sin(angle));
            const double offset = glm::dot(n, dvec2(random.uniform(0, 1), random.uniform(0, 1)));
            const double error = covered(n, offset, samples) - coverage(n, offset);
            squares += error * error / edges;
            worst = std::max(worst, std::abs(error));
        }
        std::cout << samples << " samples: rms " << std::sqrt(squares) << ", largest " << worst << '\n';
        EXPECT_LE(std::sqrt(squares), rms_allowed);
        EXPECT_LT(std::sqrt(squares), before / 2);
        before = std::sqrt(squares);
    }
}

// ---- the sum

TEST(PixelSum, IsTheSameInEveryOrder) {
    property::Random random(3);
    for (const Arithmetic& arithmetic : {Arithmetic(), Arithmetic(NumberSettings(), ArrayExtent())}) {
        std::vector<dvec3> intensities(64);
        for (dvec3& each : intensities) {
            each =
                arithmetic.hold(arithmetic.formats().intensity,
                                dvec3(random.uniform(0, 7.9), random.uniform(0, 1), random.uniform(0, 1e-3)));
        }
        const auto mean = [&] {
            PixelSum sum;
            for (const dvec3& each : intensities) sum.add(each, arithmetic);
            return sum.mean(arithmetic);
        };
        const dvec3 first = mean();
        std::reverse(intensities.begin(), intensities.end());
        EXPECT_EQ(mean(), first);
        std::swap(intensities[3], intensities[40]);
        EXPECT_EQ(mean(), first);
    }
}

TEST(PixelSum, HasAMeanThatIsRoundedOnce) {
    const Arithmetic words{NumberSettings(), ArrayExtent()};
    const double step = words.formats().intensity.step();
    PixelSum sum;
    for (const double each : {1.0, 1.0, 3.0}) sum.add(dvec3(each * step), words);
    EXPECT_EQ(sum.mean(words), dvec3(2 * step)) << "5/3";
    sum.add(dvec3(3 * step), words);
    EXPECT_EQ(sum.mean(words), dvec3(2 * step));
    PixelSum full;
    for (int k = 0; k < most_samples; ++k) full.add(dvec3(words.formats().intensity.most()), words);
    EXPECT_EQ(full.mean(words), dvec3(words.formats().intensity.most())) << "nothing overflows";
}

TEST(PixelSum, IsCompleteEarlyOnlyWhereTheFirstFourAgreeInEveryComponent) {
    const Arithmetic words{NumberSettings(), ArrayExtent()};
    PictureSettings settings;
    settings.samples = 16;
    settings.sample_until = 0.25;
    const auto complete_after = [&](const dvec3& odd, int place) {
        PixelSum sum;
        for (int k = 0;; ++k) {
            sum.add(k == place ? odd : dvec3(0.5), words);
            if (is_complete(sum, settings, words)) return sum.count();
        }
    };
    EXPECT_EQ(complete_after(dvec3(0.5), 0), 4);
    EXPECT_EQ(complete_after(dvec3(0.75), 2), 4) << "just within";
    EXPECT_EQ(complete_after(dvec3(0.75, 0.5, 0.76), 3), 16);
    EXPECT_EQ(complete_after(dvec3(0.5, 0.2, 0.5), 0), 16);
    EXPECT_EQ(complete_after(dvec3(7), 4), 4) << "the fifth is not sent";
    settings.sample_until = -1;
    EXPECT_EQ(complete_after(dvec3(0.5), 0), 16);
    settings.sample_until = 0.25;
    settings.samples = 3;
    EXPECT_EQ(complete_after(dvec3(0.5), 0), 3);
}

}  // namespace
}  // namespace raycell
