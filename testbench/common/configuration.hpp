// Configuration files: TOML, key = value, the keys are the options' names.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace raycell {

/// The file that the last --config names, empty if there is none. The first word, a subcommand or the
/// program, is skipped. Throws UsageError if --config has no file.
std::string configuration_named(const std::vector<std::string>& words);

/// Turns a configuration file into arguments for `app`. Keys that only `other` knows are ignored, if it is
/// given: a file that `render` wrote serves `truth` too. Throws UsageError naming file, line and key for text
/// that is not TOML, unknown keys and values of the wrong kind.
std::vector<std::string> arguments_from_file(const std::string& path, const CLI::App& app,
                                             const CLI::App* other = nullptr);

/// The same for a text; `name` is for messages.
std::vector<std::string> arguments_from_text(const std::string& text, const std::string& name,
                                             const CLI::App& app, const CLI::App* other = nullptr);

/// The effective options as a configuration file that reproduces the run.
std::string to_toml(const nlohmann::ordered_json& values);

}  // namespace raycell
