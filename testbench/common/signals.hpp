// What SIGINT, SIGTERM and SIGHUP do to a program that writes results.
#pragma once

#include <csignal>
#include <string>

namespace raycell {

constexpr int exit_interrupted = 5;

/// Installs the handlers, for the rest of the program. From then on a signal ends it at once with
/// exit_interrupted and one message; files begun but not published are removed. `program` names it in the
/// message; a silent one prints none. SIGHUP stays ignored where it was (nohup). A full pipe or a file that
/// grows too large (SIGPIPE, SIGXFSZ) is an error of the write, not the end of the program.
///
/// The thread that calls this is the one that handles signals, and the only one that may use the rest.
void catch_signals(const std::string& program, bool silent = false);

/// While one lives, the first signal is only noted; the second ends the program as above.
class NotedSignals {
  public:
    NotedSignals();
    ~NotedSignals();
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;
};

/// Not 0 once a signal was noted.
const volatile std::sig_atomic_t* noted_signal();

/// While one lives, signals wait.
class HeldSignals {
  public:
    HeldSignals();
    ~HeldSignals();
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;
};

/// A file to be removed if a signal ends the program; `path` must stay where it is until it is dropped.
void add_unfinished(const char* path);
void drop_unfinished(const char* path);

/// Ends the program where it stands, without unwinding; unfinished files are removed.
[[noreturn]] void end_without_files(int code);

/// From now on the message says that the files are written.
void note_published();

}  // namespace raycell
