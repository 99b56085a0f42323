// What the programs' sc_main have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace raycell {

/// Parses the words of the command line (without the program) and then runs. Returns the exit code.
int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run);

/// Runs a program to its exit code: what is thrown becomes a message on standard error, "NAME: what", and
/// exit code 1. `smaller`: what to try when memory runs out.
int run_guarded(const std::string& name, const std::string& smaller, const std::function<int()>& run);

}  // namespace raycell
