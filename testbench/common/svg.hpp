// Pieces of SVG pictures.
#pragma once

#include <ostream>
#include <string>

namespace raycell {

/// Text as it stands between tags and in attributes.
std::string escaped(const std::string& text);

/// A white page of so many pixels; `style`: rules of CSS. To be closed with </svg>.
void begin_svg(std::ostream& svg, double width, double height, const std::string& style);

/// `anchor`: start, middle or end of the text stands at x.
void put_text(std::ostream& svg, double x, double y, const std::string& text, const char* anchor = "start");

}  // namespace raycell
