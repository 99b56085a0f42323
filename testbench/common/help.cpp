#include "testbench/common/help.hpp"

#include <sstream>

namespace raycell {

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
    std::string name = make_option_name(option, is_positional) + make_option_opts(option);
    // What a range or a list of words says already.
    const auto type = name.find("TEXT:");
    if (type != std::string::npos) name.erase(type, 5);
    std::string text = "  " + name;
    text += text.size() < width ? std::string(width - text.size(), ' ') : "\n" + std::string(width, ' ');
    std::istringstream words(make_option_desc(option));
    std::size_t column = width;
    for (std::string word; words >> word; column += word.size() + 1) {
        if (column > width && column + word.size() > columns) {
            text += "\n" + std::string(width, ' ');
            column = width;
        }
        text += (column > width ? " " : "") + word;
    }
    return text + "\n";
}

}  // namespace raycell
