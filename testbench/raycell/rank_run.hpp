// render on several ranks: what is refused, who reads the scene, how a failure ends all, what is reported.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "pipeline/machine.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// --rank-rows. Not part of a run's configuration: nothing in its results depends on it.
void add_rank_options(CLI::App& app, RenderOptions& options);
/// Throws RanksRefused for what only one process can do, and UsageError for rows that don't fit.
void check_ranks(const RenderOptions& options);

/// This process among those that mpirun started; one at most. From its construction on, an error that is not
/// told by share_scene() ends all ranks.
class RankRun {
  public:
    /// Joins the others. Throws RanksRefused in a program without MPI.
    RankRun();
    ~RankRun();
    RankRun(const RankRun&) = delete;
    RankRun& operator=(const RankRun&) = delete;

    bool first() const;
    /// Rank 0 reads the scene; the others get all of it but its polygons. What `read` throws ends all ranks
    /// with its message, said once.
    CellScene share_scene(const std::function<CellScene()>& read);
    /// For the machine; once.
    RankExchange& exchange(const CellScene& scene, const RenderOptions& options);
    /// Of a text for each of its rows, from the top down, rank 0 alone gets those of the whole array's.
    std::vector<std::string> gather_rows(const std::vector<std::string>& mine);
    /// `ranks` of the report, on rank 0: rows, hops, bytes and seconds of each. `machine` has run.
    nlohmann::ordered_json report(Machine& machine, std::uint64_t memory_bytes);
    /// The machine has run, and the others only wait for finish(): a failure from now on is this rank's
    /// alone.
    void others_are_done();
    /// All is written: lets the others go.
    void finish();

  private:
    std::unique_ptr<RankExchange> exchange_;
};

}  // namespace raycell
