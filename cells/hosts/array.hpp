// RC, the cell array: W x H cells, 4-connected (paper, section 2.4).
#pragma once

#include <map>
#include <memory>
#include <systemc>
#include <vector>

#include "cells/hosts/cell_module.hpp"
#include "cells/hosts/cell_socket.hpp"
#include "cells/hosts/cell_tile.hpp"
#include "cells/memory/stable_array.hpp"

namespace raycell {

/// Who runs the cells: these are modules of their own, all others are in tiles. Nothing that a run tells
/// depends on it.
struct Granularity {
    bool every_cell = false;
    std::vector<CellRange> detail;
    /// Cells: one activation of SystemC's for so many squared. The larger, the longer the list of cells to
    /// run in a cycle, and the farther ahead a tile can ask for memory.
    int tile_side = 4096;
    /// Cells of somebody else's, for those places where it makes one.
    CellFactory own_cells = {};

    bool is_module(int x, int y) const;
    /// Number of modules in an array.
    std::size_t modules(int width, int height) const;
};

/// Of an array that several ranks share, each has its rows (Environment::share); a cell's place is the whole
/// array's.
class Array : public sc_core::sc_module {
  public:
    Array(sc_core::sc_module_name name, Environment& environment, const Granularity& granularity = {});

    Cell& cell(int x, int y) { return cells_[index(x, y)]; }
    const Cell& cell(int x, int y) const { return cells_[index(x, y)]; }
    /// Row by row.
    StableArray<Cell>& cells() { return cells_; }
    const StableArray<Cell>& cells() const { return cells_; }
    /// Null for a cell in a tile.
    CellModule* module(int x, int y);
    /// The module that somebody else put in the place of a cell, which then stands idle; null if none.
    CellSocket* socket(int x, int y);
    /// Who is woken by the links of a place: its cell, or the module that stands there.
    Client& client(int x, int y);
    std::size_t tiles() const { return tiles_.size(); }
    /// For whoever runs the cells instead.
    const Prefetch& prefetch() const { return prefetch_; }

    StableArray<Link>& links() { return links_; }
    const StableArray<Link>& links() const { return links_; }
    /// Index into cells() of the cell that links()[link] leads to: where its buffers stand.
    std::size_t sink_of(std::size_t link) const { return ways_[link] / side_count; }
    /// The side of its source over which links()[link] leads.
    Side side_of(std::size_t link) const { return Side(ways_[link] % side_count); }

    // Joins a cell to something outside; to be called before the simulation starts.
    void join_border(int x, int y, Side side, Link& from_outside, Link& to_outside);
    /// The row's first cell gets its load messages over this link.
    void join_row(int y, Link& load);

    /// Begins the environment's phase: every cell runs in the next cycle.
    void begin_phase();
    /// Every cell runs in this cycle.
    void wake_all(Cycle cycle);

    /// All cells' schedules, joined in the order of the cells.
    std::uint64_t schedule_hash() const;

    /// Bytes that an array takes before anything is loaded or under way, as far as they grow with it.
    static double bytes(const Granularity& granularity, int width, int height, const BufferClasses& classes);

  private:
    std::size_t index(int x, int y) const {
        return std::size_t(environment_.share.place(y)) * std::size_t(environment_.width()) + std::size_t(x);
    }
    void make_hosts(const Granularity& granularity);
    void make_links();
    void make_link(int x, int y, Side side);
    void make_half_links(SplitLinks& split, int y, Side outwards);
    void make_half_link_out(SplitLinks& split, int x, int y, Side side);
    void make_half_link_in(SplitLinks& split, int x, int y, Side from);
    Link& add_link(int to_x, int to_y, Side side);
    void stall(Link& link, int x, int y, Side side) const;
    void bind_in(int x, int y, Side side, Link& link);
    void bind_out(int x, int y, Side side, Link& link);
    void end_of_elaboration() override;
    void make_runs();

    Environment& environment_;
    const Prefetch prefetch_;
    StableArray<Cell> cells_;
    std::vector<std::unique_ptr<CellTile>> tiles_;
    std::map<std::size_t, std::unique_ptr<CellModule>> modules_;  ///< by the cell's index
    std::map<std::size_t, std::unique_ptr<CellSocket>> sockets_;  ///< by the cell's index
    StableArray<Link> links_;
    StableArray<DepthRun> runs_;       ///< of all cells' voxels, row by row
    std::vector<std::uint32_t> ways_;  ///< by link: index of its sink · 4 + side of its source
};

}  // namespace raycell
