// Golden vectors for Verilog's $readmemh: a word a line, of fixed layout (docs/reference/cell_tb.md).
#pragma once

#include <string>

#include "testbench/golden/file.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {

constexpr const char* memory_in_suffix = ".in.hex";
constexpr const char* memory_out_suffix = ".out.hex";

class MemoryText {
  public:
    /// `widest`: bits of the widest message (Packing::widest).
    MemoryText(const Formats& formats, int widest) : formats_(formats), widest_(widest) {}

    /// A remark that names the fields of a line and their bits.
    std::string first_line() const;
    std::string line(const GoldenEvent& event) const;
    std::string last_line(Cycle last) const;

  private:
    std::string line(Cycle cycle, unsigned what, unsigned side, unsigned index, unsigned link, unsigned bits,
                     std::string digits) const;
    Formats formats_;
    int widest_;
};

/// The two files of a record: of what the cell is told, and of what it has to do.
struct MemoryFiles {
    std::string in;
    std::string out;
};
MemoryFiles memory_files(const MemoryText& text, const std::vector<GoldenEvent>& events, Cycle last);

}  // namespace raycell
