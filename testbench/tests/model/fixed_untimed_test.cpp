// Pictures in fixed-point words: every value is finite, every run ends, and more bits come nearer to exact.
#include <map>

#include "model/machine/untimed.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

NumberSettings any_words(Random& random, int word_bits) {
    NumberSettings numbers;
    numbers.word_bits = word_bits;
    numbers.rounding = random.chance(0.5) ? Rounding::nearest : Rounding::truncate;
    numbers.operators.reciprocal = Iteration(random.whole(0, 2));
    numbers.operators.root = Iteration(random.whole(0, 2));
    numbers.operators.power = PowerMethod(random.whole(0, 2));
    numbers.operators.reciprocal_table = 1 << random.whole(2, 12);
    numbers.operators.root_table = 1 << random.whole(2, 12);
    numbers.operators.power_table = 1 << random.whole(2, 12);
    return numbers;
}

/// Every intensity is a word of its format and not negative.
void expect_intensities(const Picture& picture, const Format& word) {
    for (const Pixel& pixel : picture.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            const double value = pixel.colour[channel];
            ASSERT_GE(value, 0);
            ASSERT_LE(value, word.most());
            ASSERT_EQ(value, word.hold(value)) << "no word";
        }
        ASSERT_TRUE(pixel.polygon == no_polygon || std::isfinite(pixel.depth));
        ASSERT_TRUE(std::isfinite(pixel.normal.x + pixel.normal.y + pixel.normal.z));
    }
}

TEST(FixedPictures, AreMadeOfIntensitiesAtEveryWidthRungAndShadowMode) {
    for (const std::uint64_t seed : property::seeds(1, 10)) {
        for (int word_bits = 8; word_bits <= 32; ++word_bits) {
            SCOPED_TRACE(property::rerun(seed));
            Random random(seed * 100 + std::uint64_t(word_bits));
            const CellScene scene = shapes::still_life(random);
            PictureSettings settings =
                shapes::settings_for(scene, HitTest((word_bits + int(seed)) % 5), Numbers::fixed);
            settings.numbers = any_words(random, word_bits);
            settings.shadows = Shadows(random.whole(0, 2));
            settings.normals = Normals(random.whole(0, 1));
            settings.max_depth = random.whole(0, 8);
            settings.min_weight = random.chance(0.5) ? 1.0 / 256 : 0;
            SCOPED_TRACE(std::to_string(word_bits) + " bits, rung " + std::to_string(int(settings.hit)) +
                         ", shadows " + std::to_string(int(settings.shadows)));
            UntimedMachine machine(scene, settings, nullptr);
            expect_intensities(machine.render(), machine.context().arithmetic.formats().intensity);
        }
    }
}

TEST(FixedPictures, SurviveScenesThatNoWordCanHold) {
    for (const std::uint64_t seed : property::seeds(500, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        CellScene scene = shapes::still_life(random);
        for (Material& material : scene.objects) {
            if (random.chance(0.3)) material.colour *= random.chance(0.5) ? 1e6 : 1e-6;
            if (random.chance(0.3)) material.ior = random.chance(0.5) ? 100 : 1e-3;
            if (random.chance(0.3)) material.shine = random.chance(0.5) ? 1e9 : 1e-9;
            if (random.chance(0.3)) material.specular = random.uniform(0, 50);
            if (random.chance(0.3)) material.transmit = random.uniform(0, 50);
        }
        for (Source& source : scene.sources) {
            if (random.chance(0.3)) source.position *= random.chance(0.5) ? 1e8 : 0.0;
            if (random.chance(0.3)) source.intensity *= 1e5;
        }
        scene.background *= random.chance(0.3) ? 1e4 : 1.0;
        PictureSettings settings = shapes::settings_for(scene, HitTest(random.whole(0, 4)), Numbers::fixed);
        settings.numbers = any_words(random, random.whole(8, 32));
        settings.shadows = Shadows(random.whole(0, 2));
        UntimedMachine machine(scene, settings, nullptr);
        expect_intensities(machine.render(), machine.context().arithmetic.formats().intensity);
    }
}

/// The scene with features that 8-bit words represent exactly, so that only the arithmetic differs. (Features
/// have 12 bits, and fewer only in shorter words.)
CellScene with_features_of_words(CellScene scene) {
    const Arithmetic least({Numbers::fixed, 8, Rounding::nearest, {}}, extent_of(scene.frame));
    for (Material& material : scene.objects) material = hold(material, least);
    return scene;
}

TEST(FixedPictures, ComeNearerToTheExactOneWithEveryFourBits) {
    for (const Rounding rounding : {Rounding::nearest, Rounding::truncate}) {
        std::map<int, double> error;  // mean error of a pixel
        std::size_t pixels = 0;
        for (const std::uint64_t seed : property::seeds(1000, 30)) {
            Random random(seed);
            const CellScene scene = with_features_of_words(shapes::still_life(random));
            PictureSettings settings = shapes::settings_for(scene, HitTest::edge, Numbers::exact);
            const Picture exact = UntimedMachine(scene, settings, nullptr).render();
            pixels += exact.pixels.size();
            settings.numbers.arithmetic = Numbers::fixed;
            settings.numbers.rounding = rounding;
            for (const int word_bits : {8, 12, 16, 20, 24}) {
                settings.numbers.word_bits = word_bits;
                const Picture words = UntimedMachine(scene, settings, nullptr).render();
                for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
                    error[word_bits] += glm::length(exact.pixels[i].colour - words.pixels[i].colour);
                }
            }
        }
        for (auto& [word_bits, sum] : error) sum /= double(pixels);
        std::string all;
        for (const auto& [word_bits, mean] : error)
            all += std::to_string(word_bits) + ": " + std::to_string(mean) + "  ";
        if (property::seeds(0, 2).size() < 2) return;
        EXPECT_LT(error[12], error[8] / 4) << all;
        EXPECT_LT(error[16], error[12] / 4) << all;
        EXPECT_LT(error[20], error[16] / 4) << all;
        EXPECT_LT(error[24], error[20] / 4) << all;
        EXPECT_LT(error[20], 1e-4) << all;
        RecordProperty("mean_errors", all);
    }
}

}  // namespace
}  // namespace raycell
