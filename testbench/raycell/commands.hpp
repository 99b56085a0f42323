// The subcommands of raycell. Each adds itself to the program and returns what main() exits with.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace raycell {

// exit_interrupted (signals.hpp) is one more.
enum ExitCode {
    exit_done = 0,
    exit_usage = 1,
    exit_comparison = 2,
    exit_refused = 2,  ///< what can't be done by several ranks
    exit_stuck = 3,
    exit_limit = 4
};

struct Command {
    CLI::App* app;
    std::function<int()> run;
};

Command add_render_command(CLI::App& program);
/// For another program, with what it adds (render_hooks.hpp).
struct RenderHooks;
Command add_render_command(CLI::App& program, RenderHooks hooks);
Command add_truth_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_size_command(CLI::App& program);
Command add_sweep_command(CLI::App& program);
Command add_completion_command(CLI::App& program);

}  // namespace raycell
