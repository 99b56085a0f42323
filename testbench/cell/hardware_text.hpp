// What the packages and lists that cell_tb writes for hardware have in common.
#pragma once

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>

#include "testbench/microcode/image.hpp"

namespace raycell {

/// A name as SystemVerilog's constants have it.
inline std::string constant_name(std::string name) {
    name = name_in_file(name);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return name;
}

/// Bits that tell so many things apart, one at least.
inline int bits_of(std::size_t count) {
    int bits = 1;
    while ((std::size_t(1) << bits) < count) ++bits;
    return bits;
}

/// A SystemVerilog package of numbers.
class PackageText {
  public:
    PackageText(const std::string& name, const std::string& says) {
        text_ << "// Written by cell_tb: " << says << "\npackage " << name
              << ";\n  // verilator lint_off UNUSEDPARAM\n";
    }
    void number(const std::string& name, std::size_t value) {
        text_ << "  localparam int " << name << " = " << value << ";\n";
    }
    /// The sizes of a unit's own memories and registers; their widths are those of the package `microcode`.
    void sizes(const MicroImage& image) {
        number("REGISTERS", image.register_count());
        number("INSTRUCTIONS", image.instruction_count());
        number("LINES", std::max<std::size_t>(image.table_lines(), 1));
        number("ACCUMULATOR_BITS", std::size_t(image.accumulator_bits()));
    }
    std::string text() const { return text_.str() + "endpackage\n"; }

  private:
    std::ostringstream text_;
};

}  // namespace raycell
