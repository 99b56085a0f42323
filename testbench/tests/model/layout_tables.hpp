// The tables of message layouts in the documents.
#pragma once

#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace raycell {

/// The rows "| `field` | bits | ..." below a heading of docs/reference/messages.md, up to the next heading.
inline std::vector<std::pair<std::string, int>> layout_table(const std::string& heading) {
    std::ifstream file(RAYCELL_SOURCE_DIR "/docs/reference/messages.md");
    std::vector<std::pair<std::string, int>> rows;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("#", 0) == 0) inside = line == heading;
        if (!inside || line.rfind("| `", 0) != 0) continue;
        const auto end = line.find("` | ");
        rows.emplace_back(line.substr(3, end - 3), std::stoi(line.substr(end + 4)));
    }
    return rows;
}

}  // namespace raycell
