// Folders depend on each other one way only.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Sub-folders of each top-level folder ("room"), lowest first: each may include those before it. "." is the
/// room itself. A sub-folder that is not listed is an error.
const std::map<std::string, std::vector<std::string>> sub_folders = {
    {"model",
     {"settings", "numbers", "geometry", "shading", "loading", "picture", "files", "tracing", "microcode",
      "machine", "truth"}},
    {"cells", {"memory", "clock", "channels", "meters", "units", ".", "hosts", "deadlock", "probes"}},
    {"pipeline", {"ranks", "stages", "."}},
    {"scenes", {"."}},
};

/// The other rooms that files of each room may include.
const std::map<std::string, std::vector<std::string>> rooms_below = {
    {"model", {}},
    {"cells", {"model"}},
    {"pipeline", {"cells", "model"}},
    {"scenes", {"model"}},
};

std::string first_of(const fs::path& path) {
    return path.begin() == path.end() ? "." : path.begin()->string();
}

/// Position of a file's sub-folder in the list of its room, or -1.
int place_of(const std::string& room, const fs::path& file_in_room) {
    const std::string folder =
        file_in_room.has_parent_path() ? first_of(file_in_room.parent_path()) : std::string(".");
    const auto& order = sub_folders.at(room);
    const auto at = std::find(order.begin(), order.end(), folder);
    return at == order.end() ? -1 : int(at - order.begin());
}

/// One line for each include that breaks the order and for each file in no listed folder.
std::string offenders(const fs::path& top, const std::string& room) {
    std::string found;
    for (const auto& entry : fs::recursive_directory_iterator(top / room)) {
        const auto extension = entry.path().extension();
        if (extension != ".hpp" && extension != ".cpp") continue;
        const fs::path file = fs::relative(entry.path(), top / room);
        const int place = place_of(room, file);
        if (place < 0) found += (room / file).string() + " is in no folder of the list\n";
        std::ifstream in(entry.path());
        std::string line;
        while (std::getline(in, line)) {
            if (line.rfind("#include \"", 0) != 0) continue;
            const fs::path target = line.substr(10, line.find('"', 10) - 10);
            const std::string other = first_of(target);
            const auto& below = rooms_below.at(room);
            const bool allowed = other == room ? place_of(room, fs::relative(target, room)) <= place &&
                                                     place_of(room, fs::relative(target, room)) >= 0
                                               : std::find(below.begin(), below.end(), other) != below.end();
            if (!allowed) found += (room / file).string() + " includes " + target.string() + "\n";
        }
    }
    return found;
}

TEST(Layering, NoFileIncludesOneOfAFolderAboveItsOwn) {
    for (const auto& [room, order] : sub_folders) EXPECT_EQ(offenders(RAYCELL_SOURCE_DIR, room), "");
}

TEST(Layering, NothingInModelOrScenesIncludesSystemC) {
    for (const std::string room : {"model", "scenes"}) {
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(RAYCELL_SOURCE_DIR) / room)) {
            if (!entry.is_regular_file()) continue;
            std::ifstream in(entry.path());
            std::string line;
            while (std::getline(in, line)) {
                const bool includes = line.rfind("#include", 0) == 0;
                for (const std::string word : {"systemc", "sysc/", "tlm"})
                    EXPECT_FALSE(includes && line.find(word) != std::string::npos) << entry.path() << line;
            }
        }
    }
}

/// The offenders in a tree of one file that includes another.
std::string found_when(const std::string& file, const std::string& includes) {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    const fs::path top = fs::path(::testing::TempDir()) / ("raycell_" + name);
    const fs::path room = first_of(file);
    fs::remove_all(top);
    fs::create_directories((top / file).parent_path());
    std::ofstream(top / file) << "#pragma once\n#include <vector>\n#include \"" << includes << "\"\n";
    const std::string found = offenders(top, room.string());
    fs::remove_all(top);
    return found;
}

TEST(Layering, AnIncludeAgainstTheOrderIsFoundBetweenRoomsAndBetweenTheirFolders) {
    EXPECT_EQ(found_when("model/tracing/a.hpp", "cells/cell.hpp"),
              "model/tracing/a.hpp includes cells/cell.hpp\n");
    EXPECT_EQ(found_when("model/numbers/a.hpp", "model/tracing/b.hpp"),
              "model/numbers/a.hpp includes model/tracing/b.hpp\n");
    EXPECT_EQ(found_when("cells/units/a.cpp", "cells/cell.hpp"),
              "cells/units/a.cpp includes cells/cell.hpp\n");
    EXPECT_EQ(found_when("cells/new/a.cpp", "model/tracing/b.hpp"),
              "cells/new/a.cpp is in no folder of the list\n");
    EXPECT_EQ(found_when("cells/cell.cpp", "cells/units/a.hpp"), "");
}

}  // namespace
