// The words of a command line with subcommands, and those of the files that it names.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace raycell {

void parse(CLI::App& program, std::vector<std::string> words);

/// Puts the arguments of --preset, then those of --config, before the command line's own: what comes later
/// takes precedence. `words` begin with the subcommand, `command`.
std::vector<std::string> with_configuration(CLI::App& program, std::vector<std::string> words,
                                            const CLI::App& command);

}  // namespace raycell
