#include "testbench/common/picture_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>

namespace raycell {
namespace {

namespace fs = std::filesystem;

/// A fresh folder for every test, removed at the end.
class PictureFile : public ::testing::Test {
  protected:
    PictureFile() {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(::testing::TempDir()) /
                  ("raycell-" + std::string(test->name()) + "-" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    ~PictureFile() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t files() const {
        return std::size_t(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    void put(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    }
    std::string get(const std::string& name) const {
        std::ifstream file(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    fs::path folder_;
};

Picture noise(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(-0.5f, 2.0f);
    Picture picture(width, height);
    for (Pixel& pixel : picture.pixels) {
        pixel.colour = {value(random), value(random), value(random)};
        pixel.depth = value(random) * 1000;
        pixel.normal = {value(random), value(random), value(random)};
        pixel.polygon = std::uint32_t(random());
        pixel.cycle = std::uint32_t(random());
        pixel.hops = std::uint32_t(random());
        pixel.postponed = std::uint32_t(random());
    }
    picture.at(0, 0).depth = std::numeric_limits<double>::infinity();
    picture.at(0, 0).polygon = no_polygon;
    return picture;
}

/// Runs `work` and returns the message that it throws, which must name the file.
template <class Work>
std::string message_naming(const std::string& file, Work work) {
    try {
        work();
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find(file), std::string::npos) << message;
        return message;
    }
    ADD_FAILURE() << "nothing was thrown for " << file;
    return {};
}

TEST_F(PictureFile, AnExrFileGivesBackEveryFieldInSinglePrecision) {
    const Picture before = noise(37, 21);
    write_exr(before, path("a.exr"));
    EXPECT_EQ(files(), 1u);
    std::vector<std::string> absent;
    const Picture after = read_exr(path("a.exr"), &absent);
    EXPECT_TRUE(absent.empty());
    ASSERT_EQ(after.width, 37);
    ASSERT_EQ(after.height, 21);
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
        EXPECT_EQ(after.pixels[i].colour, before.pixels[i].colour);
        EXPECT_EQ(after.pixels[i].depth, double(float(before.pixels[i].depth)));
        EXPECT_EQ(after.pixels[i].normal, before.pixels[i].normal);
        EXPECT_EQ(after.pixels[i].polygon, before.pixels[i].polygon);
        EXPECT_EQ(after.pixels[i].cycle, before.pixels[i].cycle);
        EXPECT_EQ(after.pixels[i].hops, before.pixels[i].hops);
        EXPECT_EQ(after.pixels[i].postponed, before.pixels[i].postponed);
    }
}

TEST_F(PictureFile, EqualPicturesBecomeEqualFiles) {
    write_exr(noise(16, 16), path("a.exr"));
    write_exr(noise(16, 16), path("b.exr"));
    write_png(noise(16, 16), path("a.png"));
    write_png(noise(16, 16), path("b.png"));
    EXPECT_EQ(get("a.exr"), get("b.exr"));
    EXPECT_EQ(get("a.png"), get("b.png"));
}

TEST_F(PictureFile, APngFileGivesBackEveryEightBitStepAndClampsTheRest) {
    Picture picture(256, 2);
    for (int x = 0; x < 256; ++x) {
        picture.at(x, 0).colour = dvec3(x / 255.0, 1 - x / 255.0, (x + 0.49) / 255);
        picture.at(x, 1).colour = {-5, 7, std::numeric_limits<double>::infinity()};
    }
    write_png(picture, path("a.png"));
    const Picture after = read_png(path("a.png"));
    ASSERT_EQ(after.width, 256);
    for (int x = 0; x < 256; ++x) {
        EXPECT_EQ(after.at(x, 0).colour, dvec3(x / 255.0, (255 - x) / 255.0, x / 255.0));
        EXPECT_EQ(after.at(x, 1).colour, dvec3(0, 1, 1));
    }
}

TEST_F(PictureFile, APngFileWithANumberThatIsNoneIsRefusedWithItsPixel) {
    Picture picture(3, 3);
    picture.at(2, 1).colour.g = std::numeric_limits<double>::quiet_NaN();
    const std::string message = message_naming("a.png", [&] { write_png(picture, path("a.png")); });
    EXPECT_NE(message.find("(2, 1)"), std::string::npos) << message;
    EXPECT_EQ(files(), 0u);
}

TEST_F(PictureFile, AnOlderFileIsReplacedAsAWhole) {
    write_exr(noise(8, 8), path("a.exr"));
    write_exr(noise(5, 4), path("a.exr"));
    EXPECT_EQ(read_exr(path("a.exr")).width, 5);
    EXPECT_EQ(files(), 1u);
}

TEST_F(PictureFile, AFolderThatIsMissingOrNoFolderIsAnError) {
    put("plain", "x");
    for (const char* place : {"nowhere/a", "plain/a"}) {
        message_naming(place, [&] { write_exr(noise(2, 2), path(place) + ".exr"); });
        message_naming(place, [&] { write_png(noise(2, 2), path(place) + ".png"); });
    }
    EXPECT_EQ(files(), 1u);
}

TEST_F(PictureFile, ADeviceOrFolderOfThatNameIsNotReplaced) {
    fs::create_directory(path("a.exr"));
    message_naming("a.exr", [&] { write_exr(noise(2, 2), path("a.exr")); });
    message_naming("/dev/null", [&] { write_png(noise(2, 2), "/dev/null"); });
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(files(), 1u);
}

TEST_F(PictureFile, ADiskThatFillsUpIsAnErrorAndLeavesTheOlderFile) {
    put("a.exr", "older");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{3000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string exr = message_naming("a.exr", [&] { write_exr(noise(200, 200), path("a.exr")); });
    const std::string png = message_naming("a.png", [&] { write_png(noise(200, 200), path("a.png")); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(get("a.exr"), "older");
    EXPECT_EQ(files(), 1u);
}

TEST_F(PictureFile, AFileThatIsMissingOrOfAnotherKindIsAnError) {
    message_naming("none.exr", [&] { read_exr(path("none.exr")); });
    message_naming("none.png", [&] { read_png(path("none.png")); });
    put("text", "this is neither\n");
    put("empty", "");
    for (const char* name : {"text", "empty"}) {
        message_naming(name, [&] { read_exr(path(name)); });
        message_naming(name, [&] { read_png(path(name)); });
    }
    write_png(noise(4, 4), path("a.png"));
    message_naming("a.png", [&] { read_exr(path("a.png")); });
}

TEST_F(PictureFile, ATruncatedFileIsAnErrorWhereverItEnds) {
    write_exr(noise(40, 40), path("a.exr"));
    write_png(noise(40, 40), path("a.png"));
    const std::string exr = get("a.exr"), png = get("a.png");
    for (const double share : {0.001, 0.01, 0.1, 0.3, 0.6, 0.9, 0.99}) {
        put("cut.exr", exr.substr(0, std::size_t(double(exr.size()) * share)));
        put("cut.png", png.substr(0, std::size_t(double(png.size()) * share)));
        message_naming("cut.exr", [&] { read_exr(path("cut.exr")); });
        message_naming("cut.png", [&] { read_png(path("cut.png")); });
    }
}

TEST_F(PictureFile, AFileWithRandomDamageIsReadOrRefusedButNeverCrashes) {
    constexpr unsigned seed = 5;
    std::mt19937 random(seed);
    write_exr(noise(24, 24), path("a.exr"));
    write_png(noise(24, 24), path("a.png"));
    const std::string exr = get("a.exr"), png = get("a.png");
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", file " + std::to_string(i));
        for (const bool is_exr : {true, false}) {
            std::string bytes = is_exr ? exr : png;
            // Mostly in the header, which holds sizes and names.
            const std::size_t reach = i % 3 ? 400 : bytes.size();
            for (int k = 0; k < 1 + i % 4; ++k)
                bytes[random() % std::min(reach, bytes.size())] = char(random());
            put("damaged", bytes);
            try {
                is_exr ? read_exr(path("damaged")) : read_png(path("damaged"));
            } catch (const std::runtime_error&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 100);
}

TEST_F(PictureFile, AnExrFileWithoutColourIsRefusedAndOtherChannelsMayBeAbsent) {
    // Renaming channels inside the file makes them unknown to the reader.
    write_exr(noise(8, 8), path("a.exr"));
    std::string bytes = get("a.exr");
    const std::size_t hops = bytes.find(std::string("hops\0", 5));
    ASSERT_NE(hops, std::string::npos);
    bytes.replace(hops, 4, "hopz");
    put("b.exr", bytes);
    std::vector<std::string> absent;
    const Picture picture = read_exr(path("b.exr"), &absent);
    EXPECT_EQ(absent, std::vector<std::string>{"hops"});
    EXPECT_EQ(picture.at(3, 3).hops, 0u);
    EXPECT_EQ(picture.at(3, 3).polygon, noise(8, 8).at(3, 3).polygon);

    const std::size_t green = bytes.find(std::string("\0G\0", 3));
    ASSERT_NE(green, std::string::npos);
    bytes[green + 1] = 'H';
    put("c.exr", bytes);
    const std::string message = message_naming("c.exr", [&] { read_exr(path("c.exr")); });
    EXPECT_NE(message.find("no channel G"), std::string::npos) << message;
}

TEST_F(PictureFile, ThePictureOfAnImpossibleSizeIsRefused) {
    message_naming("a.exr", [&] { write_exr(Picture(), path("a.exr")); });
    Picture wide;
    wide.width = longest_side + 1;
    wide.height = 1;
    wide.pixels.resize(std::size_t(wide.width));
    message_naming("a.png", [&] { write_png(wide, path("a.png")); });
    EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace raycell
