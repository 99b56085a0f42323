#include "scenes/obj_reader.hpp"

#include "scene_checks.hpp"

namespace raycell {
namespace {

const std::string square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";  // 4 lines

struct Read {
    Scene scene;
    Diagnostics diagnostics;
    std::string messages() const { return all_messages(diagnostics); }
};

Read read(const std::string& text, const std::filesystem::path& folder = "/nonexistent") {
    Read out;
    out.scene = read_obj_text(text, "t.obj", folder, out.diagnostics);
    expect_sound(out.scene);
    return out;
}

void expect_error(const std::string& text, std::size_t line, const std::string& part) {
    Diagnostics diagnostics;
    try {
        read_obj_text(text, "t.obj", "/nonexistent", diagnostics);
        ADD_FAILURE() << "was read: " << text.substr(0, 200);
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind("t.obj:" + std::to_string(line) + ": ", 0), 0u) << message;
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
        EXPECT_LT(message.size(), 300u);
    }
}

/// Reads a square with material `m` from a library with this text.
Read with_library(const std::string& library) {
    const Folder folder;
    folder.write("m.mtl", library);
    return read("mtllib m.mtl\n" + square + "usemtl m\nf 1 2 3 4\n", folder.path());
}

TEST(ObjReader, ReadsFacesOfAnySizeWithoutCuttingThem) {
    const Read r = read(square + "v 0 2 0\ng a b\no x\ns off\nf 1 2 3\nf 1 2 3 4\nf -5 -4 -3 -1 -2\n");
    EXPECT_EQ(r.messages(), "");
    ASSERT_EQ(r.scene.primitives.size(), 3u);
    EXPECT_EQ(polygon(r.scene, 1).vertices.size(), 4u);
    EXPECT_EQ(polygon(r.scene, 2).vertices[3], dvec3(0, 2, 0));
    EXPECT_FALSE(r.scene.view);
    EXPECT_TRUE(r.scene.sources.empty());
    std::string large;
    std::string face = "f";
    for (int i = 0; i < 1000; ++i) {
        const double a = i * 3.14159265358979323846 / 500;
        large += "v " + std::to_string(std::cos(a)) + " " + std::to_string(std::sin(a)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    EXPECT_EQ(polygon(read(large + face).scene, 0).vertices.size(), 1000u);
}

TEST(ObjReader, KeepsEveryDigitOfADouble) {
    const Read r = read("v 0.12345678901234567 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(polygon(r.scene, 0).vertices[0].x, 0.12345678901234567);
}

TEST(ObjReader, JoinsContinuedLinesForAnyLineEnd) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (const char c : square + "f 1 2 \\\n3\\\n 4\n") text += c == '\n' ? end : std::string(1, c);
        const Read r = read(text);
        EXPECT_EQ(r.messages(), "");
        ASSERT_EQ(r.scene.primitives.size(), 1u);
        EXPECT_EQ(polygon(r.scene, 0).vertices.size(), 4u);
        expect_error(text + "f 0 1 2" + end, 8, "index 0");
    }
    EXPECT_EQ(read(square + "# C:\\folder\\\nf 1 2 3\n").scene.primitives.size(), 1u);
    EXPECT_EQ(read(square + "f 1 2 3\\").scene.primitives.size(), 1u);
}

TEST(ObjReader, RejectsIndicesThatNameNothing) {
    expect_error(square + "f 0 1 2\n", 5, "index 0");
    expect_error(square + "f 1 2 5\n", 5, "vertex 5");
    expect_error(square + "f -1 -2 -9\n", 5, "vertex -9");
    expect_error(square + "f 1 2 99999999999\n", 5, "beyond");
    expect_error(square + "f 1 2 -2147483648\n", 5, "beyond");
    expect_error(square + "f 1 2 2147483647\n", 5, "2147483647");
    expect_error(square + "f -4294967295 2 3\n", 5, "beyond");
}

TEST(ObjReader, RejectsMalformedFaces) {
    for (const char* face :
         {"1 2 x", "1 2 3x", "1.5 2 3", "/1 2 3", "1 2 +3", "//1 2 3", "1 2 3-", "- 2 3"}) {
        expect_error(square + "vt 0 0\nvn 0 0 1\nf " + face + "\n", 7, "'f'");
    }
}

TEST(ObjReader, AcceptsFacesBeforeTheirVertices) {
    EXPECT_EQ(read("f 1 2 3 4\n" + square).scene.primitives.size(), 1u);
}

TEST(ObjReader, RejectsNumbersThatAreNone) {
    for (const char* bad : {"nan", "-inf", "1e400", "1e31", "0x1", "1,5", "1.0abc", "1e", "x"}) {
        expect_error(std::string("v 0 0 0\nv 0 ") + bad + " 0\n", 2, bad);
    }
    expect_error("v 1 2\n", 1, "'v' has 2");
}

TEST(ObjReader, ReadsPlaceAndIgnoresWeightsAndColours) {
    const Read r = read("v -1 -1 0 1.0\nv 1 -1 0 1 0 0\nv 0 1 0 0.5 0.5 0.5 1\nf 1 2 3\n");
    EXPECT_EQ(r.messages(), "");
    EXPECT_EQ(polygon(r.scene, 0).vertices[2], dvec3(0, 1, 0));
    EXPECT_EQ(read("v -1 -1 0 0\nv 1 -1 0 2\nv 0 1 0\nf 1 2 3\n").diagnostics.count_of("weight"), 2u);
}

TEST(ObjReader, RejectsWhatIsNoObj) {
    expect_error("", 1, "no statement");
    expect_error("# only a comment\n", 2, "no statement");
    expect_error("<html>\n", 1, "'<html>'");
    expect_error(std::string("v 0 0\0 0\n", 9), 1, "NUL");
    expect_error("\x0bT\x9d\xe6/x", 1, "\\x9d");
    expect_error("v " + std::string(5000000, '1'), 1, "4194304");
}

TEST(ObjReader, WarnsOfStatementsThatAreNotDrawn) {
    const Read r = read(square + "l 1 2\np 1\np 2\ncurv 0 1 1 2\nf 1 2 3\n");
    EXPECT_EQ(r.diagnostics.warning_count(), 4u);
    EXPECT_EQ(r.diagnostics.messages().size(), 3u);
    EXPECT_EQ(r.scene.primitives.size(), 1u);
}

TEST(ObjReader, HandsNormalsOverOnlyIfAllCornersHaveOne) {
    const std::string normals = "vn 0 0 2\nvn 0 1 1\n";
    const Read full = read(square + normals + "f 1//1 2//1 3//2 4//2\n");
    EXPECT_EQ(full.messages(), "");
    ASSERT_EQ(polygon(full.scene, 0).normals.size(), 4u);
    EXPECT_EQ(polygon(full.scene, 0).normals[0], dvec3(0, 0, 1));
    const Read part = read(square + normals + "f 1//1 2 3//2 4//2\n");
    EXPECT_EQ(part.diagnostics.count_of("mixed corners"), 1u);
    EXPECT_TRUE(polygon(part.scene, 0).normals.empty());
}

TEST(ObjReader, MapsMaterialsAsTheDesignSays) {
    const Read r = with_library("newmtl m\nKd 0.1 0.2 0.3\nKs 0.3 0.6 0.9\nNs 50\nNi 1.5\nd 0.2\nillum 7\n");
    EXPECT_EQ(r.messages(), "");
    const Material& m = r.scene.materials.at(r.scene.primitives.at(0).material);
    EXPECT_LT(glm::distance(m.colour, dvec3(0.1, 0.2, 0.3)), 1e-12);
    EXPECT_EQ(m.diffuse, 1);
    EXPECT_NEAR(m.specular, 0.6, 1e-12);
    EXPECT_TRUE(m.mirror);
    EXPECT_EQ(m.shine, 50);
    EXPECT_NEAR(m.transmit, 0.8, 1e-12);
    EXPECT_EQ(m.ior, 1.5);
}

TEST(ObjReader, LetsIllumDecideOnMirrorsAndGlass) {
    for (int illum = 0; illum <= 10; ++illum) {
        const Read r =
            with_library("newmtl m\nKd 1 1 1\nKs 1 1 1\nTr 0.4\nillum " + std::to_string(illum) + "\n");
        const Material& m = r.scene.materials.at(0);
        EXPECT_EQ(m.mirror, illum >= 3 && illum <= 9) << illum;
        EXPECT_NEAR(m.transmit, illum == 4 || illum == 6 || illum == 7 || illum == 9 ? 0.4 : 0, 1e-12)
            << illum;
    }
}

TEST(ObjReader, TreatsConflictsInLibrariesAsDocumented) {
    const auto material = [](const std::string& lines, const std::string& kind) {
        const Read r = with_library("newmtl m\n" + lines);
        EXPECT_EQ(r.diagnostics.count_of(kind), 1u) << lines << "\n" << r.messages();
        return r.scene.materials.at(0);
    };
    EXPECT_EQ(material("Kd 0.5\n", "colour components").colour, dvec3(0.5));
    EXPECT_EQ(material("Kd 0.5 0.25\n", "colour components").colour, dvec3(0.5, 0.25, 0.25));
    EXPECT_EQ(material("Ks 1 1 1\n", "no Kd").colour, Material{}.colour);
    EXPECT_NEAR(material("Kd 1 1 1\nd 0.3\nTr 0.3\nillum 7\n", "d and Tr").transmit, 0.7, 1e-12);
    EXPECT_NEAR(material("Kd 1 1 1\nTr 0.3\nd 0.3\nillum 7\n", "d and Tr").transmit, 0.7, 1e-12);
    EXPECT_NEAR(material("Kd 1 1 1\nTf 0.3 0.6 0.9\nillum 7\n", "Tf").transmit, 0.6, 1e-12);
    EXPECT_EQ(material("Kd 1 1 1\nNi 0\n", "Ni").ior, 1);
    EXPECT_EQ(material("Kd 1 1 1\nNs -5\n", "negative Ns").shine, 0);
    EXPECT_EQ(material("Kd 1 1 1\nNs 1e9\n", "large Ns").shine, 1e9);
    EXPECT_FALSE(material("Kd 1 1 1\nillum 99\n", "illumination model").mirror);
    EXPECT_EQ(material("Kd 0 1 0\nnewmtl m\nKd 1 0 0\n", "material twice").colour, dvec3(0, 1, 0));
    EXPECT_EQ(material("Kd 1 1 1\nKd spectral file.rfl 1\n", "material line").colour, dvec3(1));
    EXPECT_EQ(material("Kd 1 1 1\nmap_Kd a.png\n", "ignored 'map_Kd'").colour, dvec3(1));
    EXPECT_EQ(material("Kd 1 1 1\nd 2\nillum 7\n",
                       "the transmitted share is outside 0 to 1; brought to the nearest of them")
                  .transmit,
              0);
}

TEST(ObjReader, LeavesOutLinesOfLibrariesWhoseNumbersAreNotFinite) {
    for (const char* bad : {"Kd nan 0 0", "Ns inf", "Ni 1e400", "d -inf"}) {
        const Read r = with_library(std::string("newmtl m\nKd 1 1 1\n") + bad + "\n");
        EXPECT_EQ(r.diagnostics.count_of("material line"), 1u) << bad << r.messages();
        EXPECT_EQ(r.diagnostics.warning_count(), 1u) << r.messages();
    }
}

TEST(ObjReader, KeepsTheGeometryWhereALibraryIsNoText) {
    const Read r = with_library(std::string("newmtl m\nKd 0 \0 1\n", 18));
    EXPECT_EQ(r.diagnostics.count_of("material library"), 1u) << r.messages();
    EXPECT_EQ(r.scene.primitives.size(), 1u);
    EXPECT_EQ(r.scene.materials.at(0).colour, Material{}.colour);
}

TEST(ObjReader, FindsMaterialsWithOddNamesAndSeveralLibraries) {
    const Folder folder;
    folder.write("a.mtl", "newmtl Material#25\nKd 1 0 0\n");
    folder.write("b c.mtl", "newmtl two words \r\nKd 0 1 0\r\n");
    folder.write("sub/d.mtl", "newmtl d\nKd 0 0 1\n");
    const Read r = read("mtllib a.mtl sub\\d.mtl # x\nmtllib b c.mtl\n" + square +
                            "usemtl Material#25\nf 1 2 3\nusemtl two words\nf 1 2 3\nusemtl d\nf 1 2 3\n",
                        folder.path());
    EXPECT_EQ(r.messages(), "");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(r.scene.materials.at(r.scene.primitives.at(i).material).colour[static_cast<int>(i)], 1);
    }
}

TEST(ObjReader, WarnsOnceOfAMissingLibrary) {
    const Read r = read("mtllib nowhere.mtl\nusemtl a\n" + square + "f 1 2 3\nusemtl b\nf 1 2 3\n");
    EXPECT_EQ(r.diagnostics.warning_count(), 1u) << r.messages();
    EXPECT_EQ(r.scene.materials.size(), 1u);
    EXPECT_EQ(r.scene.materials[0].colour, Material{}.colour);
}

TEST(ObjReader, WarnsOnceOfAnUnknownMaterial) {
    const Read r = read(square + "usemtl a\nf 1 2 3\nf 2 3 4\n");
    EXPECT_EQ(r.diagnostics.count_of("unknown material"), 1u) << r.messages();
}

TEST(ObjReader, NeverOpensALibraryOutsideTheScenesFolder) {
    const Folder folder;
    const auto secret = folder.write("secret.mtl", "newmtl m\nKd 0.123 0 0\n");
    std::filesystem::create_directories(folder.path() / "scene");
    std::filesystem::create_symlink(secret, folder.path() / "scene" / "link.mtl");
    for (const std::string& name :
         {std::string("../secret.mtl"), std::string("x/../../secret.mtl"), secret.string(),
          std::string("..\\secret.mtl"), std::string("link.mtl"), std::string("/etc/passwd"),
          std::string("../../../../../../../../etc/passwd"), std::string("."), std::string("..")}) {
        const Read r =
            read("mtllib " + name + "\nusemtl m\n" + square + "f 1 2 3\n", folder.path() / "scene");
        EXPECT_EQ(r.diagnostics.count_of("material library"), 1u) << name;
        EXPECT_EQ(r.scene.materials.at(0).colour, Material{}.colour) << name;
        EXPECT_EQ(r.messages().find("0.123"), std::string::npos);
        EXPECT_EQ(r.messages().find("root:"), std::string::npos);
    }
    // A path that leaves the folder and comes back is harmless.
    EXPECT_EQ(read("mtllib ../" + folder.path().filename().string() + "/secret.mtl\n" + square, folder.path())
                  .messages(),
              "");
}

TEST(ObjReader, FramesTheBoundingBoxByDefault) {
    Read r = read(square + "f 1 2 3 4\n");
    add_default_view(r.scene, r.diagnostics);
    expect_sound(r.scene);
    ASSERT_TRUE(r.scene.view);
    ASSERT_EQ(r.scene.sources.size(), 1u);
    EXPECT_EQ(r.scene.sources[0].position, r.scene.view->from);
    EXPECT_NE(r.messages().find("note: "), std::string::npos);
    EXPECT_EQ(r.diagnostics.warning_count(), 0u);
    const dvec3 axis = glm::normalize(r.scene.view->at - r.scene.view->from);
    for (const dvec3& v : polygon(r.scene, 0).vertices) {
        const double cosine = glm::dot(glm::normalize(v - r.scene.view->from), axis);
        EXPECT_LE(glm::degrees(std::acos(cosine)), r.scene.view->angle / 2);
    }
    Scene empty;
    add_default_view(empty, r.diagnostics);
    expect_sound(empty);
}

TEST(ObjReader, TakesViewBackgroundAndSourcesOfAnotherScene) {
    Scene scene, other;
    scene.sources.resize(2);
    other.background = {0.1, 0.2, 0.3};
    other.view = View{};
    take_view(scene, other);
    EXPECT_EQ(scene.background, other.background);
    EXPECT_TRUE(scene.view);
    EXPECT_EQ(scene.sources.size(), 2u);
    other.sources.resize(1);
    take_view(scene, other);
    EXPECT_EQ(scene.sources.size(), 1u);
}

}  // namespace
}  // namespace raycell
