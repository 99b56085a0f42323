#include "testbench/common/svg.hpp"

namespace raycell {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '\'')
            out += "&apos;";
        else
            out += c;
    }
    return out;
}

void begin_svg(std::ostream& svg, double width, double height, const std::string& style) {
    svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
        << "' font-family='sans-serif' font-size='12'>\n<style>" << style << "</style>\n<rect width='"
        << width << "' height='" << height << "' fill='#fff'/>\n";
}

void put_text(std::ostream& svg, double x, double y, const std::string& text, const char* anchor) {
    svg << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "'>" << escaped(text)
        << "</text>\n";
}

}  // namespace raycell
