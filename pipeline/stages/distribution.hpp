// Stage 3, distribution: one distributor per row, chained down the left edge. A trapeze travels down the
// chain like a wavefront; each distributor cuts its row's span from it and injects the span into the row of
// cells (paper, section 2.3).
#pragma once

#include <memory>
#include <vector>

#include "pipeline/stages/stage.hpp"

namespace raycell {

/// The distributor of one row. Those of all rows share the process of Distribution: one process for each
/// would cost more than what it does.
class RowDistributor : public StageWork {
  public:
    /// `active` has the distributors that must run in this cycle, `wake` runs them.
    RowDistributor(Environment& environment, int row, std::vector<RowDistributor*>& active,
                   sc_core::sc_event& wake)
        : StageWork(environment), row_(row), active_(active), wake_(wake) {}
    Link* in = nullptr;    ///< from the row above; in a lane's first row from precomputation
    Link* east = nullptr;  ///< into the row's first cell
    Link* down = nullptr;  ///< to the row below; null in a lane's last row
    void activate() override {
        if (active_.empty()) wake_.notify();
        active_.push_back(this);
    }

    /// Number of load messages made for the row and not yet injected.
    std::size_t holds() const { return to_row_ ? 1 : 0; }
    /// Whether its message stands in two links: already passed on, but not yet taken from the input.
    bool works_on_what_it_passed_on() const { return item_ && passed_on_; }
    /// Its part of the wait-for graph, with its input link and the link into the row.
    void add_places(WaitMap& map) const;
    void add_waits(WaitMap& map) const;

  private:
    Cycle step(Cycle now) override;
    void take(LoadItem& item, Cycle now);

    int row_;
    std::vector<RowDistributor*>& active_;
    sc_core::sc_event& wake_;
    Surface surface_;             ///< of the trapezes that follow
    LoadItem* item_ = nullptr;    ///< the message at work, at the head of the input
    LoadItem* to_row_ = nullptr;  ///< made for the row, still to be injected
    bool goes_down_ = false;      ///< item_ must still be passed on
    bool passed_on_ = false;      ///< the row below owns it now
    Cycle ready_ = 0;
};

/// The column of distributors; that of a lane's first row takes the messages of its precomputation. With
/// several ranks, only those of this rank's rows.
class Distribution : public sc_core::sc_module {
  public:
    SC_HAS_PROCESS(Distribution);
    Distribution(sc_core::sc_module_name name, Environment& environment);
    RowDistributor& row(int y) { return *rows_[std::size_t(share_.place(y))]; }
    const RowDistributor& row(int y) const { return *rows_[std::size_t(share_.place(y))]; }
    StageStatistics statistics() const;
    /// Number of load messages in the column, apart from those in rows of cells.
    std::size_t holds() const;
    /// The links between rows of a lane, from the top down.
    const std::vector<std::unique_ptr<Link>>& links() const { return links_; }

  private:
    void run();
    bool begins_lane(int y) const;
    void join_above(Environment& environment, int y, SplitLinks* above);
    void join_below(Environment& environment, int y, SplitLinks& below);

    const ArrayShare& share_;
    std::vector<int> lane_starts_;  ///< first rows
    std::vector<std::unique_ptr<RowDistributor>> rows_;
    std::vector<RowDistributor*> active_;  ///< in this cycle
    sc_core::sc_event wake_;
    std::vector<std::unique_ptr<Link>> links_;
};

}  // namespace raycell
