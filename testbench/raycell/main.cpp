// raycell: renders with the simulated machine, renders the truth, compares pictures, sizes the machine.
#include <algorithm>
#include <iostream>
#include <systemc>

#include "scenes/diagnostics.hpp"
#include "testbench/common/configuration.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/help.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/presets.hpp"
#include "testbench/common/version.hpp"
#include "testbench/raycell/commands.hpp"

namespace {

using namespace raycell;

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

int run(int argc, char** argv) {
    CLI::App program{"Simulator of the cellular ray-tracing machine of 1990"};
    program.name("raycell");
    program.formatter(std::make_shared<HelpFormatter>());
    add_version(program);
    program.require_subcommand(1);
    const std::vector<Command> commands = {add_render_command(program),  add_truth_command(program),
                                           add_compare_command(program), add_size_command(program),
                                           add_sweep_command(program),   add_completion_command(program)};
    std::vector<std::string> words(argv + 1, argv + argc);
    if (!words.empty() && words.front().rfind("-", 0) != 0) {
        const auto named = [&](const Command& c) { return c.app->get_name() == words.front(); };
        const auto command = std::find_if(commands.begin(), commands.end(), named);
        if (command == commands.end()) {
            throw UsageError("unknown command '" + printable(words.front()) +
                             "'; expected render, truth, compare, size, sweep or completion");
        }
        // A sweep's file has lists and ranges: it reads it itself.
        if (words.front() != "sweep") words = with_configuration(program, std::move(words), *command->app);
    }
    try {
        parse(program, words);
    } catch (const CLI::ParseError& error) {
        return end_of_parsing(program, error);
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        if (command.app->get_name() != "render") refuse_ranks(command.app->get_name());
        return command.run();
    }
    return exit_usage;
}

}  // namespace

int sc_main(int argc, char** argv) {
    return raycell::run_guarded("raycell", "a smaller array or scene", [&] { return run(argc, argv); });
}
