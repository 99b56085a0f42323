// What the programs' sc_main have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace raycell {

/// An operation that is not supported with more than one rank, or not by this program. Exit code 2.
struct RanksRefused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Another rank has failed and tells why; this one ends quietly.
struct OtherRankFailed : std::exception {};

/// This process among those that mpirun has started; one alone without it. From the environment, so that it
/// is known before anything else is.
struct LaunchedRanks {
    int rank = 0;
    int count = 1;
    int on_this_machine = 1;
};
LaunchedRanks launched_ranks();

/// Throws RanksRefused if this is one of several ranks; `what` names the program or its subcommand.
void refuse_ranks(const std::string& what);

/// run_guarded() calls it after the message of an error, with the exit code.
void set_failure_hook(void (*hook)(int code));

/// Parses the words of the command line (without the program) and then runs. Returns the exit code.
int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run);

/// Runs a program to its exit code: what is thrown becomes a message on standard error, "NAME: what", and
/// exit code 1. `smaller`: what to try when memory runs out. Of several ranks, rank 0 alone prints; an error
/// of another rank is told with its number if it is not every rank's.
int run_guarded(const std::string& name, const std::string& smaller, const std::function<int()>& run);

}  // namespace raycell
