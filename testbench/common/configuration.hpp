// Configuration files: TOML, key = value, the keys are the options' names.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace raycell {

/// The last value of an option among the words of a command line, the first of which, a subcommand or the
/// program, is skipped; none without the option. Throws UsageError, "expected `value`", if it has no value.
std::optional<std::string> last_word_of(const std::vector<std::string>& words, const std::string& option,
                                        const std::string& value);

/// The file that the last --config names, empty if there is none. Throws UsageError if --config has no file.
std::string configuration_named(const std::vector<std::string>& words);

/// Turns a configuration file into arguments for `app`. Keys that only `other` knows are ignored, if it is
/// given: a file that `render` wrote serves `truth` too. Throws UsageError naming file, line and key for text
/// that is not TOML, unknown keys and values of the wrong kind.
std::vector<std::string> arguments_from_file(const std::string& path, const CLI::App& app,
                                             const CLI::App* other = nullptr);

/// The same for a file that may have any key of `raycell render`: those that `app` lacks are ignored.
std::vector<std::string> arguments_from_render_file(const std::string& path, const CLI::App& app);

/// The same for a text; `name` is for messages.
std::vector<std::string> arguments_from_text(const std::string& text, const std::string& name,
                                             const CLI::App& app, const CLI::App* other = nullptr);

/// The effective options as a configuration file that reproduces the run.
std::string to_toml(const nlohmann::ordered_json& values);

}  // namespace raycell
