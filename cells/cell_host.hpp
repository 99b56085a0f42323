// The interface of a host of cells: a module for each cell, or a tile for a block of cells.
#pragma once

namespace raycell {

class Cell;

class CellHost {
  public:
    virtual ~CellHost() = default;
    /// Calls the cell's step() in this evaluation phase.
    virtual void activate(Cell& cell) = 0;
    /// Hint: the cell will soon be activated, so its memory may be prefetched.
    virtual void foresee(const Cell& /*cell*/) const {}
};

}  // namespace raycell
