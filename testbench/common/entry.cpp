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

#include "scenes/diagnostics.hpp"
#include "testbench/common/signals.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

/// SystemC prints its banner before sc_main(); standard error belongs to the run's own messages.
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

/// Takes what is printed and drops it.
class Nowhere : public std::streambuf {
    int overflow(int c) override { return traits_type::not_eof(c); }
};

/// A closed standard stream's number would be given to the next file that is opened, and what is printed
/// would go there. Put open for the wrong direction, it fails as a closed one does.
void occupy_standard_streams() {
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
        const int opened = open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        if (opened >= 0 && opened != number) close(opened);
    }
}

/// What has been printed so far is out, or this throws.
void flush_output() {
    std::cout.flush();
    if (std::fflush(stdout) != 0 || !std::cout) throw std::runtime_error("standard output can't be written");
}

/// Of several ranks, rank 0 says what all have to say. Returns what the process has to exit with.
int report_failure(const std::string& message, int code) {
    const int rank = launched_ranks().rank;
    if (rank == 0) {
        std::cerr << message << std::endl;
    } else if (failure_hook && !message.empty()) {  // without a hook, every rank has the same to say
        std::fprintf(stderr, "rank %d: %s\n", rank, message.c_str());
    }
    if (failure_hook) failure_hook(code);
    return rank == 0 ? code : exit_done;  // mpirun ends rank 0, message or not, once another rank fails
}

std::string no_memory;                ///< the message
std::unique_ptr<char[]> for_message;  ///< memory that it can have

/// Called where memory runs out: taking SystemC's modules down would need some.
[[noreturn]] void out_of_memory() {
    std::set_new_handler(nullptr);
    for_message.reset();
    end_without_files(report_failure(no_memory, exit_usage));
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

int parse_and_run(CLI::App& app, std::vector<std::string> words, const std::function<int()>& run) {
    std::reverse(words.begin(), words.end());  // CLI11 takes a vector from its end
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exit_done : exit_usage;
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
    int code = exit_usage;
    std::string message;
    try {
        const int done = run();
        flush_output();
        return done;
    } catch (const InputError& error) {
        message = error.what();
    } catch (const std::bad_alloc&) {  // of Embree's
        message = no_memory;
    } catch (const RanksRefused& error) {
        message = name + ": " + error.what();
        code = exit_refused;
    } catch (const OtherRankFailed&) {
    } catch (const std::exception& error) {
        message = name + ": " + error.what();
    }
    return report_failure(message, code);
}

}  // namespace raycell
