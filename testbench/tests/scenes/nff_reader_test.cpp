#include "scenes/nff_reader.hpp"

#include <ctime>

#include "scene_checks.hpp"

namespace raycell {
namespace {

const std::string view =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\n";             // 7 lines
const std::string start = "b 0.1 0.2 0.3\n" + view + "l 5 5 5\nf 1 0.5 0.2 0.7 0.3 20 0 1\n";  // 10 lines

struct Read {
    Scene scene;
    Diagnostics diagnostics;
    std::string messages() const { return all_messages(diagnostics); }
};

Read read(const std::string& text) {
    Read out;
    out.scene = read_nff_text(text, "t.nff", out.diagnostics);
    expect_sound(out.scene);
    return out;
}

/// The error that reading the text must end in. Empty, with a failed test, if the text is accepted.
std::string error_of(const std::string& text) {
    Diagnostics diagnostics;
    try {
        read_nff_text(text, "t.nff", diagnostics);
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "was read: " << text.substr(0, 200);
    return "";
}

void expect_error(const std::string& text, std::size_t line, const std::string& part) {
    const std::string error = error_of(text);
    EXPECT_EQ(error.rfind("t.nff:" + std::to_string(line) + ": ", 0), 0u) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error << "\nlacks " << part;
    EXPECT_NE(error.find("; expected "), std::string::npos) << error;
    EXPECT_LT(error.size(), 300u);
    for (const char c : error) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << error;
}

void expect_warning(const std::string& text, const std::string& kind, std::size_t count = 1) {
    const Read r = read(text);
    EXPECT_EQ(r.diagnostics.count_of(kind), count) << r.messages();
}

void expect_silent(const std::string& text) {
    const Read r = read(text);
    EXPECT_EQ(r.messages(), "") << text;
}

TEST(NffReader, ReadsEveryEntity) {
    const Read r = read(
        "b 0.1 0.2 0.3\nv\nfrom 1 2 3\nat 4 5 6\nup 0 0 1\nangle 30\nhither 0.5\nresolution 640 480\n"
        "l 1 2 3\nl 4 5 6 0.5 0.6 0.7\nf 0.1 0.2 0.3 0.4 0.5 6 0.7 1.5\ns 1 2 3 4\ns 1 2 3 -4\n"
        "c\n0 0 0 2\n0 0 1 1\nc 0 0 0 -2 0 0 1 -1\np 3\n0 0 0\n1 0 0\n0 1 0\n"
        "pp 3 0 0 0 0 0 2 1 0 0 0 1 1 0 1 0 0 0 1\n");
    const Scene& s = r.scene;
    EXPECT_EQ(r.messages(), "");
    EXPECT_EQ(s.name, "t.nff");
    EXPECT_EQ(s.background, dvec3(0.1, 0.2, 0.3));
    ASSERT_TRUE(s.view);
    EXPECT_EQ(s.view->from, dvec3(1, 2, 3));
    EXPECT_EQ(s.view->at, dvec3(4, 5, 6));
    EXPECT_EQ(s.view->up, dvec3(0, 0, 1));
    EXPECT_EQ(s.view->angle, 30);
    EXPECT_EQ(s.view->hither, 0.5);
    EXPECT_EQ(s.view->width, 640);
    EXPECT_EQ(s.view->height, 480);
    ASSERT_EQ(s.sources.size(), 2u);
    EXPECT_EQ(s.sources[0].position, dvec3(1, 2, 3));
    EXPECT_FALSE(s.sources[0].colour);
    EXPECT_EQ(s.sources[1].colour, dvec3(0.5, 0.6, 0.7));
    ASSERT_EQ(s.materials.size(), 1u);
    const Material& m = s.materials[0];
    EXPECT_EQ(m.colour, dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(m.diffuse, 0.4);
    EXPECT_EQ(m.specular, 0.5);
    EXPECT_EQ(m.shine, 6);
    EXPECT_EQ(m.transmit, 0.7);
    EXPECT_EQ(m.ior, 1.5);
    EXPECT_TRUE(m.mirror);
    ASSERT_EQ(s.primitives.size(), 6u);
    EXPECT_FALSE(std::get<SpherePrimitive>(s.primitives[0].shape).inward);
    EXPECT_TRUE(std::get<SpherePrimitive>(s.primitives[1].shape).inward);
    EXPECT_EQ(std::get<SpherePrimitive>(s.primitives[1].shape).radius, 4);
    EXPECT_EQ(std::get<ConePrimitive>(s.primitives[2].shape).apex_radius, 1);
    EXPECT_TRUE(std::get<ConePrimitive>(s.primitives[3].shape).inward);
    EXPECT_EQ(std::get<ConePrimitive>(s.primitives[3].shape).base_radius, 2);
    EXPECT_TRUE(polygon(s, 4).normals.empty());
    ASSERT_EQ(polygon(s, 5).normals.size(), 3u);
    EXPECT_EQ(polygon(s, 5).normals[0], dvec3(0, 0, 1));
    EXPECT_NEAR(polygon(s, 5).normals[1].y, std::sqrt(0.5), 1e-12);
}

TEST(NffReader, GivesTheSameSceneForAnyLineEndsCommentsAndLayout) {
    const std::string plain = start + "s 0 0 0 1\n";
    std::string crlf, cr, one_line;
    for (const char c : plain) {
        crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
        cr += c == '\n' ? '\r' : c;
        one_line += c == '\n' ? ' ' : c;
    }
    std::vector<std::string> same = {crlf,
                                     cr,
                                     one_line,
                                     "\xef\xbb\xbf" + cr,
                                     "# note\n" + plain + "# end",
                                     start + "s#x\n0\n0#1 2 3\n\t0 \v 1",
                                     start + "s 0 0 0 1"};
    for (const std::string& text : same) {
        const Read r = read(text);
        EXPECT_EQ(r.messages(), "");
        ASSERT_EQ(r.scene.primitives.size(), 1u);
        EXPECT_EQ(std::get<SpherePrimitive>(r.scene.primitives[0].shape).radius, 1);
        EXPECT_EQ(r.scene.background, dvec3(0.1, 0.2, 0.3));
    }
}

TEST(NffReader, CountsLinesAlikeForAnyLineEnd) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        expect_error(std::string("# one") + end + "b 0 0 0" + end + end + "oops" + end, 4, "'oops'");
    }
}

TEST(NffReader, TakesCtrlZForWhiteSpace) {
    for (const std::string end : {"\x1a", "\n\x1a", "\n\x1a\x1a\n"}) {
        expect_silent(start + "s 0 0 0 1" + end);
        EXPECT_EQ(read(start + "s 0 0 0 1" + end).scene.primitives.size(), 1u);
    }
    expect_error(start + "s 0 0 0 \x1a", 11, "the file ends");
}

TEST(NffReader, RejectsATextWithoutEntities) {
    expect_error("", 1, "no entity");
    expect_error("\n\n  \t\r\n", 1, "no entity");
    expect_error("# only\n# comments", 1, "no entity");
    expect_error("\xef\xbb\xbf", 1, "no entity");
}

TEST(NffReader, RejectsWhatIsNoText) {
    expect_error(std::string("b 0 0 0\ns 0 0\0 0 1", 18), 2, "NUL");
    expect_error(
        "\xff\xfe"
        "b",
        1, "UTF-16");
    expect_error("\x89PNG\r\n\x1a\n", 1, "\\x89PNG");
    expect_error(std::string(100000, 'x'), 1, "more than 256");
    expect_error(start + "s 0 0 0 " + std::string(1000, '1'), 11, "more than 256");
}

TEST(NffReader, RejectsUnknownWordsAndNamesThem) {
    expect_error(start + "tess 4\n", 11, "'tess'");
    expect_error(start + "s 0 0 0 1\nhex 0 0 0 1\n", 12, "'hex'");
    expect_error(start + "P 3 0 0 0 1 0 0 0 1 0\n", 11, "'P'");
    expect_error(start + std::string(200, 'q') + "\n", 11, "qqq...");
}

TEST(NffReader, RejectsACountThatTheFileCannotFill) {
    for (const char* count : {"4", "2000000000", "1e11"}) {
        expect_error(start + "p " + count + "\n-1 -1 0\n1 -1 0\n0 1 0\n", 14, "'p' in line 11");
    }
    expect_error(start + "p 4\n-1 -1 0\n1 -1 0\n0 1 0\ns 0 0 0 1\n", 15, "'s'");
    expect_error(start + "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0\n", 14, "'pp' in line 11");
}

TEST(NffReader, RejectsACountSmallerThanTheOutline) {
    expect_error(start + "p 3\n-1 -1 0\n1 -1 0\n0 1 0\n0 2 0\n", 15, "number too many");
}

TEST(NffReader, RejectsACountThatIsNoOutline) {
    for (const char* count :
         {"0", "1", "2", "-3", "3.5", "nan", "1e400", "x", "3x", "99999999999999999999"}) {
        expect_error(start + "p " + count + "\n0 0 0\n1 0 0\n0 1 0\n", 11, "'p' in line 11");
    }
    expect_error(start + "p", 11, "file ends");
}

TEST(NffReader, RejectsNumbersThatAreNone) {
    for (const char* bad :
         {"nan", "NaN",    "inf", "-inf", "Infinity", "nan(1)", "1e400", "-1e400", "1e300", "1e31",  "0x10",
          "1,5", "1.0abc", "1e",  "1e+",  "--1",      "+-1",    "+",     "-",      ".",     "1.2.3", "1d5"}) {
        expect_error(start + "s " + bad + " 0 0 1\n", 11, bad);
    }
}

TEST(NffReader, ReadsEveryWayToWriteANumber) {
    const Read r = read(start +
                        "s +1 -.5 2. 1e+0\ns 1E-1 1e-400 -0 4.9e-324\ns 0 0 0 00012.50\n"
                        "s 0 0 0 0.000000000000000000000000000000001e33\ns 1e30 0 0 1e29\n");
    const auto sphere = [&](int i) { return std::get<SpherePrimitive>(r.scene.primitives.at(i).shape); };
    EXPECT_EQ(sphere(0).centre, dvec3(1, -0.5, 2));
    EXPECT_EQ(sphere(1).radius, 12.5);  // the one before has radius 0 and is dropped
    EXPECT_EQ(sphere(2).radius, 1);
    EXPECT_EQ(sphere(3).centre.x, 1e30);
    EXPECT_EQ(r.diagnostics.count_of("sphere without extent"), 1u);
}

TEST(NffReader, RejectsWrongCountsOfNumbersWithoutEatingTheNextEntity) {
    expect_error(start + "f 1 0 0 0.5 0.5\ns 0 0 0 1\n", 11, "'f' has 5 numbers");
    expect_error(start + "f 1 0 0 0.5 0.5 1 0 1 9\n", 11, "'f' has 9 numbers");
    expect_error(start + "l 1\n2\nf 1 1 1 1 1 1 1 1\n", 11, "'l' has 2 numbers");
    for (const char* numbers : {"", "1", "1 2 3 4", "1 2 3 4 5", "1 2 3 4 5 6 7"}) {
        expect_error(start + "l " + numbers + "\ns 0 0 0 1\n", 11, "3 or 6");
    }
    expect_error("b 0 0\n" + view, 1, "'b' has 2 numbers");
    expect_error("b 0 0 0 0\n" + view, 1, "'b' has 4 numbers");
    expect_error(start + "s 0 0 0\ns 0 0 0 1\n", 12, "'s' in line 11");
    expect_error(start + "s 0 0 0 1 2\n", 11, "number too many");
    expect_error(start + "c 0 0 0 1 0 0 1\n", 11, "'c' in line 11");
}

TEST(NffReader, RejectsViewsThatShowNothing) {
    const auto with = [](const std::string& line, const std::string& other) {
        std::string text = start;
        const std::size_t at = text.find(line);
        return text.substr(0, at) + other + text.substr(at + line.size());
    };
    for (const char* angle : {"0", "180", "-45", "1e-300", "360", "nan"}) {
        expect_error(with("angle 45", std::string("angle ") + angle), std::string(angle) == "nan" ? 6 : 2,
                     "angle");
    }
    expect_error(with("from 0 0 5", "from 0 0 0"), 2, "coincide");
    expect_error(with("from 0 0 5\nat 0 0 0", "from 1e20 0 5\nat 1e20 0 0"), 2, "coincide");
    expect_error(with("up 0 1 0", "up 0 0 0"), 2, "'up'");
    expect_error(with("up 0 1 0", "up 0 0 2"), 2, "parallel");
    expect_error(with("up 0 1 0", "up 0 0 -1e-20"), 2, "parallel");
    expect_error(with("hither 0.1", "hither -1"), 2, "hither");
    for (const char* size : {"0 64", "64 0", "-64 64", "64 100000", "1e9 1e9", "64.5 64", "64 x"}) {
        expect_error(with("resolution 64 64", std::string("resolution ") + size), 8, "resolution");
    }
    for (const char* line : {"from 0 0 5\n", "at 0 0 0\n", "up 0 1 0\n", "angle 45\n", "hither 0.1\n"}) {
        expect_error(with(line, ""), 8,
                     std::string("'") + std::string(line).substr(0, std::string(line).find(' ')));
    }
    expect_error(with("resolution 64 64\n", ""), 8, "'resolution'");
    expect_error(with("angle 45", "up 0 1 0"), 6, "'angle'");
    expect_error("v", 1, "file ends");
}

TEST(NffReader, AcceptsAViewInAnotherOrderWithAWarning) {
    const Read r = read("v at 0 0 0 from 0 0 5 up 0 1 0 hither 0 angle 45 resolution 1 1\n");
    EXPECT_EQ(r.diagnostics.count_of("order of v"), 1u);
    EXPECT_EQ(r.scene.view->from, dvec3(0, 0, 5));
    EXPECT_EQ(r.scene.view->at, dvec3(0, 0, 0));
}

TEST(NffReader, TakesTheLastOfTwoViewsOrBackgroundsWithAWarning) {
    const Read r = read(start + "b 1 1 1\nv from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 1 1\n");
    EXPECT_EQ(r.diagnostics.count_of("second view"), 1u);
    EXPECT_EQ(r.diagnostics.count_of("second background"), 1u);
    EXPECT_EQ(r.scene.view->from.z, 9);
    EXPECT_EQ(r.scene.background, dvec3(1));
}

TEST(NffReader, WarnsOfViewBackgroundAndLightsAfterObjects) {
    const Read r = read("f 1 0.5 0.2 0.7 0.3 20 0 1\ns 0 0 0 1\nb 0.1 0.2 0.3\nl 5 5 5\n" + view);
    EXPECT_EQ(r.diagnostics.count_of("late entity"), 3u);
    EXPECT_TRUE(r.scene.view);
    EXPECT_EQ(r.scene.sources.size(), 1u);
    EXPECT_EQ(r.scene.background.z, 0.3);
}

TEST(NffReader, BringsMaterialsIntoRangeWithAWarning) {
    const auto material = [](const std::string& numbers, const std::string& kind) {
        const Read r = read(view + "f " + numbers + "\n");
        EXPECT_EQ(r.diagnostics.count_of(kind), 1u) << numbers << "\n" << r.messages();
        EXPECT_EQ(r.diagnostics.warning_count(), 1u) << numbers << "\n" << r.messages();
        return r.scene.materials.at(0);
    };
    EXPECT_EQ(material("-1 0 0 1 0 1 0 1", "negative colour").colour.x, 0);
    EXPECT_EQ(material("2 0 0 1 0 1 0 1", "bright colour").colour.x, 2);
    EXPECT_EQ(material("1 0 0 -1 0 1 0 1", "share Kd").diffuse, 0);
    EXPECT_EQ(material("1 0 0 0 1.5 1 0 1", "share Ks").specular, 1);
    EXPECT_EQ(material("1 0 0 0 0 -5 0 1", "negative shine").shine, 0);
    EXPECT_EQ(material("1 0 0 0 0 1 2 1", "share T").transmit, 1);
    EXPECT_EQ(material("1 0 0 0 0 1 0.5 0", "index of refraction").ior, 1);
    EXPECT_EQ(material("1 0 0 0 0 1 0.5 -2", "index of refraction").ior, 1);
    expect_error(view + "f 1e9 0 0 1 0 1 0 1\n", 8, "1e6");
}

TEST(NffReader, TakesAnIndexOfRefractionOfZeroWithoutTransmissionInSilence) {
    const Read r = read(view + "f 1 0 0 1 0 1 0 0\n");
    EXPECT_EQ(r.messages(), "");
    EXPECT_EQ(r.scene.materials[0].ior, 1);
}

TEST(NffReader, GivesTheDefaultMaterialToObjectsBeforeAnyMaterial) {
    const Read r = read(view + "s 0 0 0 1\ns 1 0 0 1\nf 1 0 0 1 0 1 0 0\ns 2 0 0 1\n");
    EXPECT_EQ(r.diagnostics.count_of("no material"), 2u);
    ASSERT_EQ(r.scene.materials.size(), 2u);
    EXPECT_EQ(r.scene.materials[0].colour, Material{}.colour);
    EXPECT_EQ(r.scene.primitives[1].material, 0u);
    EXPECT_EQ(r.scene.primitives[2].material, 1u);
}

TEST(NffReader, RejectsMoreSourcesThanAVerdictWordHolds) {
    std::string text = view;
    for (std::size_t i = 0; i < max_sources; ++i) text += "l 1 2 3\n";
    EXPECT_EQ(read(text).scene.sources.size(), max_sources);
    expect_error(text + "l 1 2 3\n", 8 + max_sources, "light sources");
}

TEST(NffReader, DropsSpheresAndConesWithoutExtent) {
    for (const char* sphere : {"0 0 0 0", "0 0 0 -0", "1e20 0 0 1", "0 0 0 1e-320"}) {
        expect_warning(start + "s " + sphere + "\n", "sphere without extent");
        EXPECT_TRUE(read(start + "s " + sphere + "\n").scene.primitives.empty());
    }
    expect_warning(start + "c 0 0 0 0.5 0 0 0 0.2\n", "cone without axis");
    expect_warning(start + "c 0 0 0 0 0 1 0 0\n", "cone without radius");
    expect_warning(start + "c 1e20 0 0 1 1e20 1 0 1\n", "cone without axis");
    expect_silent(start + "c 0 0 0 0 0 1 0 1\n");
}

TEST(NffReader, RejectsConesWithRadiiOfOppositeSigns) {
    expect_error(start + "c 0 0 0 1 0 1 0 -1\n", 11, "opposite signs");
    EXPECT_TRUE(
        std::get<ConePrimitive>(read(start + "c 0 0 0 -1 0 1 0 0\n").scene.primitives[0].shape).inward);
}

TEST(NffReader, TakesTimeLinearInTheFile) {
    std::string text = start;
    for (int i = 0; i < 200000; ++i) text += "s 0.123456 0.234567 0.345678 0.456789\n";
    const std::clock_t before = std::clock();
    EXPECT_EQ(read(text).scene.primitives.size(), 200000u);
    EXPECT_LT(double(std::clock() - before) / CLOCKS_PER_SEC, 5) << "of processor time, for 7 MB";
}

TEST(NffReader, NeverPrintsMoreThanAHandfulOfWarningsOfAKind) {
    std::string text = view;
    for (int i = 0; i < 1000; ++i) text += "s 0 0 0 1\n";
    const Read r = read(text);
    EXPECT_EQ(r.diagnostics.warning_count(), 1000u);
    ASSERT_EQ(r.diagnostics.messages().size(), Diagnostics::shown_of_a_kind);
    EXPECT_NE(r.diagnostics.messages()[4].find("and 995 more"), std::string::npos) << r.messages();
    EXPECT_EQ(r.diagnostics.messages()[0].rfind("t.nff:8: warning: ", 0), 0u) << r.messages();
}

}  // namespace
}  // namespace raycell
