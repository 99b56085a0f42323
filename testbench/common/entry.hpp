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

/// This process among those that mpirun started; without mpirun, the only one. Taken from the environment, so
/// that it is known before anything else runs.
struct LaunchedRanks {
    int rank = 0;
    int count = 1;
    int on_this_machine = 1;
};
LaunchedRanks launched_ranks();

/// Throws RanksRefused if this is one of several ranks; `what` names the program or its subcommand.
void refuse_ranks(const std::string& what);

/// Sets a function that run_guarded() calls with the exit code, after the message of an error.
void set_failure_hook(void (*hook)(int code));

/// What is printed when parsing ends the program: help, the version, or an error, which names the option that
/// an unknown one resembles. Returns the exit code.
int end_of_parsing(const CLI::App& app, const CLI::ParseError& error);

/// Adds --version, parses the words of the command line (without the program) and then runs. Returns the exit
/// code.
int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run);

/// Runs a program and returns its exit code. An exception becomes a message on standard error, "NAME: what",
/// and exit code 1 (RanksRefused: 2). `smaller`: what to try when memory runs out. With several ranks, rank 0
/// alone prints; another rank's error is printed with its number unless every rank has the same.
int run_guarded(const std::string& name, const std::string& smaller, const std::function<int()>& run);

}  // namespace raycell
