// render on several ranks: what is refused, who reads the scene, how a failure ends all, what is reported.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>

#include "pipeline/machine.hpp"
#include "testbench/common/options.hpp"

namespace raycell {

/// Adds --rank-rows. It is not part of a run's configuration: no result depends on it.
void add_rank_options(CLI::App& app, RenderOptions& options);
/// Throws RanksRefused for what only one process can do, and UsageError for rows that don't fit.
void check_ranks(const RenderOptions& options);

/// This process among those that mpirun started; one object at most. Once it is constructed, an error that
/// share_scene() does not pass on ends all ranks.
class RankRun {
  public:
    /// Joins the others. Throws RanksRefused in a program without MPI.
    RankRun();
    ~RankRun();
    RankRun(const RankRun&) = delete;
    RankRun& operator=(const RankRun&) = delete;

    bool first() const;
    /// Rank 0 reads the scene; the others get it from there. If `read` throws, all ranks end,
    /// and its message is printed once.
    CellScene share_scene(const std::function<CellScene()>& read);
    /// The exchange of the machine. Call once.
    RankExchange& exchange(const CellScene& scene, const RenderOptions& options);
    /// Gathers a text for each row. `mine`: those of this rank's rows, from the top down. Rank 0 gets those
    /// of the whole array, the others nothing.
    std::vector<std::string> gather_rows(const std::vector<std::string>& mine);
    /// `ranks` of the report, on rank 0: rows, hops, bytes and seconds of each. Call when `machine` has run.
    nlohmann::ordered_json report(Machine& machine, std::uint64_t memory_bytes);
    /// Call when the machine has run and the others only wait for finish(): a failure from now on is this
    /// rank's alone.
    void others_are_done();
    /// Call when all is written: lets the others go.
    void finish();

  private:
    std::unique_ptr<RankExchange> exchange_;
};

}  // namespace raycell
