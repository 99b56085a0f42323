// The runs of a sweep as processes of their own, several at a time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace raycell {

/// A run whose results are PREFIX.json and PREFIX.toml.
struct SweepRun {
    std::string prefix;
    std::vector<std::string> command;  ///< the program and its words, the prefix among them
    std::string title;                 ///< names it in messages; empty: its command does
    bool done() const;                 ///< its results are there
};

/// The file of what a run said on standard error.
std::string messages_of(const SweepRun& run);

/// Progress: runs that are done, of all, and seconds since the first of this time began.
using SweepProgress = std::function<void(std::size_t done, std::size_t all, double seconds)>;

/// Makes the runs that are not done, `jobs` at a time. Of a run's files all but .json and .toml are removed,
/// unless `keep`, and that of its messages if it said nothing. Throws std::runtime_error with a run's own
/// message if it ends without results, after those under way have ended. Returns false if a signal ended it;
/// runs under way are ended, too.
bool make_runs(const std::vector<SweepRun>& runs, int jobs, bool keep, const SweepProgress& progress);

/// Where the running program is; others of the project are beside it.
std::string program_beside(const std::string& name);

}  // namespace raycell
