#include "testbench/common/signals.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

namespace raycell {
namespace {

volatile std::sig_atomic_t noted = 0;
volatile std::sig_atomic_t noting = 0;  ///< number of NotedSignals alive
volatile std::sig_atomic_t held = 0;    ///< number of HeldSignals alive
volatile std::sig_atomic_t waiting = 0;
volatile std::sig_atomic_t published = 0;

// Read by the handler; changed only while signals are held. Never destroyed, since a signal may come at the
// very end.
pthread_t handling_thread;
std::vector<const char*>& unfinished = *new std::vector<const char*>;
std::string& message_without_files = *new std::string;
std::string& message_with_files = *new std::string;

/// Calls only what a signal handler may call.
[[noreturn]] void end_at_once() {
    const std::string& message = published ? message_with_files : message_without_files;
    const auto ignored = write(STDERR_FILENO, message.data(), message.size());
    (void)ignored;
    end_without_files(exit_interrupted);
}

void take() {
    if (noting && !noted) {
        noted = 1;
    } else {
        end_at_once();
    }
}

void on_signal(int number) {
    if (!pthread_equal(pthread_self(), handling_thread)) {
        const int error = errno;
        pthread_kill(handling_thread, number);
        errno = error;
    } else if (held) {
        waiting = 1;
    } else {
        take();
    }
}

bool is_ignored(int number) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    return action.sa_handler == SIG_IGN;
}

}  // namespace

void catch_signals(const std::string& program, bool silent) {
    handling_thread = pthread_self();
    if (!silent) {
        const std::string start = (isatty(STDERR_FILENO) ? "\r\033[K" : "") + program + ": interrupted; ";
        message_without_files = start + "no files were written\n";
        message_with_files = start + "its files were written before\n";
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, number);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        if (number != SIGHUP || !is_ignored(number)) sigaction(number, &action, nullptr);
    }
}

NotedSignals::NotedSignals() { noting = noting + 1; }

NotedSignals::~NotedSignals() { noting = noting - 1; }

const volatile std::sig_atomic_t* noted_signal() { return &noted; }

HeldSignals::HeldSignals() { held = held + 1; }

HeldSignals::~HeldSignals() {
    held = held - 1;
    if (held || !waiting) return;
    waiting = 0;
    take();
}

void add_unfinished(const char* path) {
    const HeldSignals hold;
    unfinished.push_back(path);
}

void drop_unfinished(const char* path) {
    const HeldSignals hold;
    unfinished.erase(std::remove(unfinished.begin(), unfinished.end(), path), unfinished.end());
}

void end_without_files(int code) {
    for (const char* path : unfinished) unlink(path);
    _exit(code);
}

void note_published() { published = 1; }

}  // namespace raycell
