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

/// Which cells are modules of their own; all others are in tiles. No result of a run depends on it.
struct Granularity {
    bool every_cell = false;
    std::vector<CellRange> detail;
    /// Side of a tile, in cells; SystemC activates one process per tile. A larger tile has a longer list of
    /// cells to run in a cycle, so it can prefetch farther ahead.
    int tile_side = 4096;
    /// Makes a user's own cell modules, for the places where it returns one.
    CellFactory own_cells = {};

    bool is_module(int x, int y) const;
    /// Number of modules in an array.
    std::size_t modules(int width, int height) const;
};

/// The cells and links of an array. If several ranks share an array, each has its own rows
/// (Environment::share); coordinates are always those of the whole array.
class Array : public sc_core::sc_module {
  public:
    Array(sc_core::sc_module_name name, Environment& environment, const Granularity& granularity = {});

    Cell& cell(int x, int y) { return cells_[index(x, y)]; }
    const Cell& cell(int x, int y) const { return cells_[index(x, y)]; }
    /// The cells, row by row.
    StableArray<Cell>& cells() { return cells_; }
    const StableArray<Cell>& cells() const { return cells_; }
    /// The module of a cell; null for a cell in a tile.
    CellModule* module(int x, int y);
    /// The user's own module in the place of a cell, which is then idle; null if there is none.
    CellSocket* socket(int x, int y);
    /// The client that the links of a place wake: its cell, or the user's module in its place.
    Client& client(int x, int y);
    std::size_t tiles() const { return tiles_.size(); }
    /// For code that runs the cells in place of their hosts.
    const Prefetch& prefetch() const { return prefetch_; }

    StableArray<Link>& links() { return links_; }
    const StableArray<Link>& links() const { return links_; }
    /// Index into cells() of the sink of links()[link], the cell that has its buffers.
    std::size_t sink_of(std::size_t link) const { return ways_[link] / side_count; }
    /// The side over which links()[link] leaves its source.
    Side side_of(std::size_t link) const { return Side(ways_[link] % side_count); }

    // Connect a cell to links from outside the array; to be called before the simulation starts.
    void join_border(int x, int y, Side side, Link& from_outside, Link& to_outside);
    /// Sets the link on which the first cell of row y gets its load messages.
    void join_row(int y, Link& load);

    /// Begins the environment's phase: wakes every cell in the next cycle.
    void begin_phase();
    /// Has a cell send the primary ray of a pixel of its block once more, in the next cycle; phase trace must
    /// be over.
    void begin_tree(int x, int y, int pixel);
    /// Wakes every cell in this cycle.
    void wake_all(Cycle cycle);

    /// The hash of the schedules of all cells, in the order of the cells.
    std::uint64_t schedule_hash() const;

    /// Bytes of an array before loading, as far as they grow with its size.
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
    void make_index();

    Environment& environment_;
    const Prefetch prefetch_;
    StableArray<Cell> cells_;
    std::vector<std::unique_ptr<CellTile>> tiles_;
    std::map<std::size_t, std::unique_ptr<CellModule>> modules_;  ///< by the cell's index
    std::map<std::size_t, std::unique_ptr<CellSocket>> sockets_;  ///< by the cell's index
    StableArray<Link> links_;
    StableArray<IndexEntry> index_;    ///< the index tables of all cells, row by row
    std::vector<std::uint32_t> ways_;  ///< by link: index of its sink · 4 + side of its source
};

}  // namespace raycell
