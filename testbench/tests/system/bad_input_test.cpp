// Malformed and extreme scenes, end to end: each gets the treatment that scenes/bad/README promises.
#include <cmath>
#include <cstdio>

#include "limited.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

constexpr double most_seconds = 1;      ///< of processor time, for a refusal; measured: 0.01 s and 14 MB
constexpr double most_megabytes = 100;  ///< also for a picture of 32x32; measured: 36 MB at most
constexpr double most_seconds_to_render = 5;  ///< the promise bounds refusals only; measured: 0.3 s

struct BadCase {
    std::string file;
    std::string treatment;
};
void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.file << ' ' << bad.treatment; }

/// The table of the README: file, treatment, explanation.
std::vector<BadCase> cases() {
    std::vector<BadCase> all;
    std::istringstream readme(read_text(shared_scenes() / "bad" / "README"));
    std::string line;
    while (std::getline(readme, line)) {
        std::istringstream words(line);
        BadCase bad;
        words >> bad.file >> bad.treatment;
        const bool scene = contains(bad.file, ".nff") || contains(bad.file, ".obj");
        if (scene) all.push_back(bad);
    }
    if (all.empty()) all.push_back({"missing", "SKIP"});
    return all;
}

bool without_nan(const Picture& picture) {
    for (const Pixel& pixel : picture.pixels) {
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(pixel.colour[c]) || !std::isfinite(pixel.normal[c])) return false;
        }
        if (std::isnan(pixel.depth)) return false;
    }
    return true;
}

/// Expects "FILE:LINE: what; expected ..." in one line.
void expect_names_file_and_line(const std::string& message, const std::string& file) {
    const std::size_t at = message.find(file + ":");
    ASSERT_NE(at, std::string::npos) << message;
    const std::size_t digits = at + file.size() + 1;
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(message[digits]))) << message;
    EXPECT_TRUE(contains(message, "; expected ")) << message;
}

void expect_printable(const std::string& text) {
    for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << "byte " << int(c);
}

class BadInput : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadInput, GetsTheTreatmentThatItsReadmePromises) {
    SKIP_WITHOUT_SHARED_SCENES();
    const BadCase& bad = GetParam();
    const fs::path scene = shared_scenes() / "bad" / bad.file;
    ASSERT_TRUE(fs::exists(scene));
    const Workshop workshop;
    Words words = {"--cells", "32x32"};
    // An OBJ has no view, which causes a note. A file that must be read silently gets a view.
    if (bad.treatment == "ACCEPT" && scene.extension() == ".obj") {
        words.push_back("--view");
        words.push_back(workshop.write("view.nff",
                                       "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\n"
                                       "resolution 64 64\nl 5 5 5\n"));
    }
    const Finished finished = workshop.render(scene, words);
    std::printf("%-36s %-7s exit %d %7.0f ms %6.1f MB\n", bad.file.c_str(), bad.treatment.c_str(),
                finished.exit_code, finished.seconds * 1e3, finished.megabytes);
    RecordProperty("scene", bad.file);
    RecordProperty("treatment", bad.treatment);
    RecordProperty("exit_code", finished.exit_code);
    RecordProperty("milliseconds", int(std::lround(finished.seconds * 1e3)));
    RecordProperty("megabytes", int(std::lround(finished.megabytes)));

    EXPECT_EQ(finished.signal, 0) << "it crashed";
    expect_printable(finished.err);
    if (!sanitized) {
        EXPECT_LT(finished.megabytes, most_megabytes);
    }
    if (bad.treatment == "REJECT") {
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
        expect_names_file_and_line(finished.err, bad.file);
        EXPECT_EQ(workshop.results(), std::vector<std::string>());
        if (!sanitized) {
            EXPECT_LT(finished.seconds, most_seconds);
        }
        return;
    }
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    if (!sanitized) {
        EXPECT_LT(finished.seconds, most_seconds_to_render);
    }
    EXPECT_TRUE(without_nan(read_exr(workshop.result("a.exr"))));
    if (bad.treatment == "WARN") {
        EXPECT_TRUE(contains(finished.err, "warning: ")) << finished.err;
    } else {
        EXPECT_EQ(finished.err, "");
    }
}

INSTANTIATE_TEST_SUITE_P(Shared, BadInput, ::testing::ValuesIn(cases()),
                         [](const ::testing::TestParamInfo<BadCase>& test) {
                             std::string name = test.param.file;
                             for (char& c : name) {
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             }
                             return name;
                         });

TEST(Input, AnObjSceneWithoutAViewGetsOneNoteAndNoMore) {
    const Workshop workshop;
    const auto scene = workshop.write("a.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    const Finished finished = workshop.render(scene, {"--cells", "8x8"});
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_TRUE(contains(finished.err, "note: no view given")) << finished.err;
}

TEST(Input, ASceneWithoutObjectsIsAPictureOfItsBackground) {
    const Workshop workshop;
    const auto scene = workshop.write(
        "empty.nff",
        "b 0.25 0.5 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\n");
    for (const std::string engine : {"timed", "untimed"}) {
        const Finished finished = workshop.render(scene, {"--cells", "8x8", "--engine", engine});
        ASSERT_EQ(finished.exit_code, 0) << finished.err;
        for (const Pixel& pixel : read_exr(workshop.result("a.exr")).pixels) {
            ASSERT_EQ(pixel.colour, dvec3(0.25, 0.5, 1));
            ASSERT_EQ(pixel.polygon, no_polygon);
        }
    }
}

#ifndef __SANITIZE_ADDRESS__
TEST(Input, AnArrayThatNoMemoryHoldsIsRefusedAtOnce) {
    const Workshop workshop;
    const auto scene = workshop.write(
        "ball.nff",
        "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\nl 5 5 5\ns 0 0 0 1\n");
    const Finished finished =
        run_within(4000, workshop, RAYCELL_PROGRAM,
                   {"render", scene.string(), "--cells", "4096x4096", "-o", "results/a"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "--cells: ")) << finished.err;
    EXPECT_EQ(workshop.results(), std::vector<std::string>());
}
#endif

}  // namespace
}  // namespace raycell::system_test
