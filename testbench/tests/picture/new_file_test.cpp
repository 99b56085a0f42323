// Sets of files that are published together: all or none, and an earlier set stays whole until then.
#include "testbench/common/new_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace raycell {
namespace {

namespace fs = std::filesystem;

class NewFiles : public ::testing::Test {
  protected:
    NewFiles() {
        std::string name = (fs::temp_directory_path() / "raycell_files_XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~NewFiles() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void put(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
    /// All files by name; a folder has the text "folder".
    std::map<std::string, std::string> all() const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::directory_iterator(folder_)) {
            std::ostringstream text;
            if (entry.is_directory()) {
                text << "folder";
            } else {
                text << std::ifstream(entry.path()).rdbuf();
            }
            files[entry.path().filename()] = text.str();
        }
        return files;
    }

    fs::path folder_;
};

using Files = std::map<std::string, std::string>;

TEST_F(NewFiles, ASetReplacesAnEarlierOneAndTakesAwayWhatIsOutdated) {
    put("a.1", "old");
    put("a.3", "old");
    OutputSet outputs(path("a"));
    outputs.announce({".1", ".2", ".3"});
    outputs.write(".1", "new");
    outputs.write(".2", "new");
    outputs.write_if(false, ".3", {});
    EXPECT_EQ(all().at("a.1"), "old") << "until it is published";
    outputs.publish();
    EXPECT_EQ(all(), (Files{{"a.1", "new"}, {"a.2", "new"}}));
}

TEST_F(NewFiles, ASetThatIsNotPublishedLeavesNothing) {
    put("a.1", "old");
    {
        OutputSet outputs(path("a"));
        outputs.announce({".1", ".2"});
        outputs.write(".1", "new");
        outputs.begin(".2").write("half");
    }
    EXPECT_EQ(all(), (Files{{"a.1", "old"}}));
}

TEST_F(NewFiles, WhereverPublishingFailsTheEarlierSetIsWhole) {
    const Files earlier = {{"a.1", "old 1"}, {"a.2", "old 2"}, {"a.3", "old 3"}};
    for (int failing = 1; failing <= 4; ++failing) {
        SCOPED_TRACE("a folder stands where file " + std::to_string(failing) + " should go");
        for (const auto& [name, text] : earlier) put(name, text);
        OutputSet outputs(path("a"));
        outputs.announce({".1", ".2", ".3", ".4"});
        outputs.write(".1", "new");
        outputs.write(".2", "new");
        outputs.write_if(false, ".3", {});
        outputs.write(".4", "new");
        const std::string blocked = "a." + std::to_string(failing);
        fs::remove(path(blocked));
        fs::create_directory(path(blocked));
        EXPECT_THROW(outputs.publish(), std::runtime_error);
        Files expected = earlier;
        expected[blocked] = "folder";
        Files there = all();
        for (auto file = there.begin(); file != there.end();)  // part files live as long as the set
            file = file->first.find(".part") != std::string::npos ? there.erase(file) : std::next(file);
        EXPECT_EQ(there, expected);
        fs::remove(path(blocked));
    }
}

TEST_F(NewFiles, WhatCannotBeWrittenIsFoundWhenItIsAnnounced) {
    fs::create_directory(path("a.folder"));
    OutputSet outputs(path("a"));
    EXPECT_THROW(outputs.announce({".folder"}), std::runtime_error);
    EXPECT_THROW(outputs.announce({std::string(250, 'x')}), std::runtime_error);
    EXPECT_THROW(OutputSet("/dev/null/a").announce({".1"}), std::runtime_error);
    outputs.announce({".1"});
    EXPECT_EQ(all(), (Files{{"a.folder", "folder"}})) << "looking leaves nothing";
    EXPECT_THROW(outputs.write(".2", "not announced"), std::logic_error);
}

TEST_F(NewFiles, AFileHasManyNames) {
    put("a", "");
    fs::create_symlink("a", path("link"));
    fs::create_hard_link(path("a"), path("hard"));
    fs::create_directory(path("folder"));
    for (const char* name : {"a", "link", "hard", "folder/../a", "./a"})
        EXPECT_TRUE(same_file(path("a"), path(name))) << name;
    EXPECT_TRUE(same_file(path("new"), path("folder/../new"))) << "also where there is none yet";
    EXPECT_FALSE(same_file(path("a"), path("new")));
}

}  // namespace
}  // namespace raycell
