// Stage 3, distribution: one distributor per row, chained down the left edge. A trapeze travels down the
// chain like a wavefront; each row cuts its span from it and injects it into its pipeline of cells (paper,
// section 2.3).
#pragma once

#include <memory>
#include <vector>

#include "pipeline/stages/stage.hpp"

namespace raycell {

/// The distributor of one row.
class RowDistributor : public Stage {
  public:
    RowDistributor(sc_core::sc_module_name name, Environment& environment, int row)
        : Stage(name, environment), row_(row) {}
    sc_core::sc_port<LinkIn> in;     ///< from the row above, or from precomputation
    sc_core::sc_port<LinkOut> east;  ///< into the row's first cell
    sc_core::sc_port<LinkOut, 1, sc_core::SC_ZERO_OR_MORE_BOUND> down;  ///< to the row below

    /// Load messages made for the row and not yet injected.
    std::size_t holds() const { return to_row_ ? 1 : 0; }
    /// Whether its message stands in two links: passed on, and not yet taken from the input.
    bool works_on_what_it_passed_on() const { return item_ && passed_on_; }
    /// Its part of the wait-for graph, with the links into and out of it; `input` is what `in` is bound to.
    void add_places(WaitMap& map, const Link& input) const;
    void add_waits(WaitMap& map, const Link& input) const;

  private:
    Cycle step(Cycle now) override;
    void take(LoadItem& item, Cycle now);

    int row_;
    LoadItem* item_ = nullptr;    ///< at the head of the input, at work
    LoadItem* to_row_ = nullptr;  ///< still to be injected
    bool goes_down_ = false;      ///< still to be passed on
    bool passed_on_ = false;      ///< the row below owns it now
    Cycle ready_ = 0;
};

/// The column of distributors; row 0 takes what precomputation sends. Of a shared array, the share's rows.
class Distribution : public sc_core::sc_module {
  public:
    Distribution(sc_core::sc_module_name name, Environment& environment);
    RowDistributor& row(int y) { return *rows_[std::size_t(share_.place(y))]; }
    const RowDistributor& row(int y) const { return *rows_[std::size_t(share_.place(y))]; }
    StageStatistics statistics() const;
    /// Load messages in the column and in no row of cells.
    std::size_t holds() const;
    /// Into each row but row 0, from the row above.
    const std::vector<std::unique_ptr<Link>>& links() const { return links_; }

  private:
    void join_above(Environment& environment, int y, SplitLinks* above);
    void join_below(Environment& environment, int y, SplitLinks& below);

    const ArrayShare& share_;
    std::vector<std::unique_ptr<RowDistributor>> rows_;
    std::vector<std::unique_ptr<Link>> links_;
};

}  // namespace raycell
