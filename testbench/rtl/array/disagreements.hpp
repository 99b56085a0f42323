// What RTL cells of an array did that the model would not have done.
#pragma once

#include <cstddef>
#include <string>

namespace raycell {

/// Counts disagreements and prints the first of them on standard error. The run goes on with what the cell
/// did.
class Disagreements {
  public:
    void add(int x, int y, std::uint64_t cycle, const std::string& text);
    std::size_t count() const { return count_; }

  private:
    std::size_t count_ = 0;
};

}  // namespace raycell
