// Odd, ignored or wrong statements of OBJ and MTL, and their treatment: a warning if the geometry stays
// whole, otherwise an error.
#include "scene_checks.hpp"

namespace raycell {
namespace {

const std::string vertices = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvn 0 0 1\n";  // 6 lines

enum class Treatment { silent, warning, error };
struct Statement {
    const char* text;
    Treatment treatment;
    const char* part;       ///< of the message
    std::size_t faces = 1;  ///< number drawn, without the one that the test adds
};
constexpr Treatment silent = Treatment::silent;
constexpr Treatment warning = Treatment::warning;
constexpr Treatment error = Treatment::error;

const Statement statements[] = {
    // Corners.
    {"f 1 2 3", silent, ""},
    {"f 1/1 2/1 3/1", silent, ""},
    {"f 1//1 2//1 3//1", silent, ""},
    {"f -4/-1/-1 -3/-1/-1 -2/-1/-1", silent, ""},
    {"f 1// 2// 3//", warning, "'1//' ends with a slash"},
    {"f 1/ 2/ 3/", warning, "'1/' ends with a slash"},
    {"f 1/1/ 2/1/ 3/1/", warning, "'1/1/' ends with a slash"},
    {"f 1/1/1/1 2/1/1/1 3/1/1/1", warning, "more parts than v/vt/vn"},
    {"f 1/1/1/ 2 3", warning, "more parts than v/vt/vn"},
    {"f 1 2/1 3//1", warning, "different forms"},
    {"f 1//1 2//1 3", warning, "different forms"},
    {"f 1/x 2/1 3/1", warning, "texture coordinate 'x'"},
    {"f 1/0 2/1 3/1", warning, "texture coordinate '0'"},
    {"f 1/2 2/1 3/1", warning, "texture coordinate 2"},
    {"f 1/-2 2/1 3/1", warning, "texture coordinate -2"},
    {"f 1/99999999999 2/1 3/1", warning, "texture coordinate '99999999999'"},
    {"f 1//0 2//1 3//1", warning, "normal '0'"},
    {"f 1//2 2//1 3//1", warning, "normal 2"},
    {"f 1//-2 2//1 3//1", warning, "normal -2"},
    {"f 1//x 2//1 3//1", warning, "normal 'x'"},
    {"f 1/x/1 2/1/1 3/1/1", warning, "texture coordinate 'x'"},
    {"f", warning, "0 corners", 0},
    {"f 1", warning, "1 corner;", 0},
    {"f 1 2", warning, "2 corners", 0},
    {"f 1 1 2", warning, "repeats a vertex", 0},
    {"f 0 1 2", error, "index 0"},
    {"f 1 2 -0", error, "index 0"},
    {"f 1 2 5", error, "vertex 5"},
    {"f 1 2 -5", error, "vertex -5"},
    {"f 1 2 99999999999", error, "beyond any file"},
    {"f 1 2 x", error, "found 'x'"},
    {"f 1 2 3.0", error, "found '3.0'"},
    {"f 1 2 /1", error, "found '/1'"},
    {"f 1 2 //1", error, "found '//1'"},
    {"f 1 2 3,4", error, "found '3,4'"},
    {"f 1 2 nan", error, "found 'nan'"},
    // Vertices and normals.
    {"v 0 0 0 1", silent, "", 0},
    {"v 0 0 0 0.5 0.5 0.5", silent, "", 0},
    {"v 0 0 0 0.5 0.5 0.5 1", silent, "", 0},
    {"v 0 0 0 2", warning, "a weight", 0},
    {"v 0 0 0 red", warning, "neither a weight nor a colour", 0},
    {"v 0 0 0 1 0 x", warning, "neither a weight nor a colour", 0},
    {"v 0 0 0 nan nan nan", warning, "neither a weight nor a colour", 0},
    {"v 0 0 0 1e400", warning, "neither a weight nor a colour", 0},
    {"v 0 0 0 1 0", warning, "neither a weight nor a colour", 0},
    {"v 0 0 0 1 0 0 1 1", warning, "neither a weight nor a colour", 0},
    {"v", error, "'v' has 0 numbers"},
    {"v 0 0", error, "'v' has 2 numbers"},
    {"v 0 0 nan", error, "found 'nan'"},
    {"v 0 inf 0", error, "found 'inf'"},
    {"v 0 0 1e31", error, "found '1e31'"},
    {"v 0 0,5 0", error, "found '0,5'"},
    {"v 0 0 0x1", error, "found '0x1'"},
    {"vn 0 0", warning, "'vn' is not 3 numbers", 0},
    {"vn 0 0 1 1", warning, "'vn' is not 3 numbers", 0},
    {"vn 0 0 nan", warning, "'vn' is not 3 numbers", 0},
    {"vn 0 0 nan\nf 1//2 2//2 3//2", warning, "a vertex normal has no length"},
    {"vt", silent, "", 0},
    {"vt x y z", silent, "", 0},
    // Statements that are ignored.
    {"g a b c", silent, "", 0},
    {"o name", silent, "", 0},
    {"s 1", silent, "", 0},
    {"s off", silent, "", 0},
    {"s 0", silent, "", 0},
    {"s", warning, "names no smoothing group", 0},
    {"s -1", warning, "names no smoothing group", 0},
    {"s x", warning, "names no smoothing group", 0},
    {"l 1 2", warning, "'l' is not drawn", 0},
    {"p 1", warning, "'p' is not drawn", 0},
    {"curv 0 1 1 2", warning, "'curv' is not drawn", 0},
    {"surf 0 1 0 1 1 2 3 4", warning, "'surf' is not drawn", 0},
    {"cstype bezier", warning, "'cstype' belongs to free-form", 0},
    {"vp 0 1", warning, "'vp' belongs to free-form", 0},
    {"mg 1 2", warning, "'mg' belongs to free-form", 0},
    {"usemap brick", warning, "'usemap' is ignored: textures", 0},
    {"maplib brick.lib", warning, "'maplib' is ignored: textures", 0},
    {"call other.obj", warning, "'call' is ignored", 0},
    {"shadow_obj other.obj", warning, "'shadow_obj' is ignored", 0},
    {"bevel on", warning, "'bevel' is ignored", 0},
    {"mtllib", warning, "'mtllib' without a name", 0},
    {"mtllib nowhere.mtl", warning, "can't be found", 0},
    {"usemtl nobody\nf 1 2 3", warning, "no library defines"},
    {"group part", warning, "unknown word 'group'", 0},
    {"F 1 2 3", warning, "unknown word 'F'", 0},
    {"\xff\xfe\x01", warning, "unknown word '\\xff\\xfe\\x01'", 0},
    {"1 2 3", warning, "unknown word '1'", 0},
    {"\x1a", silent, "", 0},
    {"f 1 2 3\x1a", silent, ""},
    {"f 1 2 3\n\x1a\x1a", silent, ""},
};

class ObjStatement : public ::testing::TestWithParam<Statement> {};
void PrintTo(const Statement& statement, std::ostream* out) { *out << statement.text; }

TEST_P(ObjStatement, GetsItsTreatment) {
    const Statement& s = GetParam();
    Diagnostics diagnostics;
    const std::string text = vertices + s.text + "\nf -4 -3 -2 -1\n";
    // A vertex in the statement shifts relative indices; four vertices before it are enough.
    Scene scene;
    std::string message;
    try {
        scene = read_obj_text(text, "t.obj", "/nonexistent", diagnostics);
        expect_sound(scene);
    } catch (const InputError& caught) {
        message = caught.what();
    }
    if (s.treatment == error) {
        EXPECT_EQ(message.rfind("t.obj:7: ", 0), 0u) << message << all_messages(diagnostics);
        EXPECT_NE(message.find(s.part), std::string::npos) << message;
        return;
    }
    ASSERT_EQ(message, "");
    EXPECT_EQ(diagnostics.warning_count() > 0, s.treatment == warning) << all_messages(diagnostics);
    EXPECT_NE(all_messages(diagnostics).find(s.part), std::string::npos) << all_messages(diagnostics);
    EXPECT_EQ(scene.primitives.size(), 1 + s.faces);
}

INSTANTIATE_TEST_SUITE_P(All, ObjStatement, ::testing::ValuesIn(statements));

struct MaterialLine {
    const char* text;
    const char* part;  ///< of the warning; empty: no warning
};

const MaterialLine material_lines[] = {
    {"Kd 0.5 0.5 0.5", ""},
    {"Ka 0.5 0.5 0.5", ""},
    {"Ke 0 0 0", ""},
    {"Ke 5 5 5", ""},
    {"Ke -1 0 0", "Ke below 0"},
    {"Kd 0 0 0\nKa 1 1 1", "Ka is ignored"},
    {"map_Kd a.png", "'map_Kd' is ignored: textures"},
    {"map_Pr a.png", "'map_Pr' is ignored: textures"},
    {"bump a.png", "'bump' is ignored: textures"},
    {"norm a.png", "'norm' is ignored: textures"},
    {"disp a.png", "'disp' is ignored: textures"},
    {"decal a.png", "'decal' is ignored: textures"},
    {"refl -type sphere a.png", "'refl' is ignored: textures"},
    {"Pm 1", "'Pm' is ignored"},
    {"Pr 1", "'Pr' is ignored"},
    {"aniso 1", "'aniso' is ignored"},
    {"sharpness 60", "'sharpness' is ignored"},
    {"nonsense 3", "unknown word 'nonsense'"},
    {"kd 1 1 1", "unknown word 'kd'"},
    {"d 0.5", "no illum is given"},
    {"Tr 0.5", "no illum is given"},
    {"d 0.5\nillum 2", "illum asks for no refraction"},
    {"d 1", ""},
    {"Tf 1 1 1\nd 0.5\nillum 7", ""},
    {"Tf 1 0 0\nd 0.5\nillum 7", "Tf is ignored"},
    {"Ns nan", "the line is ignored"},
    {"Kd x", "the line is ignored"},
    {"\x1a", ""},
};

class MtlLine : public ::testing::TestWithParam<MaterialLine> {};
void PrintTo(const MaterialLine& line, std::ostream* out) { *out << line.text; }

TEST_P(MtlLine, IsNamedIfItIsLeftOut) {
    const MaterialLine& m = GetParam();
    const Folder folder;
    const std::string block = std::string("Kd 1 1 1\n") + m.text + "\n";
    folder.write("a.mtl", "newmtl a\n" + block + "newmtl b\n" + block);
    folder.write("b.mtl", "newmtl c\n" + block);
    Diagnostics diagnostics;
    const Scene scene = read_obj_text("mtllib a.mtl b.mtl\n" + vertices + "usemtl a\nf 1 2 3\n", "t.obj",
                                      folder.path(), diagnostics);
    expect_sound(scene);
    EXPECT_EQ(scene.primitives.size(), 1u);
    const std::string said = all_messages(diagnostics);
    if (m.part[0] == 0) {
        EXPECT_EQ(said, "");
        return;
    }
    for (const std::string file : {"a.mtl:", "b.mtl:"}) {
        const std::size_t at = said.find(file);
        ASSERT_NE(at, std::string::npos) << said;
        const std::string line = said.substr(at, said.find('\n', at) - at);
        EXPECT_NE(line.find(m.part), std::string::npos) << said;
    }
}

INSTANTIATE_TEST_SUITE_P(All, MtlLine, ::testing::ValuesIn(material_lines));

TEST(ObjStatements, AreNamedOncePerKindAndFileHoweverManyThereAre) {
    std::string text = vertices;
    for (int i = 0; i < 1000; ++i) text += "l 1 2\nusemap a\nword" + std::to_string(i) + " 1\n";
    Diagnostics diagnostics;
    read_obj_text(text + "f 1 2 3\n", "t.obj", "/nonexistent", diagnostics);
    EXPECT_EQ(diagnostics.warning_count(), 3000u);
    EXPECT_EQ(diagnostics.messages().size(), 2 + 16 + 1u) << all_messages(diagnostics);
}

/// A roof of two faces that meet at an edge.
Scene roof(const std::string& before, const std::string& between, const std::string& corners = "") {
    Diagnostics diagnostics;
    const Scene scene =
        read_obj_text(before + "v -1 0 0\nv 0 -1 0.8\nv 0 1 0.8\nv 1 0 0\nvn 0 0 1\nf 1" + corners + " 2" +
                          corners + " 3" + corners + "\n" + between + "f 2 4 3\n",
                      "t.obj", "/nonexistent", diagnostics);
    expect_sound(scene);
    EXPECT_EQ(all_messages(diagnostics), "");
    return scene;
}

TEST(SmoothingGroups, GiveFacesWithoutNormalsTheMeanOfTheirNeighbours) {
    const Scene smooth = roof("s 1\n", "");
    const auto& left = polygon(smooth, 0);
    const auto& right = polygon(smooth, 1);
    ASSERT_EQ(left.normals.size(), 3u);
    EXPECT_EQ(left.normals[1], right.normals[0]) << "one normal for both at their edge";
    EXPECT_LT(glm::distance(left.normals[1], dvec3(0, 0, 1)), 1e-12) << "the roof is symmetric";
    EXPECT_LT(left.normals[0].x, -0.1) << "the face's own where it has no neighbour";
}

TEST(SmoothingGroups, EndWhereTheGroupOrTheNormalsOfTheFileBegin) {
    EXPECT_TRUE(polygon(roof("", ""), 0).normals.empty());
    EXPECT_TRUE(polygon(roof("s 1\n", "s off\n"), 1).normals.empty());
    EXPECT_TRUE(polygon(roof("s 1\n", "s 2\n"), 0).normals.empty()) << "alone in its group: flat";
    const Scene given = roof("s 1\n", "", "//1");
    EXPECT_EQ(polygon(given, 0).normals, std::vector<dvec3>(3, dvec3(0, 0, 1)));
    EXPECT_TRUE(polygon(given, 1).normals.empty()) << "a face with normals of its own smooths no other";
}

TEST(SmoothingGroups, DoNotDependOnHowAFaceIsCut) {
    const std::string box =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\ns 1\n"
        "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    for (const std::string top : {"f 5 6 7 8\n", "f 5 6 7\nf 5 7 8\n", "f 6 7 8\nf 6 8 5\n"}) {
        Diagnostics diagnostics;
        const Scene scene = read_obj_text(box + top, "t.obj", "/nonexistent", diagnostics);
        const dvec3 outwards = glm::normalize(dvec3(-1, -1, 1));
        EXPECT_LT(glm::distance(polygon(scene, 1).normals.at(3), outwards), 1e-12) << top;
    }
}

TEST(SmoothingGroups, StandTheLargestAndTheSmallestCoordinates) {
    for (const std::string size : {"1e30", "1e-30", "1e-300"}) {
        Diagnostics diagnostics;
        expect_sound(read_obj_text("s 1\nv 0 0 0\nv " + size + " 0 0\nv 0 " + size + " 0\nv 0 0 " + size +
                                       "\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 1 1 2\nf 1 2 1 2\n",
                                   "t.obj", "/nonexistent", diagnostics));
    }
}

}  // namespace
}  // namespace raycell
