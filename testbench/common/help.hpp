// How --help looks.
#pragma once

#include <CLI/CLI.hpp>

namespace raycell {

/// Breaks descriptions at 100 columns, the next lines below the first.
class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter() { column_width(width); }
    std::string make_option(const CLI::Option* option, bool is_positional) const override;

  private:
    static constexpr std::size_t width = 34;     ///< of the column of names
    static constexpr std::size_t columns = 100;  ///< of a line
};

}  // namespace raycell
