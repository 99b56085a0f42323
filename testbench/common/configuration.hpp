// Configuration files: TOML, key = value, the keys are the options' names.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace raycell {

/// The file of the last --config among the arguments, empty if there is none; the first is a subcommand or
/// the program. Throws UsageError where the file is missing.
std::string configuration_named(const std::vector<std::string>& words);

/// Turns a configuration file into arguments for `app`. Keys that only `other` knows are passed over, if it
/// is given: a file that `render` wrote serves `truth` too. Throws UsageError naming file, line and key for
/// what is not TOML, for keys that the command doesn't know and for values of the wrong kind.
std::vector<std::string> arguments_from_file(const std::string& path, const CLI::App& app,
                                             const CLI::App* other = nullptr);

/// The same of a text; `name` is for messages.
std::vector<std::string> arguments_from_text(const std::string& text, const std::string& name,
                                             const CLI::App& app, const CLI::App* other = nullptr);

/// The effective options as a configuration file that reproduces the run.
std::string to_toml(const nlohmann::ordered_json& values);

}  // namespace raycell
