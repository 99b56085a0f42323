#include "testbench/sweep/runs.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "cells/clock/wall_time.hpp"
#include "testbench/common/new_file.hpp"
#include "testbench/common/signals.hpp"

namespace raycell {
namespace {

namespace fs = std::filesystem;

pid_t start(const SweepRun& run) {
    std::vector<char*> words;
    for (const std::string& word : run.command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const std::string messages = messages_of(run);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0644);
    pid_t process = 0;
    const int error = posix_spawn(&process, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail("start", run.command[0], reason_of(error));
    return process;
}

/// Removes a run's files: of a whole run all but the results, unless `keep`; of another all.
void tidy(const SweepRun& run, bool whole, bool keep) {
    const std::string messages = messages_of(run);
    if (!(whole && keep) || fs::file_size(messages) == 0) fs::remove(messages);
    if (whole && keep) return;
    const fs::path prefix(run.prefix);
    const std::string name = prefix.filename().string() + ".";
    std::vector<fs::path> others;
    for (const auto& entry : fs::directory_iterator(prefix.parent_path())) {
        const std::string file = entry.path().filename().string();
        const bool result = file == name + "json" || file == name + "toml";
        if (file.rfind(name, 0) == 0 && !(whole && result)) others.push_back(entry.path());
    }
    for (const fs::path& other : others) fs::remove(other);
}

std::string failure_of(const SweepRun& run) {
    std::ifstream file(messages_of(run));
    std::ostringstream text;
    text << file.rdbuf();
    std::string words = run.title;
    if (words.empty()) {
        for (const std::string& word : run.command) words += (words.empty() ? "" : " ") + word;
    }
    return "a run ended without results: " + words + "\n" + text.str();
}

class Children {
  public:
    ~Children() { end_all(); }
    void add(const SweepRun& run) { running_[start(run)] = &run; }
    std::size_t count() const { return running_.size(); }
    struct Ended {
        const SweepRun* run = nullptr;
        bool whole = false;  ///< with a verdict of its own: a run that is interrupted writes results, too
    };
    /// Waits for one to end; none if a signal came instead.
    Ended wait() {
        int status = 0;
        pid_t process = 0;
        // A noted signal does not end a wait.
        while ((process = waitpid(-1, &status, WNOHANG)) == 0) {
            if (*noted_signal()) return {};
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        const auto found = running_.find(process);
        if (found == running_.end()) throw std::runtime_error("can't wait for a run: " + reason_of(errno));
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        const Ended ended{found->second, found->second->done() && code != exit_interrupted && code >= 0};
        running_.erase(found);
        return ended;
    }
    void end_all() {
        for (const auto& [process, run] : running_) kill(process, SIGTERM);
        for (const auto& [process, run] : running_) {
            int status = 0;
            while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
            }
            tidy(*run, false, false);
        }
        running_.clear();
    }

  private:
    std::map<pid_t, const SweepRun*> running_;
};

}  // namespace

std::string messages_of(const SweepRun& run) { return run.prefix + ".messages"; }

bool SweepRun::done() const { return fs::exists(prefix + ".json") && fs::exists(prefix + ".toml"); }

std::string program_beside(const std::string& name) {
    return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

bool make_runs(const std::vector<SweepRun>& runs, int jobs, bool keep, const SweepProgress& progress) {
    const NotedSignals noted;
    const auto began = WallClock::now();
    std::vector<const SweepRun*> to_do;
    for (const SweepRun& run : runs) {
        if (!run.done()) to_do.push_back(&run);
    }
    std::size_t done = runs.size() - to_do.size();
    std::size_t next = 0;
    std::string failure;
    Children children;
    while (next < to_do.size() || children.count() > 0) {
        while (failure.empty() && next < to_do.size() && children.count() < std::size_t(jobs))
            children.add(*to_do[next++]);
        if (children.count() == 0) break;
        progress(done, runs.size(), seconds_since(began));
        const Children::Ended ended = children.wait();
        const bool interrupted = *noted_signal();
        if (ended.run) {
            if (!ended.whole && !interrupted && failure.empty()) failure = failure_of(*ended.run);
            tidy(*ended.run, ended.whole, keep);
            done += ended.whole;
        }
        if (interrupted) {
            children.end_all();
            return false;
        }
    }
    if (!failure.empty()) throw std::runtime_error(failure);
    progress(done, runs.size(), seconds_since(began));
    return true;
}

}  // namespace raycell
