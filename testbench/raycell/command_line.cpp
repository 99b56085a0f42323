#include "testbench/raycell/command_line.hpp"

#include <algorithm>

#include "scenes/diagnostics.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/presets.hpp"

namespace raycell {

/// CLI11 takes a vector of arguments from its end.
void parse(CLI::App& program, std::vector<std::string> words) {
    std::reverse(words.begin(), words.end());
    program.parse(words);
}

/// Puts the arguments of --preset, then those of --config, before the command line's own: what comes later
/// takes precedence.
std::vector<std::string> with_configuration(CLI::App& program, std::vector<std::string> words,
                                            const CLI::App& command) {
    const std::vector<std::string> preset = preset_arguments(words, command);
    const std::string path = configuration_named(words);
    words.insert(words.begin() + 1, preset.begin(), preset.end());
    if (path.empty()) return words;
    const auto from_file = arguments_from_file(path, command, program.get_subcommand("render"));
    std::vector<std::string> alone = {words.front()};
    alone.insert(alone.end(), from_file.begin(), from_file.end());
    try {
        parse(program, alone);  // alone, so that an error is known to be the file's
    } catch (const CLI::ParseError& error) {
        throw UsageError(path + ": " + error.what());
    }
    const auto behind = words.begin() + 1 + std::ptrdiff_t(preset.size());
    words.insert(behind, from_file.begin(), from_file.end());
    return words;
}

}  // namespace raycell
