// RC, the cell array: W x H cells, 4-connected (paper, section 2.4).
#pragma once

#include <memory>
#include <systemc>
#include <vector>

#include "cells/cell_module.hpp"

namespace raycell {

class Array : public sc_core::sc_module {
  public:
    Array(sc_core::sc_module_name name, Environment& environment);

    CellModule& cell(int x, int y) { return *cells_[index(x, y)]; }
    const CellModule& cell(int x, int y) const { return *cells_[index(x, y)]; }
    const std::vector<std::unique_ptr<CellModule>>& cells() const { return cells_; }
    const std::vector<std::unique_ptr<Link>>& links() const { return links_; }
    /// Row-major index of the cell that links()[link] leads to: where its buffers stand.
    std::size_t sink_of(std::size_t link) const { return sinks_[link]; }
    /// The side of its source over which links()[link] leads.
    Side side_of(std::size_t link) const { return sides_[link]; }

    /// Joins a cell to something outside over the border; to be called before the simulation starts.
    void join_border(int x, int y, Side side, LinkIn* from_outside, LinkOut* to_outside);

    /// Begins the environment's phase: every cell runs in the next cycle.
    void begin_phase();

    /// All cells' schedules, joined in the order of the cells.
    std::uint64_t schedule_hash() const;

  private:
    std::size_t index(int x, int y) const {
        return std::size_t(y) * std::size_t(environment_.width()) + std::size_t(x);
    }
    Link& make_link(CellModule& source, CellModule& sink, Side side);

    Environment& environment_;
    std::vector<std::unique_ptr<CellModule>> cells_;
    std::vector<std::unique_ptr<Link>> links_;
    std::vector<std::size_t> sinks_;  ///< by link
    std::vector<Side> sides_;         ///< by link
};

}  // namespace raycell
