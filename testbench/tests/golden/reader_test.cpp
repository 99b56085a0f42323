// Golden vectors as text: a round trip loses nothing, and errors name their line.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>

#include "../property.hpp"
#include "testbench/golden/file.hpp"
#include "testbench/golden/messages.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {
namespace {

NumberSettings words_of(int bits) {
    NumberSettings settings;
    settings.word_bits = bits;
    return settings;
}

double drawn(const Arithmetic& arithmetic, const Format& format, property::Random& random) {
    const double x = random.uniform(format.least(), format.most());
    return arithmetic.hold(format, random.chance(0.1) ? 0 : x);
}

dvec3 drawn_vector(const Arithmetic& arithmetic, const Format& format, property::Random& random) {
    const double x = drawn(arithmetic, format, random), y = drawn(arithmetic, format, random);
    return {x, y, drawn(arithmetic, format, random)};
}

/// A machine whose messages have room for all that is drawn.
MachineSettings drawn_machine() {
    MachineSettings machine;
    machine.ray_store = 100;
    return machine;
}
/// The context of a large array with these numbers, and its packing.
struct Wires {
    explicit Wires(const NumberSettings& numbers, PictureSettings more = {})
        : picture(picture_of(numbers, more)), context(scene, picture), packing(context, drawn_machine()) {}
    static PictureSettings picture_of(const NumberSettings& numbers, PictureSettings picture) {
        picture.width = picture.height = 4096;
        picture.numbers = numbers;
        return picture;
    }
    static CellScene empty_scene() {
        CellScene scene;
        scene.frame.width = scene.frame.height = 4096;
        scene.frame.depth = 200;
        scene.objects.emplace_back();
        return scene;
    }
    CellScene scene = empty_scene();
    PictureSettings picture;
    Context context;
    Packing packing;
    const Arithmetic& arithmetic() const { return context.arithmetic; }
};

Ray drawn_ray(const Arithmetic& arithmetic, property::Random& random) {
    const Formats& f = arithmetic.formats();
    Ray ray;
    ray.id = random.engine()();
    ray.kind = RayKind(random.whole(0, 3));
    const bool primary = ray.kind == RayKind::primary;
    if (!primary) ray.generation = std::uint8_t(random.whole(1, 63));
    ray.home_x = std::uint16_t(random.whole(0, 4095));
    ray.home_y = std::uint16_t(random.whole(0, 4095));
    if (!primary) ray.slot = std::uint32_t(random.whole(0, 99));
    if (ray.kind == RayKind::refracted) ray.child = 1;
    if (is_shadow(ray.kind)) ray.child = std::uint8_t(random.whole(0, 63));
    ray.position = drawn_vector(arithmetic, f.unit, random);
    set_direction(ray, drawn_vector(arithmetic, f.unit, random), arithmetic);
    ray.weight = drawn(arithmetic, f.unit, random);
    if (random.chance(0.5)) ray.reach = arithmetic.hold_reach(random.uniform(0, 1e6));
    ray.leaves = random.chance(0.3) ? no_polygon : std::uint32_t(random.whole(0, (1 << 20) - 2));
    ray.leaves_front = random.chance(0.5);
    ray.fresh = random.chance(0.5);
    ray.outside = random.chance(0.5);
    return ray;
}

LoadItem drawn_span(const Arithmetic& arithmetic, property::Random& random) {
    const Format& f = arithmetic.formats().loading;
    LoadItem item;
    item.kind = LoadItem::Kind::span;
    Span& span = item.span;
    span.polygon = std::uint32_t(random.whole(0, (1 << 20) - 1));
    span.x = random.whole(0, 4095);
    span.last = random.whole(0, 4095);
    span.drop = random.whole(0, 2);
    span.object = std::uint32_t(random.whole(0, 100));
    span.plane.n = drawn_vector(arithmetic, arithmetic.formats().unit, random);
    span.plane.n[span.drop] = random.chance(0.5) ? 1 : -1;
    span.z = drawn(arithmetic, f, random);
    span.dn = drawn_vector(arithmetic, f, random);
    span.normal.du = drawn_vector(arithmetic, f, random);
    span.d_intensity = drawn_vector(arithmetic, f, random);
    span.edge_count = random.whole(0, 4);
    for (int i = 0; i < span.edge_count; ++i) span.edges[std::size_t(i)].c = drawn(arithmetic, f, random);
    return item;
}

/// Exact arithmetic for one draw in four, otherwise words of random length.
Arithmetic drawn_arithmetic(property::Random& random) {
    if (random.chance(0.25)) return {};
    return {words_of(random.whole(8, 32)),
            {random.whole(1, 4096), random.whole(1, 4096), random.uniform(1, 900), 1}};
}

/// Expects text, remarks and bits of a message to be the same after reading and writing it again.
void expect_round_trip(const Wires& wires, const Message& message) {
    const Arithmetic& arithmetic = wires.arithmetic();
    const Words words(arithmetic, wires.picture);
    const Packing& packing = wires.packing;
    MessagePools pools;
    const std::string text = text_of(words, message);
    const std::string remarks = remarks_of(message);
    const Message again = read_message(words, tokens_of(text), tokens_of(remarks), {}, pools);
    EXPECT_EQ(text_of(words, again), text);
    EXPECT_EQ(remarks_of(again), remarks);
    const std::string bits = packing.packed(message);
    EXPECT_EQ(packing.packed(again), bits);
    EXPECT_EQ(bits.empty(), arithmetic.exact());
    if (bits.empty() || message.kind == Message::Kind::load) return;
    EXPECT_EQ(packing.text_of_bits(bits), text) << "words and bits say the same";
}

TEST(GoldenText, WordsOfEveryFormatComeBackBitForBit) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Arithmetic arithmetic(words_of(random.whole(8, 32)), {128, 128, 200, 1});
        const Words words(arithmetic);
        const Formats& f = arithmetic.formats();
        for (const Format* format : {&f.unit, &f.depth, &f.reach, &f.intensity, &f.feature, &f.loading}) {
            const double value = drawn(arithmetic, *format, random);
            const std::string text = words.word(*format, value);
            EXPECT_EQ(text.find('x'), std::string::npos) << "a word is an integer";
            EXPECT_EQ(words.read_word(*format, text), value) << text;
        }
        const double value = arithmetic.reciprocal(drawn(arithmetic, f.unit, random) + 2);
        const std::string text = words.floating(f.word_bits, value);
        EXPECT_NE(text.find(':'), std::string::npos) << text;
        EXPECT_EQ(words.read_floating(f.word_bits, text), value) << text;
    }
}

TEST(GoldenText, WhatIsNoWordIsHexadecimalAndInfinityHasAName) {
    const Arithmetic arithmetic;
    const Words words(arithmetic);
    const Format format(2, 18);
    for (const double value : {0.1, -1.0 / 3, 5e-324, 1.7e308, 0.0}) {
        EXPECT_EQ(words.read_word(format, words.word(format, value)), value);
        EXPECT_EQ(words.read_floating(20, words.floating(20, value)), value);
    }
    EXPECT_EQ(words.word(format, std::numeric_limits<double>::infinity()), "inf");
    EXPECT_EQ(words.read_word(format, "-inf"), -std::numeric_limits<double>::infinity());
}

TEST(GoldenText, NumbersFarOutsideTheirFormatAreRefused) {
    const Arithmetic arithmetic(words_of(20), {64, 64, 150, 1});
    const Words words(arithmetic);
    const Format& format = words.formats().loading;
    for (const char* text : {"inf", "-inf", "0x1p1000", "9007199254740992", "-9007199254740992"})
        EXPECT_THROW(words.read_word(format, text), GoldenError) << text;
    EXPECT_EQ(words.read_word(format, "3"), 3 * format.step());
    EXPECT_TRUE(std::isinf(words.read_reach("inf")));
}

TEST(GoldenText, MessagesComeBackWordForWord) {
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        NumberSettings numbers = words_of(random.whole(8, 32));
        if (random.chance(0.25)) numbers.arithmetic = Numbers::exact;
        PictureSettings picture;
        if (random.chance(0.3)) picture.hit = HitTest::depth;
        if (random.chance(0.5)) picture.normals = Normals::voxel;
        if (random.chance(0.3)) picture.display = Display::gouraud;
        const Wires wires(numbers, picture);
        const Arithmetic& arithmetic = wires.arithmetic();
        RayPacket packet;
        packet.ray = drawn_ray(arithmetic, random);
        expect_round_trip(wires, Message(&packet));
        const bool verdict = is_shadow(packet.ray.kind);
        Answer answer = answer_to(packet.ray, verdict              ? Answer::Kind(random.whole(1, 2))
                                              : random.chance(0.5) ? Answer::Kind::intensity
                                                                   : Answer::Kind::postponed);
        answer.colour = drawn_vector(arithmetic, arithmetic.formats().intensity, random);
        expect_round_trip(wires, Message(&answer));
        LoadItem span = drawn_span(arithmetic, random);
        expect_round_trip(wires, Message(&span));
    }
}

/// A change of the message that the wires do not carry.
template <typename F>
void expect_masked(const Words& words, const Ray& ray, F&& change) {
    RayPacket packet;
    packet.ray = ray;
    const std::string before = text_of(words, Message(&packet));
    change(packet.ray);
    EXPECT_EQ(text_of(words, Message(&packet)), before);
}

TEST(GoldenText, OnlyWhatTheWiresCarryIsInTheWords) {
    for (const std::uint64_t seed : property::seeds(1, 100)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Arithmetic arithmetic = drawn_arithmetic(random);
        const Words words(arithmetic);
        const Ray ray = drawn_ray(arithmetic, random);
        expect_masked(words, ray, [](Ray& r) { r.id += 1; });
        expect_masked(words, ray, [](Ray& r) { r.fresh = !r.fresh; });
        expect_masked(words, ray, [](Ray& r) { r.leaves_front = !r.leaves_front; });
        if (is_shadow(ray.kind)) {
            expect_masked(words, ray, [](Ray& r) { r.generation += 1; });
            expect_masked(words, ray, [](Ray& r) { r.weight /= 2; });
            expect_masked(words, ray, [](Ray& r) { r.kind = RayKind::precast; });
        } else {
            expect_masked(words, ray, [](Ray& r) { r.reach = 1; });
        }
        Answer verdict = answer_to(ray, Answer::Kind::lit);
        const std::string before = text_of(words, Message(&verdict));
        verdict.colour = dvec3(1);
        EXPECT_EQ(text_of(words, Message(&verdict)), before);
    }
}

TEST(GoldenText, TheWordsOfARayAreTheFieldsOfItsLayout) {
    const Wires wires(words_of(20));
    const Words words(wires.arithmetic());
    std::map<std::string, std::vector<std::string>> names;
    for (const std::string& layout : wires.packing.layouts()) {
        const auto tokens = tokens_of(layout);
        for (std::size_t i = 2; i < tokens.size(); ++i)  // after name and type
            names[tokens[0]].push_back(tokens[i].substr(0, tokens[i].find(':')));
    }
    EXPECT_EQ(field_names(words, {"ray"}), names["ray"]);
    EXPECT_EQ(field_names(words, {"shadow_ray"}), names["shadow_ray"]);
    EXPECT_EQ(field_names(words, {"intensity"}), names["intensity"]);
    for (const char* type : {"lit", "blocked", "postponed"})
        EXPECT_EQ(field_names(words, {type}), names["verdict"]);
}

TEST(GoldenText, BitsThatAreNoMessageAreRefused) {
    const Wires wires(words_of(20));
    for (const std::string& bits :
         std::vector<std::string>{"", "0", "g", "0123456789", "c000000000", std::string(200, '0')})
        EXPECT_THROW(wires.packing.text_of_bits(bits), GoldenError) << bits;
    NumberSettings exact;
    exact.arithmetic = Numbers::exact;
    EXPECT_THROW(Wires(exact).packing.text_of_bits("60000000"), GoldenError);
}

TEST(GoldenText, EveryFieldOfAMessageHasAName) {
    const Arithmetic arithmetic;
    const Words words(arithmetic);
    RayPacket packet;
    RayPacket shadow;
    shadow.ray.kind = RayKind::shadow;
    Answer answer;
    Answer verdict;
    verdict.kind = Answer::Kind::lit;
    LoadItem item;
    for (const Message& message :
         {Message(&packet), Message(&shadow), Message(&answer), Message(&verdict), Message(&item)}) {
        const auto tokens = tokens_of(text_of(words, message));
        EXPECT_EQ(field_names(words, tokens).size(), tokens.size() - 1) << tokens[0];
    }
}

TEST(GoldenText, EdgesOfASpanAreNamedThoughTheirNumberVaries) {
    const Arithmetic arithmetic;
    LoadItem item;
    item.kind = LoadItem::Kind::span;
    item.span.edge_count = 2;
    const Words words(arithmetic);
    const auto tokens = tokens_of(text_of(words, Message(&item)));
    const auto names = field_names(words, tokens);
    ASSERT_EQ(names.size(), tokens.size() - 1);
    const auto edges = std::find(names.begin(), names.end(), "edges");
    ASSERT_NE(edges, names.end());
    const std::vector<std::string> behind(edges + 1, names.end());
    EXPECT_EQ(behind, (std::vector<std::string>{"a", "b", "c", "a", "b", "c"}));
}

TEST(GoldenText, AWrongFieldIsNamed) {
    const Arithmetic arithmetic;
    const Words words(arithmetic);
    RayPacket packet;
    const auto tokens = tokens_of(text_of(words, Message(&packet)));
    const auto names = field_names(words, tokens);
    MessagePools pools;
    for (std::size_t i = 1; i < tokens.size(); ++i) {
        auto wrong = tokens;
        wrong[i] = "?";
        try {
            read_message(words, wrong, {}, {}, pools);
            ADD_FAILURE() << names[i - 1];
        } catch (const GoldenError& error) {
            EXPECT_NE(std::strstr(error.what(), ("'" + names[i - 1] + "'").c_str()), nullptr) << error.what();
        }
    }
    EXPECT_THROW(read_message(words, {"ray"}, {}, {}, pools), GoldenError);
    auto longer = tokens;
    longer.push_back("1");
    EXPECT_THROW(read_message(words, longer, {}, {}, pools), GoldenError);
    for (const char* remark : {"pixel x", "branch -1", "pixel"})
        EXPECT_THROW(read_message(words, tokens, tokens_of(remark), {}, pools), GoldenError) << remark;
}

const char* const good =
    "raycell-golden 2\n"
    "config cells = \"3x3\"\n"
    "cell 1 1\n"
    "links east south west north\n"
    "frame 0x1.4p+3 1 0x0p+0 0x0p+0 -0x1p+0\n"
    "beyond 0 0 0 0 0 0\n"
    "format unit Q2.18\n"
    "background 0 0 0\n"
    "object 1024 1024 1024 819 0 0 128:0 16384 1\n"
    "source 1:0 2:0 3:0 1 1 1\n"
    "begin\n"
    "1 in west 0 6 - features 0 ; pixel 3\n"
    "\n"
    "# a remark\n"
    "9 take west 0\r\n"
    "9 out east 0 6 - features 0\n"
    "20 free east 0\n"
    "30 phase trace\n"
    "31 drain 1\n"
    "35 pixel 0 0 0\n"
    "40 end\n";

GoldenFile read(const std::string& text) {
    std::istringstream in(text);
    return read_golden(in, "vectors");
}

CellSetup setup_of_three() {
    CellSetup setup;
    setup.picture.width = setup.picture.height = 3;
    return setup;
}

TEST(GoldenReader, ReadsEveryKindOfLine) {
    const GoldenFile file = read(good);
    ASSERT_EQ(file.events.size(), 7u);
    EXPECT_EQ(file.last, 40u);
    EXPECT_EQ(file.configuration, "cells = \"3x3\"\n");
    EXPECT_EQ(text_of(file.events[0]), "1 in west 0 6 - features 0 ; pixel 3");
    EXPECT_EQ(text_of(file.events[1]), "9 take west 0");
    EXPECT_EQ(file.events[1].line, 15);
    CellSetup setup = setup_of_three();
    read_setup(file, setup);
    EXPECT_EQ(setup.x, 1);
    EXPECT_EQ(setup.scene.frame.depth, 10);
    EXPECT_EQ(setup.scene.objects.at(0).colour, dvec3(1));
    EXPECT_EQ(setup.scene.sources.at(0).intensity, dvec3(1.0 / 65536));
    // Writing what was read gives the same text again.
    const Context context(setup.scene, setup.picture);
    CellSetup again = setup_of_three();
    read_setup(read(setup_text(setup, context, "") + "40 end\n"), again);
    EXPECT_EQ(setup_text(again, Context(again.scene, again.picture), ""), setup_text(setup, context, ""));
}

/// `good` with one line replaced (line 1 is the first), or left out if `line` is empty.
std::string with_line(int number, const std::string& line) {
    std::istringstream in(good);
    std::string text;
    int at = 0;
    for (std::string old; std::getline(in, old);) {
        if (++at != number) text += old + "\n";
        if (at == number && !line.empty()) text += line + "\n";
    }
    return text;
}

TEST(GoldenReader, NamesTheLineOfWhatIsWrong) {
    const std::vector<std::pair<int, std::string>> wrong = {{1, "raycell-golden 1"},
                                                            {12, "x in west 0 6 features 0"},
                                                            {12, "1 in up 0 6 - setup"},
                                                            {12, "1 in west 9 6 - setup"},
                                                            {12, "1 in west 0 0 - setup"},
                                                            {12, "1 in west 0 6 -"},
                                                            {12, "50 in west 0 6 - setup"},
                                                            {15, "9 take west"},
                                                            {15, "9 take west 0 0"},
                                                            {15, "9 eats west 0"},
                                                            {16, "9 out load 0 6 - setup"},
                                                            {18, "30 phase"},
                                                            {20, "35 pixel 0 0"},
                                                            {15, "99999999999999999999 take west 0"},
                                                            {21, "39"}};
    for (const auto& [number, line] : wrong) {
        SCOPED_TRACE(line);
        try {
            read(with_line(number, line));
            ADD_FAILURE() << "read without complaint";
        } catch (const GoldenError& error) {
            const std::string at = std::string("vectors:");
            EXPECT_EQ(std::string(error.what()).rfind(at, 0), 0u) << error.what();
        }
    }
    EXPECT_THROW(read(""), GoldenError);
    try {
        read(with_line(1, "raycell-golden 1"));
    } catch (const GoldenError& error) {
        EXPECT_NE(std::strstr(error.what(), "record them anew with 'raycell render --golden'"), nullptr)
            << error.what();
    }
    EXPECT_THROW(read(with_line(21, "")), GoldenError) << "a record that was cut off";
}

TEST(GoldenReader, NamesWhatIsWrongInTheHead) {
    const std::vector<std::pair<int, std::string>> wrong = {{3, ""},
                                                            {3, "cell 3 1"},
                                                            {3, "cell 1"},
                                                            {4, "links east"},
                                                            {4, "links up"},
                                                            {4, "links east east"},
                                                            {5, ""},
                                                            {5, "frame 10 1 0 0 0"},
                                                            {5, "frame -0x1p+0 1 0x0p+0 0x0p+0 0x0p+0"},
                                                            {6, "beyond 2 0 0 0 0 0"},
                                                            {7, "format unit Q3.17"},
                                                            {7, "format length Q3.17"},
                                                            {7, "layout ray type:3 x:20"},
                                                            {8, "background 0 0"},
                                                            {9, "object 1 2 3"},
                                                            {10, "source 1 2 3 1 1 1"},
                                                            {10, "lamp 1 2 3"}};
    for (const auto& [number, line] : wrong) {
        SCOPED_TRACE(std::to_string(number) + " " + line);
        CellSetup setup = setup_of_three();
        const GoldenFile file = read(with_line(number, line));
        EXPECT_THROW(read_setup(file, setup), GoldenError);
    }
}

TEST(GoldenReader, AnyTextIsReadOrRefusedButNeverMore) {
    const std::string letters = "0123456789abcdefxp:.+- \nkezinfw#;";
    for (const std::uint64_t seed : property::seeds(1, 2000)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        std::string text = good;
        for (int change = random.whole(1, 6); change > 0; --change) {
            const auto at = std::size_t(random.whole(0, int(text.size()) - 1));
            const char letter = letters[std::size_t(random.whole(0, int(letters.size()) - 1))];
            if (random.chance(0.4))
                text[at] = letter;
            else if (random.chance(0.5))
                text.insert(at, std::string(std::size_t(random.whole(1, 30)), letter));
            else
                text.erase(at, std::size_t(random.whole(1, 20)));
        }
        try {
            const GoldenFile file = read(text);
            CellSetup setup = setup_of_three();
            read_setup(file, setup);
            const Context context(setup.scene, setup.picture);
            const Words words(context.arithmetic);
            MessagePools pools;
            for (const GoldenEvent& event : file.events) {
                if (event.what == GoldenEvent::What::in)
                    read_message(words, event.tokens, event.remarks, {}, pools);
            }
        } catch (const GoldenError&) {
        }
    }
}

}  // namespace
}  // namespace raycell
