// The rooms depend on each other one way only.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;

std::string offenders(const std::string& room, const std::vector<std::string>& forbidden) {
    std::string found;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RAYCELL_SOURCE_DIR) / room)) {
        const auto extension = entry.path().extension();
        if (extension != ".hpp" && extension != ".cpp") continue;
        std::ifstream file(entry.path());
        std::string line;
        while (std::getline(file, line)) {
            if (line.rfind("#include", 0) != 0) continue;
            for (const std::string& word : forbidden) {
                if (line.find(word) != std::string::npos) found += entry.path().filename().string() + ": " + line + "\n";
            }
        }
    }
    return found;
}

TEST(Layering, NothingInModelOrScenesIncludesSystemC) {
    const std::vector<std::string> forbidden = {"systemc", "sysc/", "tlm"};
    EXPECT_EQ(offenders("model", forbidden), "");
    EXPECT_EQ(offenders("scenes", forbidden), "");
}

TEST(Layering, NoRoomIncludesOneAboveIt) {
    EXPECT_EQ(offenders("model", {"\"cells/", "\"pipeline/", "\"testbench/", "\"scenes/"}), "");
    EXPECT_EQ(offenders("scenes", {"\"cells/", "\"pipeline/", "\"testbench/"}), "");
    EXPECT_EQ(offenders("cells", {"\"pipeline/", "\"testbench/", "\"scenes/"}), "");
    EXPECT_EQ(offenders("pipeline", {"\"testbench/", "\"scenes/"}), "");
}

}  // namespace
