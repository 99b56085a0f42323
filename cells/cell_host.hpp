// Who runs cells: a module of its own for each, or a tile for a block of them.
#pragma once

namespace raycell {

class Cell;

class CellHost {
  public:
    virtual ~CellHost() = default;
    /// Has the cell's step() called in this evaluation phase.
    virtual void activate(Cell& cell) = 0;
    /// The cell will soon be activated: time to ask for its memory.
    virtual void foresee(const Cell& /*cell*/) const {}
};

}  // namespace raycell
