// raycell: renders with the simulated machine, renders the truth, compares pictures.
#include <systemc>

#include <cstdlib>
#include <iostream>
#include <new>

#include "scenes/diagnostics.hpp"
#include "testbench/raycell/commands.hpp"
#include "testbench/raycell/options.hpp"

namespace {

using namespace raycell;

/// SystemC prints its banner before sc_main(); standard error belongs to the run's own messages.
const bool banner_off = [] {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return true;
}();

/// The arguments with those of --config put before the command line's own, which so take precedence.
std::vector<std::string> with_configuration(std::vector<std::string> words, const std::vector<Command>& commands) {
    for (std::size_t i = 1; i < words.size(); ++i) {
        const bool joined = words[i].rfind("--config=", 0) == 0;
        if (!joined && words[i] != "--config") continue;
        if (!joined && i + 1 == words.size()) throw UsageError("--config: expected a file");
        const std::string path = joined ? words[i].substr(9) : words[i + 1];
        for (const Command& command : commands) {
            if (words.front() != command.app->get_name()) continue;
            const auto more = arguments_from_file(path, *command.app);
            words.insert(words.begin() + 1, more.begin(), more.end());
            return words;
        }
    }
    return words;
}

int run(int argc, char** argv) {
    CLI::App program{"Simulator of the cellular ray-tracing machine of 1990"};
    program.name("raycell");
    program.set_version_flag("--version", "0.1");
    program.require_subcommand(1);
    const std::vector<Command> commands = {add_render_command(program), add_truth_command(program),
                                           add_compare_command(program)};
    try {
        std::vector<std::string> words(argv + 1, argv + argc);
        if (!words.empty()) words = with_configuration(std::move(words), commands);
        std::reverse(words.begin(), words.end());  // CLI11 takes a vector from its end
        program.parse(words);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? exit_done : exit_usage;
    }
    for (const Command& command : commands) {
        if (command.app->parsed()) return command.run();
    }
    return exit_usage;
}

}  // namespace

int sc_main(int argc, char** argv) {
    (void)banner_off;
    try {
        return run(argc, argv);
    } catch (const raycell::InputError& error) {
        std::cerr << error.what() << '\n';
    } catch (const std::bad_alloc&) {
        std::cerr << "raycell: out of memory; expected a smaller array or scene\n";
    } catch (const std::exception& error) {
        std::cerr << "raycell: " << error.what() << '\n';
    }
    return raycell::exit_usage;
}
