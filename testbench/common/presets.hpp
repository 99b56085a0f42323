// Presets: machines as configuration files, one a file, under a name.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace raycell {

/// Names of the presets, sorted: the files NAME.toml of the folder `presets`, of the installed program or of
/// the source tree.
std::vector<std::string> preset_names();

/// The file of a preset. Throws UsageError for a name that there is not.
std::string preset_file(const std::string& name);

/// Adds --preset. A preset is no part of the effective configuration, which has what it sets.
void add_preset_option(CLI::App& app);

/// The last --preset of the command line as arguments for `app`; none without one, or if `app` has no such
/// option. They belong before those of --config. Throws UsageError.
std::vector<std::string> preset_arguments(const std::vector<std::string>& words, const CLI::App& app);

}  // namespace raycell
