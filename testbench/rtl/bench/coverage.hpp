// Functional coverage of a cell without voxels: what its records have made it do, as a table.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "testbench/rtl/bench/verilated_cell.hpp"

namespace rtl {

class Coverage {
  public:
    Coverage();
    /// What a cell does in this cycle, its outputs settled.
    void sample(VerilatedCell& cell);
    void count(const std::string& bin) { ++bins_[bin]; }
    /// A Markdown table of all bins, those without a hit too.
    std::string table() const;
    std::size_t bins() const { return order_.size(); }
    std::size_t hit() const;

  private:
    void bin(const std::string& name);
    void count_way(int requester, int to, bool ends);
    std::vector<std::string> order_;
    std::map<std::string, std::uint64_t> bins_;
};

}  // namespace rtl
