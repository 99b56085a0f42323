// Files of light sources.
#include "scenes/source_file.hpp"

#include "scene_checks.hpp"
#include "scenes/load_scene.hpp"

namespace raycell {
namespace {

std::string error_of(const std::string& text) {
    try {
        read_sources_text(text, "lamps.toml");
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SourceFile, GivesSourcesOfEveryKind) {
    const SourceFile file = read_sources_text(
        "add = true\n"
        "[[source]]\nkind = 'point'\nposition = [1, 2.5, -3]\n"
        "[[source]]\nkind = 'directional'\ndirection = [0, -2, 0]\ncolour = [0.5, 1, 2]\n"
        "[[source]]\nkind = 'spot'\nposition = [0, 1, 0]\ndirection = [1, 1, 0]\nangle = 30\nfalloff = 8\n"
        "[[source]]\nkind = 'spot'\nposition = [0, 1, 0]\ndirection = [1, 1, 0]\n"
        "[[source]]\nkind = 'rectangle'\ncorner = [1, 2, 3]\nu = [1, 0, 0]\nv = [0.5, 2, 0]\n"
        "[[source]]\nkind = 'triangle'\ncorner = [1, 2, 3]\nu = [1, 0, 0]\nv = [0, 2, 0]\n"
        "[[source]]\nkind = 'sphere'\ncentre = [1, 2, 3]\nradius = 2\n",
        "lamps.toml");
    EXPECT_TRUE(file.add);
    ASSERT_EQ(file.sources.size(), 7u);
    EXPECT_EQ(file.sources[4].edge_v, dvec3(0.5, 2, 0));
    EXPECT_EQ(file.sources[5].kind, SourceKind::triangle);
    EXPECT_EQ(file.sources[6].position, dvec3(1, 2, 3));
    EXPECT_EQ(file.sources[6].radius, 2);
    EXPECT_EQ(file.sources[0].kind, SourceKind::point);
    EXPECT_EQ(file.sources[0].position, dvec3(1, 2.5, -3));
    EXPECT_FALSE(file.sources[0].colour);
    EXPECT_EQ(file.sources[1].kind, SourceKind::directional);
    EXPECT_EQ(glm::normalize(file.sources[1].direction), dvec3(0, -1, 0));
    EXPECT_EQ(*file.sources[1].colour, dvec3(0.5, 1, 2));
    EXPECT_EQ(file.sources[2].kind, SourceKind::spot);
    EXPECT_EQ(file.sources[2].angle, 30);
    EXPECT_EQ(file.sources[2].falloff, 8);
    EXPECT_EQ(file.sources[3].angle, 90);
    EXPECT_EQ(file.sources[3].falloff, 1);
}

TEST(SourceFile, FaultsAreNamedWithTheirLineAndWhatWasExpected) {
    struct Case {
        const char* text;
        const char* said;
        const char* expected;
    };
    for (const Case& c :
         {Case{"", "lamps.toml: no sources", "[[source]]"},
          Case{"add = 3\n", "lamps.toml:1: 'add'", "true or false"},
          Case{"[[source]\n", "lamps.toml:1: ", "TOML"},
          Case{"lamp = 3\n", "lamps.toml:1: unknown key 'lamp'", "source"},
          Case{"source = 3\n", "lamps.toml:1: 'source'", "[[source]]"},
          Case{"[[source]]\nposition = [0, 0, 0]\n", "lamps.toml:1: 'kind' is missing", "point, directional"},
          Case{"[[source]]\nkind = 'lamp'\n", "lamps.toml:2: 'kind' is 'lamp'", "spot"},
          Case{"[[source]]\nkind = 'point'\n", "lamps.toml:1: 'position' is missing", "[x, y, z]"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, 0]\n", "lamps.toml:3: 'position'", "[x, y, z]"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, nan, 0]\n", "lamps.toml:3: 'position'",
               "[x, y, z]"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, 1e31, 0]\n", "lamps.toml:3: 'position'",
               "[x, y, z]"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, 'a', 0]\n", "lamps.toml:3: 'position'",
               "[x, y, z]"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, 0, 0]\nangle = 3\n",
               "lamps.toml:4: unknown key 'angle'", "kind, colour, position"},
          Case{"[[source]]\nkind = 'directional'\ndirection = [0, 0, 0]\n", "lamps.toml:3: 'direction' is 0",
               "not all 0"},
          Case{"[[source]]\nkind = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nangle = 0\n",
               "lamps.toml:5: 'angle'", "up to 90"},
          Case{"[[source]]\nkind = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nangle = 91\n",
               "lamps.toml:5: 'angle'", "up to 90"},
          Case{"[[source]]\nkind = 'spot'\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfalloff = -1\n",
               "lamps.toml:5: 'falloff'", "from 0"},
          Case{"[[source]]\nkind = 'sphere'\ncentre = [0, 0, 0]\n", "lamps.toml:1: 'radius' is missing",
               "above 0"},
          Case{"[[source]]\nkind = 'sphere'\ncentre = [0, 0, 0]\nradius = 0\n", "lamps.toml:4: 'radius'",
               "above 0"},
          Case{"[[source]]\nkind = 'triangle'\ncorner = [0, 0, 0]\nu = [1, 2, 3]\nv = [2, 4, 6]\n",
               "lamps.toml:5: 'u' and 'v' span no area", "apart"},
          Case{"[[source]]\nkind = 'point'\nposition = [0, 0, 0]\ncolour = [0, -1, 0]\n",
               "lamps.toml:4: 'colour'", "from 0 to 1e6"}}) {
        const std::string error = error_of(c.text);
        EXPECT_EQ(error.find(c.said), 0u) << error;
        EXPECT_NE(error.find(c.expected), std::string::npos) << error;
    }
    std::string many;
    for (std::size_t i = 0; i <= max_sources; ++i)
        many += "[[source]]\nkind = 'directional'\ndirection = [0, 0, 1]\n";
    EXPECT_NE(error_of(many).find("64 at most"), std::string::npos) << error_of(many);
}

TEST(SourceFile, ReplacesTheScenesSourcesOrAddsToThem) {
    const Folder folder;
    const auto scene = folder.write("a.nff",
                                    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\n"
                                    "resolution 64 64\nl 1 1 1\nf 1 0.5 0.2 0.7 0.3 20 0 1\ns 0 0 0 1\n");
    const auto obj = folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string lamp = "[[source]]\nkind = 'directional'\ndirection = [0, 0, 1]\n";
    const auto replace = folder.write("replace.toml", lamp);
    const auto add = folder.write("add.toml", "add = true\n" + lamp);
    Diagnostics diagnostics;
    EXPECT_EQ(load_scene(scene, {}, diagnostics, replace).sources.size(), 1u);
    const Scene both = load_scene(scene, {}, diagnostics, add);
    ASSERT_EQ(both.sources.size(), 2u);
    EXPECT_EQ(both.sources[0].kind, SourceKind::point);
    EXPECT_EQ(both.sources[1].kind, SourceKind::directional);
    // A scene without sources gets none at the viewer beside these.
    EXPECT_EQ(load_scene(obj, {}, diagnostics, add).sources.size(), 1u);
    for (const std::string& message : diagnostics.messages())
        EXPECT_EQ(message.find("at the viewer"), std::string::npos) << message;
}

}  // namespace
}  // namespace raycell
