// In fixed arithmetic, too, the timed machine's picture equals the untimed one's, bit for bit, at every word
// length and with every operator method.
#include "elaboration.hpp"

namespace raycell {
namespace {

struct Case {
    std::string name;
    std::string scene;
    NumberSettings numbers;
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

class FixedPicture : public ::testing::TestWithParam<Case> {};

/// Scenes with mirrors, glass and shadows; word lengths and array shapes differ from case to case.
TEST_P(FixedPicture, IsTheSameTimedAndUntimed) {
    expect_first_elaboration();
    const Case& each = GetParam();
    PictureSettings settings;
    settings.width = 12 + each.numbers.word_bits % 7;
    settings.height = 24 - each.numbers.word_bits % 5;
    settings.numbers = each.numbers;
    settings.shadows = Shadows(each.numbers.word_bits % 3);
    settings.hit = each.numbers.word_bits % 4 == 3 ? HitTest::mask : HitTest::edge;
    const auto placed = place_own_scene(each.scene, settings);
    UntimedMachine untimed(placed->scene, settings, placed->exterior.get());
    const Picture golden = untimed.render();
    Machine timed("machine", placed->scene, settings, MachineSettings(), placed->exterior.get());
    const RunResult result = timed.run();
    EXPECT_EQ(name_of(result.verdict), std::string("completed"));
    EXPECT_EQ(image_hash(result.picture), image_hash(golden));
    const RayCounts& a = result.counters.rays;
    const RayCounts& b = untimed.rays();
    EXPECT_EQ(a.reflected, b.reflected);
    EXPECT_EQ(a.refracted, b.refracted);
    EXPECT_EQ(a.shadow, b.shadow);
    EXPECT_EQ(a.precast, b.precast);
    if (each.scene == "still_life") {
        EXPECT_GT(a.reflected, 0u);
        EXPECT_GT(a.refracted, 0u);
        EXPECT_GT(a.shadow + a.precast, 0u);
    }
    const Format& word = untimed.context().arithmetic.formats().intensity;
    for (const Pixel& pixel : golden.pixels) {
        for (int channel = 0; channel < 3; ++channel) {
            ASSERT_EQ(pixel.colour[channel], word.hold(pixel.colour[channel])) << "what comes home is a word";
        }
    }
    // The fixed picture must differ from the exact one.
    settings.numbers.arithmetic = Numbers::exact;
    UntimedMachine exact(placed->scene, settings, placed->exterior.get());
    EXPECT_NE(image_hash(exact.render()), image_hash(golden));
}

std::vector<Case> every_width() {
    std::vector<Case> cases;
    for (int word_bits = 8; word_bits <= 32; ++word_bits) {
        for (const std::string scene : {"still_life", "facing_mirrors"}) {
            NumberSettings numbers;
            numbers.word_bits = word_bits;
            numbers.rounding = scene == "still_life" ? Rounding::nearest : Rounding::truncate;
            cases.push_back({scene + "_" + std::to_string(word_bits) + "_bits", scene, numbers});
        }
    }
    return cases;
}

std::vector<Case> every_operator() {
    std::vector<Case> cases;
    const std::vector<std::pair<std::string, Iteration>> iterations = {
        {"newton", Iteration::newton}, {"table", Iteration::table}, {"rounded", Iteration::rounded}};
    const std::vector<std::pair<std::string, PowerMethod>> powers = {{"tables", PowerMethod::tables},
                                                                     {"schlick", PowerMethod::schlick},
                                                                     {"rounded", PowerMethod::rounded}};
    for (const Rounding rounding : {Rounding::nearest, Rounding::truncate}) {
        const std::string end = rounding == Rounding::nearest ? "" : "_truncated";
        const auto add = [&](const std::string& name, const OperatorSettings& operators) {
            cases.push_back({name + end, "still_life", {Numbers::fixed, 20, rounding, operators}});
        };
        for (const auto& [name, method] : iterations) {
            OperatorSettings operators;
            operators.reciprocal = method;
            add("reciprocal_" + name, operators);
            operators = OperatorSettings();
            operators.root = method;
            add("root_" + name, operators);
        }
        for (const auto& [name, method] : powers) {
            OperatorSettings operators;
            operators.power = method;
            add("power_" + name, operators);
        }
        add("small_tables", {Iteration::table, Iteration::table, PowerMethod::tables, 4, 4, 4});
        add("large_tables", {Iteration::table, Iteration::table, PowerMethod::tables, 4096, 4096, 4096});
    }
    return cases;
}

const auto name_of_case = [](const auto& test) { return test.param.name; };
INSTANTIATE_TEST_SUITE_P(Width, FixedPicture, ::testing::ValuesIn(every_width()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Operators, FixedPicture, ::testing::ValuesIn(every_operator()), name_of_case);

}  // namespace
}  // namespace raycell
