// What SIGINT, SIGTERM and SIGHUP do to a program that writes results.
#pragma once

#include <csignal>
#include <string>

namespace raycell {

constexpr int exit_interrupted = 5;

/// Installs the signal handlers for the rest of the program. From then on a signal ends the program at once
/// with exit_interrupted and one message, and files that are begun but not published are removed. `program`
/// names it in the message; if `silent`, none is printed. SIGHUP stays ignored where it was (nohup). A closed
/// pipe (SIGPIPE) or a file that grows too large (SIGXFSZ) is an error of the write, not the end of the
/// program.
///
/// Signals are handled by the thread that calls this; no other thread may use the rest of this file.
void catch_signals(const std::string& program, bool silent = false);

/// While one lives, the first signal is only noted; a second one ends the program as above.
class NotedSignals {
  public:
    NotedSignals();
    ~NotedSignals();
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;
};

/// Not 0 once a signal was noted.
const volatile std::sig_atomic_t* noted_signal();

/// While one lives, signals wait until it is destroyed.
class HeldSignals {
  public:
    HeldSignals();
    ~HeldSignals();
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;
};

/// Registers a file that is removed if a signal ends the program. `path` must stay valid until it is dropped.
void add_unfinished(const char* path);
void drop_unfinished(const char* path);

/// Ends the program at once, without unwinding, and removes unfinished files.
[[noreturn]] void end_without_files(int code);

/// After this, the message says that the files were written.
void note_published();

}  // namespace raycell
