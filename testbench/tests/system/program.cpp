#include "program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace raycell::system_test {

namespace {

using Clock = std::chrono::steady_clock;

/// Starts a program in `folder` with its standard streams redirected to files there; returns the child's id.
pid_t start_child(const std::string& program, const Words& words, const fs::path& folder,
                  const std::string& errors = "stderr.txt") {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "stdout.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOCTTY,
                                     0600);
    Words all = joined({program}, words);
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("can't start " + program);
    return child;
}

/// Whether the child has ended; if so, sets the exit fields of `finished`.
bool has_ended(pid_t child, Finished& finished) {
    int status = 0;
    rusage usage{};
    if (wait4(child, &status, WNOHANG, &usage) == 0) return false;
    const auto seconds = [](const timeval& time) {
        return double(time.tv_sec) + double(time.tv_usec) * 1e-6;
    };
    finished.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    finished.megabytes = double(usage.ru_maxrss) * 1024e-6;  // Linux counts units of 1024 bytes
    if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
    return true;
}

/// Waits for the child and kills it at the deadline. Calls `listen` now and then.
void await(pid_t child, double limit_seconds, Finished& finished, const std::function<void()>& listen = {}) {
    const auto deadline = Clock::now() + std::chrono::duration<double>(limit_seconds);
    while (!has_ended(child, finished)) {
        if (Clock::now() > deadline && !finished.timed_out) {
            finished.timed_out = true;
            kill(child, SIGKILL);
        }
        if (listen) listen();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

}  // namespace

std::size_t Finished::error_lines() const {
    const bool open_end = !err.empty() && err.back() != '\n';
    return std::size_t(std::count(err.begin(), err.end(), '\n')) + (open_end ? 1 : 0);
}

Workshop::Workshop() {
    std::string name = (fs::temp_directory_path() / "raycell_system_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("can't make a folder " + name);
    path_ = name;
    fs::create_directory(path_ / "results");
}

Workshop::~Workshop() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

Finished Workshop::run(const Words& words, double limit_seconds) const {
    return run_program(RAYCELL_PROGRAM, words, limit_seconds);
}

Finished Workshop::run_program(const std::string& program, const Words& words, double limit_seconds) const {
    Finished finished;
    await(start_child(program, words, path_), limit_seconds, finished);
    finished.out = read_text(path_ / "stdout.txt");
    finished.err = read_text(path_ / "stderr.txt");
    return finished;
}

Finished Workshop::render(const fs::path& scene, const Words& words, const std::string& name,
                          double limit_seconds) const {
    return run(joined({"render", scene.string(), "--quiet", "-o", "results/" + name}, words), limit_seconds);
}

Json Workshop::report(const fs::path& scene, const Words& words, int exit_code,
                      const std::string& name) const {
    const Finished finished = render(scene, words, name);
    std::string command = "raycell render " + scene.string();
    for (const std::string& word : words) command += " " + word;
    SCOPED_TRACE(command);
    EXPECT_FALSE(finished.timed_out);
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err.substr(0, 2000);
    EXPECT_EQ(finished.out, "") << "--quiet";
    if (!fs::exists(result(name + ".json"))) {
        ADD_FAILURE() << "no report was written";
        return {};
    }
    const Json json = Json::parse(read_text(result(name + ".json")));
    expect_sound(json);
    return json;
}

fs::path Workshop::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
}

std::vector<std::string> Workshop::usual_results() const {
    std::vector<std::string> names = results();
    const auto special = [](const std::string& name) {
        return contains(name, ".knot.svg") || contains(name, ".ledger.csv") || contains(name, ".waits.json");
    };
    names.erase(std::remove_if(names.begin(), names.end(), special), names.end());
    return names;
}

std::vector<std::string> Workshop::results() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_ / "results"))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

std::map<std::string, std::string> Workshop::contents() const {
    std::map<std::string, std::string> all;
    for (const std::string& name : results()) all[name] = read_text(result(name));
    return all;
}

bool Workshop::writes(const std::string& name) const {
    std::error_code gone;  // the file may disappear between the two looks
    for (const auto& entry : fs::directory_iterator(path_ / "results")) {
        if (contains(entry.path().filename(), name + ".part") && entry.file_size(gone) > 0 && !gone)
            return true;
    }
    return false;
}

void Running::start(const Workshop& workshop, const std::string& program, const Words& words, bool as_error) {
    folder_ = workshop.path();
    terminal_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (terminal_ < 0 || grantpt(terminal_) != 0 || unlockpt(terminal_) != 0)
        throw std::runtime_error("no terminal can be had");
    fcntl(terminal_, F_SETFL, O_NONBLOCK);
    const std::string name = ptsname(terminal_);
    kept_open_ = open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // else reading our end would fail
    child_ = as_error ? start_child(program, words, folder_, name)
                      : start_child(program, joined(words, {name}), folder_);
}

Running::Running(const Workshop& workshop, const std::string& program, const Words& words) {
    start(workshop, program, words, true);
}

Running::Running(const Workshop& workshop, const std::string& program, const Words& words, NamedTerminal) {
    start(workshop, program, words, false);
}

Running::~Running() {
    if (!over_) {
        kill(child_, SIGKILL);
        await(child_, ages, finished_);
    }
    close(kept_open_);
    close(terminal_);
}

void Running::listen() {
    char bytes[4096];
    for (ssize_t count; (count = read(terminal_, bytes, sizeof bytes)) > 0;)
        finished_.err.append(bytes, std::size_t(count));
}

bool Running::waits_for(const std::function<bool()>& there) {
    const auto deadline = Clock::now() + std::chrono::duration<double>(ages);
    while (!there()) {
        if (!over_) over_ = has_ended(child_, finished_);
        listen();
        if (over_ || Clock::now() > deadline) return there();
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return true;
}

bool Running::says(const std::string& part) {
    return waits_for([&] { return contains(finished_.err, part); });
}

Finished Running::finish() {
    if (!over_) await(child_, ages, finished_, [this] { listen(); });
    over_ = true;
    listen();
    finished_.out = read_text(folder_ / "stdout.txt");
    return finished_;
}

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

Words joined(Words first, const Words& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

fs::path own_scene(const std::string& name) { return fs::path(RAYCELL_SOURCE_DIR) / "scenes" / name; }

fs::path shared_scenes() {
    return (fs::path(RAYCELL_SOURCE_DIR) / ".." / "shared" / "scenes").lexically_normal();
}

}  // namespace raycell::system_test
