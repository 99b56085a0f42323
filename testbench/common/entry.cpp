#include "testbench/common/entry.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <new>
#include <streambuf>
#include <systemc>

#include "scenes/diagnostics.hpp"
#include "testbench/common/help.hpp"
#include "testbench/common/nearest_option.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/common/version.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

/// Turns off the banner that SystemC prints before sc_main(): standard error is for the run's own messages.
const bool banner_off = [] {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return true;
}();

void (*failure_hook)(int) = nullptr;

int number_in_environment(std::initializer_list<const char*> names, int otherwise) {
    for (const char* name : names) {
        if (const char* text = std::getenv(name)) return std::atoi(text);
    }
    return otherwise;
}

/// Discards what is printed.
class Nowhere : public std::streambuf {
    int overflow(int c) override { return traits_type::not_eof(c); }
};

/// Fills closed standard streams: the next file opened would get such a stream's number, and prints would go
/// into it. Opened for the wrong direction, the stream fails as a closed one does.
void occupy_standard_streams() {
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
        const int opened = open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        if (opened >= 0 && opened != number) close(opened);
    }
}

/// Flushes standard output. Throws std::runtime_error if that fails.
void flush_output() {
    std::cout.flush();
    if (std::fflush(stdout) != 0 || !std::cout) throw std::runtime_error("standard output can't be written");
}

/// With several ranks, rank 0 prints what all would print. Returns the process's exit code.
int report_failure(const std::string& message, int code) {
    const int rank = launched_ranks().rank;
    if (rank == 0) {
        std::cerr << message << std::endl;
    } else if (failure_hook && !message.empty()) {  // without a hook, all ranks have the same message
        std::fprintf(stderr, "rank %d: %s\n", rank, message.c_str());
    }
    if (failure_hook) failure_hook(code);
    return rank == 0 ? code : exit_done;  // if this rank failed, mpirun would end rank 0 too soon
}

std::string no_memory;                ///< the message
std::unique_ptr<char[]> for_message;  ///< memory kept for printing it

/// Called when memory runs out. Ends at once: destroying SystemC's modules would need memory.
[[noreturn]] void out_of_memory() {
    std::set_new_handler(nullptr);
    for_message.reset();
    end_without_files(report_failure(no_memory, exit_usage));
}

/// Called when a library can't pass an exception on: TBB, under Embree, ends this way where no memory is left
/// for a thread.
[[noreturn]] void no_way_on() {
    std::string message = no_memory;
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::exception& error) {
        if (std::string(error.what()).find("pthread_create") == std::string::npos) message = error.what();
    } catch (...) {
    }
    end_without_files(report_failure(message, exit_usage));
}

}  // namespace

LaunchedRanks launched_ranks() {
    return {number_in_environment({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}, 0),
            std::max(1, number_in_environment({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, 1)),
            std::max(1, number_in_environment({"OMPI_COMM_WORLD_LOCAL_SIZE"}, 1))};
}

void refuse_ranks(const std::string& what) {
    if (launched_ranks().count > 1)
        throw RanksRefused(what + " can't be run by several ranks; expected one process, without mpirun");
}

void set_failure_hook(void (*hook)(int)) { failure_hook = hook; }

int end_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error) == 0 ? exit_done : exit_usage;
    std::string message = error.what();
    const CLI::App* command = &app;
    for (const CLI::App* each : app.get_subcommands()) command = each;
    for (const std::string& word : command->remaining()) {
        const std::string meant = nearest_option(*command, word);
        if (!meant.empty()) message += "; did you mean " + meant + "?";
    }
    std::cerr << message << "\nRun with --help for more information.\n";
    return exit_usage;
}

int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run) {
    app.formatter(std::make_shared<HelpFormatter>());
    add_version(app);
    std::reverse(words.begin(), words.end());  // CLI11 takes a vector from its end
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        return end_of_parsing(app, error);
    }
    refuse_ranks("this program");
    return run();
}

int run_guarded(const std::string& name, const std::string& smaller, const std::function<int()>& run) {
    (void)banner_off;
    static Nowhere nowhere;
    const int rank = launched_ranks().rank;
    occupy_standard_streams();
    catch_signals(name, rank > 0);
    if (rank > 0) {
        std::cout.rdbuf(&nowhere);
        std::cerr.rdbuf(&nowhere);
    }
    no_memory = name + ": out of memory; expected " + smaller;
    for_message = std::make_unique<char[]>(std::size_t(1) << 18);
    std::set_new_handler(out_of_memory);
    std::set_terminate(no_way_on);
    int code = exit_usage;
    std::string message;
    try {
        const int done = run();
        flush_output();
        return done;
    } catch (const InputError& error) {
        message = error.what();
    } catch (const std::bad_alloc&) {  // thrown by Embree
        message = no_memory;
    } catch (const RanksRefused& error) {
        message = name + ": " + error.what();
        code = exit_refused;
    } catch (const OtherRankFailed&) {
    } catch (const sc_core::sc_report& report) {  // of an exception inside a process
        message = name + ": " + report.get_msg();
    } catch (const std::exception& error) {
        message = name + ": " + error.what();
    }
    return report_failure(message, code);
}

}  // namespace raycell
