// The timed and the untimed machine give the same picture, bit for bit (invariant 1), tested on the program.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Renders with both engines and compares everything that must not depend on time.
void expect_equal_engines(const Workshop& workshop, const fs::path& scene, const Words& words) {
    std::string line;
    for (const std::string& word : words) line += " " + word;
    SCOPED_TRACE(scene.filename().string() + line);
    const Json timed = workshop.report(scene, words, 0, "timed");
    const Json untimed = workshop.report(scene, joined(words, {"--engine", "untimed"}), 0, "untimed");
    if (timed.is_null() || untimed.is_null()) return;
    EXPECT_EQ(image(timed), image(untimed));
    EXPECT_EQ(timed.at("rays"), untimed.at("rays"));
    EXPECT_EQ(timed.at("voxels"), untimed.at("voxels"));
    if (timed.at("deadlock").at("postponed") == 0) {
        // A postponed ray crosses its links again, so hops are only equal without one.
        EXPECT_EQ(timed.at("hops").at("ray"), untimed.at("hops").at("ray"));
        EXPECT_EQ(timed.at("hops").at("return"), untimed.at("hops").at("return"));
        EXPECT_EQ(timed.at("precast").at("hops"), untimed.at("precast").at("hops"));
        EXPECT_EQ(timed.at("precast").at("hops") > 0, timed.at("rays").at("precast") > 0);
    }
}

const std::string own_scenes[] = {"cornell.nff", "facing_mirrors.nff", "still_life.nff"};

// ---- options, on the project's own scenes

class TimedEqualsUntimed : public ::testing::TestWithParam<Words> {};

TEST_P(TimedEqualsUntimed, OnOwnScenes) {
    const Workshop workshop;
    for (const std::string& scene : own_scenes) expect_equal_engines(workshop, own_scene(scene), GetParam());
}

std::string name_of_words(const ::testing::TestParamInfo<Words>& test) {
    std::string name;
    for (const std::string& word : test.param) {
        for (const char c : word) {
            if (std::isalnum(static_cast<unsigned char>(c))) name += c;
        }
        name += '_';
    }
    name.pop_back();
    return name;
}

INSTANTIATE_TEST_SUITE_P(
    With, TimedEqualsUntimed,
    ::testing::Values(
        Words{"--cells", "48x32"}, Words{"--cells", "32x48"}, Words{"--cells", "40x1"},
        Words{"--cells", "1x40"}, Words{"--cells", "1x1"}, Words{"--cells", "32x32", "--hit", "mask"},
        Words{"--cells", "32x32", "--hit", "plane"}, Words{"--cells", "32x32", "--hit", "interval"},
        Words{"--cells", "32x32", "--hit", "depth"},
        Words{"--cells", "32x32", "--hit", "depth", "--depth", "1"},
        Words{"--cells", "32x32", "--depth", "65536"}, Words{"--cells", "32x32", "--normals", "voxel"},
        Words{"--cells", "32x32", "--shadows", "precast"}, Words{"--cells", "32x32", "--shadows", "memo"},
        Words{"--cells", "32x32", "--shadows", "memo", "--hit", "interval", "--exterior", "none"},
        Words{"--cells", "32x32", "--exterior", "none"}, Words{"--cells", "32x32", "--viewer", "infinity"},
        Words{"--cells", "32x32", "--max-depth", "0"},
        Words{"--cells", "32x32", "--max-depth", "7", "--min-weight", "0"},
        Words{"--cells", "32x32", "--normal-offset", "0.05"},
        Words{"--cells", "32x32", "--arithmetic", "exact"},
        Words{"--cells", "32x32", "--arithmetic", "exact", "--hit", "mask", "--shadows", "memo"},
        Words{"--cells", "32x32", "--word-bits", "12"}, Words{"--cells", "32x32", "--word-bits", "32"},
        Words{"--cells", "32x32", "--rounding", "truncate", "--power", "schlick"}),
    name_of_words);

class LoadedEqualsUntimed : public ::testing::TestWithParam<Words> {};

TEST_P(LoadedEqualsUntimed, OnOwnScenes) {
    const Workshop workshop;
    for (const std::string& scene : own_scenes) {
        expect_equal_engines(workshop, own_scene(scene),
                             joined({"--cells", "32x32", "--stage", "load"}, GetParam()));
    }
}

INSTANTIATE_TEST_SUITE_P(With, LoadedEqualsUntimed,
                         ::testing::Values(Words{"--display", "phong"}, Words{"--display", "gouraud"},
                                           Words{"--normals", "voxel", "--hit", "plane"},
                                           Words{"--arithmetic", "exact"}, Words{"--exterior", "none"}),
                         name_of_words);

TEST(Engines, AMachineWithoutRoomForItsVoxelsStillGivesTheUntimedPicture) {
    const Workshop workshop;
    const Words words = {"--cells", "32x32", "--voxel-capacity", "2"};
    const Json timed = workshop.report(own_scene("still_life.nff"), words, 4);
    const Json untimed =
        workshop.report(own_scene("still_life.nff"), joined(words, {"--engine", "untimed"}), 4, "b");
    EXPECT_EQ(image(timed), image(untimed));
    EXPECT_EQ(timed.at("voxels"), untimed.at("voxels"));
}

TEST(Engines, BitsAskedForWhenFirstHitGiveThePictureOfBitsCastBefore) {
    const Workshop workshop;
    for (const std::string& scene : own_scenes) {
        for (const std::string engine : {"timed", "untimed"}) {
            for (const std::string hit : {"edge", "interval"}) {
                SCOPED_TRACE(scene + " " + engine + " " + hit);
                const Words words = {"--cells", "32x32", "--engine", engine, "--hit", hit};
                const Json memo = workshop.report(own_scene(scene), joined(words, {"--shadows", "memo"}));
                const Json precast =
                    workshop.report(own_scene(scene), joined(words, {"--shadows", "precast"}), 0, "b");
                EXPECT_EQ(image(memo), image(precast));
            }
        }
    }
}

/// A ball and a glass pane over a floor, all lengths multiplied by `scale`.
std::string scaled_scene(double scale) {
    std::string text = "b 0.2 0.3 0.4\nv\n";
    const auto add = [&](const std::string& word, const std::vector<double>& lengths) {
        text += word;
        for (const double length : lengths) {
            char number[40];
            std::snprintf(number, sizeof number, " %.17g", length * scale);
            text += number;
        }
        text += '\n';
    };
    add("from", {1, 2, 6});
    add("at", {0, 0.5, 0});
    text += "up 0 1 0\nangle 40\n";
    add("hither", {0.125});
    text += "resolution 64 64\n";
    add("l", {5, 6, 4});
    add("l", {-4, 3, 5});
    text += "f 0.8 0.7 0.6 0.8 0.2 10 0 1\np 4\n";
    for (const auto& corner : {std::vector<double>{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}})
        add("", corner);
    text += "f 1 0.5 0.2 0.6 0.4 30 0 1\n";
    add("s", {0.25, 0.75, -0.5, 0.75});
    text += "f 1 1 1 0.1 0.1 50 0.8 1.5\np 3\n";
    for (const auto& corner : {std::vector<double>{-1, 0, 1}, {1, 0, 1.25}, {0, 1.5, 1}}) add("", corner);
    return text;
}

TEST(Engines, APictureDoesNotDependOnTheUnitOfLength) {
    // Powers of two, so that not even rounding differs.
    const Workshop workshop;
    const Words words = {"--cells", "32x24"};
    const std::string first = image(workshop.report(workshop.write("unit.nff", scaled_scene(1)), words));
    for (const int power : {-60, -20, -1, 1, 20, 60}) {
        SCOPED_TRACE("2^" + std::to_string(power));
        const fs::path scene = workshop.write("scaled.nff", scaled_scene(std::ldexp(1.0, power)));
        EXPECT_EQ(image(workshop.report(scene, words)), first);
    }
}

// ---- every scene, as it is

std::vector<std::string> names_in(const std::string& folder, const std::string& extension) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(shared_scenes() / folder, ignored)) {
        if (entry.path().extension() == extension)
            names.push_back(folder + "/" + entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> every_shared_scene() {
    std::vector<std::string> names = names_in("spd", ".nff");
    const std::vector<std::string> objects = names_in("obj", ".obj");
    names.insert(names.end(), objects.begin(), objects.end());
    if (names.empty()) names.push_back("missing");
    return names;
}

class EverySharedScene : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySharedScene, IsTheSamePictureTimedAndUntimed) {
    SKIP_WITHOUT_SHARED_SCENES();
    const Workshop workshop;
    expect_equal_engines(workshop, shared_scenes() / GetParam(), {"--cells", "64x64"});
}

INSTANTIATE_TEST_SUITE_P(Shared, EverySharedScene, ::testing::ValuesIn(every_shared_scene()),
                         [](const ::testing::TestParamInfo<std::string>& test) {
                             std::string name = test.param.substr(test.param.find('/') + 1);
                             for (char& c : name) {
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             }
                             return name;
                         });

TEST(Bound, OfTheTraceIsTheTreeItselfInAnArrayOfOneCell) {
    const Workshop workshop;
    const Json one = workshop.report(own_scene("cornell.nff"), {"--cells", "1x1"});
    EXPECT_EQ(one.at("bound").at("trace").at("of"), "the tree of pixel (0, 0) alone");
    EXPECT_EQ(one.at("bound").at("trace").at("cycles"), one.at("cycles").at("trace"));
    EXPECT_GT(one.at("cycles").at("trace").get<int>(), 0);
}

TEST(Bound, IsNoLongerThanTheRun) {
    const Workshop workshop;
    for (const Words& words :
         {Words{}, Words{"--shadows", "memo"}, Words{"--ray-store", "5", "--max-depth", "6"},
          Words{"--traversal-units", "4", "--loading-units", "4", "--buffer", "4"}}) {
        const Json run = workshop.report(own_scene("still_life.nff"), joined({"--cells", "16x16"}, words));
        for (const char* phase : {"load", "trace"})
            EXPECT_LE(run.at("bound").at(phase).at("cycles").get<int>(),
                      run.at("cycles").at(phase).get<int>());
    }
}

}  // namespace
}  // namespace raycell::system_test
