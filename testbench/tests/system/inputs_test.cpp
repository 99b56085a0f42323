// Input files: pipes and devices, saved arrays with wrong fields, polygons with very many corners.
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <random>

#include "model/numbers/hash.hpp"
#include "program.hpp"

namespace raycell::system_test {
namespace {

const std::string ball =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 8 8\nl 5 5 5\nf 1 1 1 1 0 1 0 1\ns "
    "0 0 0 1\n";

/// A program and arguments that read a file; the word FILE stands for its name.
struct Place {
    std::string program;
    std::string ending;
    Words words;
};
std::vector<Place> places(const std::string& scene) {
    const Words out = {"--cells", "8x8", "-o", "results/a"};
    const std::string cell_tb = RAYCELL_CELL_TB;
    const std::string raycell = RAYCELL_PROGRAM;
    return {{raycell, ".nff", joined({"render", "FILE"}, out)},
            {raycell, ".obj", joined({"render", "FILE"}, out)},
            {raycell, ".nff", joined({"render", scene, "--view", "FILE"}, out)},
            {raycell, ".toml", joined({"render", scene, "--config", "FILE"}, out)},
            {raycell, ".array", joined({"render", scene, "--load-array", "FILE"}, out)},
            {raycell, ".nff", joined({"truth", "FILE"}, out)},
            {raycell, ".nff", joined({"size", "FILE", "--psnr", "30"}, out)},
            {raycell, ".exr", {"compare", "FILE", "FILE"}},
            {raycell, ".png", {"compare", "FILE", "FILE"}},
            {cell_tb, ".txt", {"--replay", "FILE"}}};
}

void expect_refused(const Workshop& workshop, const Place& place, const std::string& file,
                    const std::string& said) {
    Words words = place.words;
    std::string line = place.program;
    for (std::string& word : words) line += " " + (word == "FILE" ? word = file : word);
    SCOPED_TRACE(line);
    const Finished finished = workshop.run_program(place.program, words, 60);
    EXPECT_FALSE(finished.timed_out) << "it waits for the other end";
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_TRUE(contains(finished.err, file)) << finished.err;
    EXPECT_TRUE(contains(finished.err, said)) << finished.err;
    EXPECT_EQ(workshop.results(), Words());
}

TEST(Inputs, AreRegularFilesOrRefusedAtOnce) {
    const Workshop workshop;
    const std::string scene = workshop.write("ball.nff", ball).string();
    for (const Place& place : places(scene)) {
        const fs::path pipe = workshop.path() / ("pipe" + place.ending);
        mkfifo(pipe.c_str(), 0600);
        const fs::path zero = workshop.path() / ("zero" + place.ending);
        if (!fs::is_symlink(zero)) fs::create_symlink("/dev/zero", zero);
        const fs::path folder = workshop.path() / ("folder" + place.ending);
        fs::create_directories(folder);
        expect_refused(workshop, place, pipe.string(), "is a device, pipe or socket");
        expect_refused(workshop, place, zero.string(), "is a device, pipe or socket");
        expect_refused(workshop, place, folder.string(), "is a directory");
        expect_refused(workshop, place, (workshop.path() / ("none" + place.ending)).string(), "no such file");
    }
}

TEST(Inputs, ALibraryThatIsAPipeIsNotOpenedAndTheModelIsDrawn) {
    const Workshop workshop;
    mkfifo((workshop.path() / "m.mtl").c_str(), 0600);
    const auto scene =
        workshop.write("a.obj", "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    const Finished finished = workshop.render(scene, {"--cells", "8x8"}, "a", 60);
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(contains(finished.err, "'m.mtl' is a device, pipe or socket")) << finished.err;
}

/// A saved array as its 64-bit words; the last is a checksum of the others.
std::vector<std::uint64_t> numbers_of(const std::string& bytes) {
    std::vector<std::uint64_t> numbers(bytes.size() / 8);
    std::memcpy(numbers.data(), bytes.data(), 8 * numbers.size());
    return numbers;
}
std::string bytes_of(std::vector<std::uint64_t> numbers) {
    Fnv hash;
    for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
        hash.add(numbers[i]);
        hash.fold(29);
    }
    numbers.back() = hash.value();
    return std::string(reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size());
}

std::uint64_t seed() {
    const char* given = std::getenv("RAYCELL_TEST_SEED");
    return given ? std::strtoull(given, nullptr, 10) : 1;
}

TEST(Inputs, ASavedArrayWithAWrongNumberAndARightChecksumNeverCrashes) {
    const Workshop workshop;
    const auto scene = own_scene("still_life.nff");
    const Words words = {"--cells", "8x6", "--max-cycles", "10000000"};
    ASSERT_EQ(workshop.render(scene, joined(words, {"--save-array", "array"})).exit_code, 0);
    const std::vector<std::uint64_t> whole = numbers_of(read_text(workshop.path() / "array"));
    ASSERT_EQ(bytes_of(whole), read_text(workshop.path() / "array")) << "the checksum is as it was";
    const double nan = std::nan("");
    std::uint64_t not_a_number = 0;
    std::memcpy(&not_a_number, &nan, sizeof nan);
    std::cout << "seed " << seed() << " (RAYCELL_TEST_SEED)\n";
    std::mt19937_64 random(seed());
    int refused = 0;
    constexpr int runs = 60;
    for (int i = 0; i < runs; ++i) {
        std::vector<std::uint64_t> numbers = whole;
        const std::size_t at = random() % (i % 3 == 0 ? 300 : numbers.size() - 1);
        const std::uint64_t values[] = {0,        1,   3,        255,       ~std::uint64_t(0), not_a_number,
                                        1u << 31, ~0u, random(), 1ULL << 62};
        numbers[at] = values[random() % std::size(values)];
        workshop.write("wrong", bytes_of(numbers));
        const Finished finished = workshop.render(scene, joined(words, {"--load-array", "wrong"}), "b");
        SCOPED_TRACE("number " + std::to_string(at) + " as " + std::to_string(numbers[at]));
        ASSERT_EQ(finished.signal, 0) << finished.err;
        ASSERT_GE(finished.exit_code, 0);
        if (finished.exit_code != 1) continue;
        ++refused;
        EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
        EXPECT_TRUE(contains(finished.err, "array")) << finished.err;
    }
    EXPECT_GT(refused, runs / 4);
}

/// A flat star as an NFF polygon, or, with normals, as a patch.
std::string star(int corners, bool with_normals) {
    std::string text = (with_normals ? "pp " : "p ") + std::to_string(corners) + "\n";
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::acos(-1.0) * (i + 0.25) / corners;
        const double radius = i % 2 ? 0.5 : 1.0;
        char line[128];
        std::snprintf(line, sizeof line, "%.9g %.9g 0%s\n", radius * std::cos(angle),
                      radius * std::sin(angle), with_normals ? " 0 0 1" : "");
        text += line;
    }
    return text;
}

/// Work quadratic in the number of corners takes seconds; cubic work would exceed the time limit.
TEST(Inputs, APolygonOfManyCornersIsLoaded) {
    const Workshop workshop;
    const std::string view = ball.substr(0, ball.find("s 0"));
    const Words words = {"--cells", "16x16", "--stage", "load", "--engine"};
    const auto flat = workshop.write("flat.nff", view + star(30000, false));
    const auto patch = workshop.write("patch.nff", view + star(12000, true));
    for (const fs::path& scene : {flat, patch}) {
        const Finished finished = workshop.render(scene, joined(words, {"untimed"}), "a", 250);
        EXPECT_FALSE(finished.timed_out);
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
    }
}

}  // namespace
}  // namespace raycell::system_test
