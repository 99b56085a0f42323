// raycell: renders with the simulated machine, renders the truth, compares pictures, sizes the machine.
#include <algorithm>
#include <iostream>
#include <systemc>

#include "scenes/diagnostics.hpp"
#include "testbench/common/entry.hpp"
#include "testbench/common/help.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/version.hpp"
#include "testbench/raycell/command_line.hpp"
#include "testbench/raycell/commands.hpp"

namespace {

using namespace raycell;

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
