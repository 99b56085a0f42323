#include "testbench/rtl/array/disagreements.hpp"

#include <iostream>

namespace raycell {

void Disagreements::add(int x, int y, std::uint64_t cycle, const std::string& text) {
    constexpr std::size_t shown = 10;
    if (++count_ > shown) return;
    std::cerr << "rtl_tb: cell (" << x << ", " << y << "), cycle " << cycle << ": " << text << '\n';
    if (count_ == shown) std::cerr << "rtl_tb: further disagreements are only counted\n";
}

}  // namespace raycell
