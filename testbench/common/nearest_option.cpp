#include "testbench/common/nearest_option.hpp"

#include <algorithm>
#include <vector>

namespace raycell {
namespace {

/// Letters to be changed, added, left out or swapped with their neighbour.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            d[i][j] = std::min({change, d[i - 1][j] + 1, d[i][j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_option(const CLI::App& app, const std::string& word) {
    if (word.rfind("--", 0) != 0) return "";
    const std::string name =
        word.substr(2, word.find('=') == std::string::npos ? word.npos : word.find('=') - 2);
    std::string nearest;
    std::size_t least = name.size() > 4 ? 3 : 2;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& known : option->get_lnames()) {
            const bool begins = name.size() > 2 && known.rfind(name, 0) == 0;
            const std::size_t far = begins ? 0 : distance(name, known);
            if (far >= least) continue;
            least = far;
            nearest = "--" + known;
            if (begins) return nearest;
        }
    }
    return nearest;
}

}  // namespace raycell
