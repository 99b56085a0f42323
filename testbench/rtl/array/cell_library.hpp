// The library of a verilated cell, loaded by rtl_tb.
#pragma once

#include <memory>
#include <string>

#include "testbench/rtl/array/rtl_cell.hpp"

namespace raycell {

/// Stays loaded until the program ends.
class CellLibrary {
  public:
    /// `path`: FILE.so; the package that it was verilated for, raycell_pkg.sv, stands one folder above or in
    /// its own. Throws std::runtime_error, naming the file, if it is none or is for another machine than that
    /// of `package`.
    CellLibrary(const std::string& path, const std::string& package, int fault);

    std::unique_ptr<rtl::ArrayCell> make(int x, int y) const {
        return std::unique_ptr<rtl::ArrayCell>(make_(x, y));
    }

  private:
    rtl::MakeCell make_ = nullptr;
};

}  // namespace raycell
