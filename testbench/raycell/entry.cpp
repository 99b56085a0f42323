#include "testbench/raycell/entry.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <new>
#include <stdexcept>

#include "scenes/diagnostics.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

/// SystemC prints its banner before sc_main(); standard error belongs to the run's own messages.
const bool banner_off = [] {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return true;
}();

}  // namespace

int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run) {
    std::reverse(words.begin(), words.end());  // CLI11 takes a vector from its end
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_done : exit_usage;
    }
    const int code = run();
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("standard output can't be written");
    return code;
}

int run_guarded(const std::string& name, const std::string& smaller, const std::function<int()>& run) {
    (void)banner_off;
    try {
        return run();
    } catch (const InputError& error) {
        std::cerr << error.what() << '\n';
    } catch (const std::bad_alloc&) {
        std::cerr << name << ": out of memory; expected " << smaller << '\n';
    } catch (const std::exception& error) {
        std::cerr << name << ": " << error.what() << '\n';
    }
    return exit_usage;
}

}  // namespace raycell
