// The program under test as a child process, and helpers for its tests.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace raycell::system_test {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;  ///< time and memory limits mean nothing then
#else
constexpr bool sanitized = false;
#endif

/// How a child process ended.
struct Finished {
    int exit_code = -1;  ///< -1 if a signal ended it
    int signal = 0;
    bool timed_out = false;  ///< it was killed because it took longer than allowed
    double seconds = 0;      ///< processor time, which other work on the machine hardly changes
    double megabytes = 0;    ///< largest resident set, 10^6 bytes
    std::string out;
    std::string err;

    std::size_t error_lines() const;
};

/// Wall seconds after which a child counts as hanging, however busy the machine is.
constexpr double ages = 900;

/// A fresh folder in which the program is started, removed at the end. Results go to its `results` folder,
/// which holds nothing else.
class Workshop {
  public:
    Workshop();
    ~Workshop();
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    /// Runs `raycell words...`; kills the child after `limit_seconds` of wall time.
    Finished run(const Words& words, double limit_seconds = ages) const;
    /// The same for another program, given by its path.
    Finished run_program(const std::string& program, const Words& words, double limit_seconds = ages) const;
    /// Runs `raycell render scene --quiet -o results/NAME words...`.
    Finished render(const fs::path& scene, const Words& words, const std::string& name = "a",
                    double limit_seconds = ages) const;
    /// The same, expected to end with `exit_code`. Returns NAME.json after checking it, or null if it is
    /// missing.
    Json report(const fs::path& scene, const Words& words, int exit_code = 0,
                const std::string& name = "a") const;

    fs::path write(const std::string& name, const std::string& text) const;
    const fs::path& path() const { return path_; }
    fs::path result(const std::string& name) const { return path_ / "results" / name; }
    /// Names of the files in results/, sorted.
    std::vector<std::string> results() const;
    /// The contents of these files, by name.
    std::map<std::string, std::string> contents() const;
    /// Whether a file of this name is being written or waits to be renamed.
    bool writes(const std::string& name) const;
    /// Like results(), without files that exist only if something waited, locked or was destroyed.
    std::vector<std::string> usual_results() const;

  private:
    fs::path path_;
};

/// A child process while it runs. Its standard error is a terminal, so it shows its progress.
class Running {
  public:
    Running(const Workshop& workshop, const std::string& program, const Words& words);
    /// The same, but the terminal's name is the last word and standard error is not the terminal.
    struct NamedTerminal {};
    Running(const Workshop& workshop, const std::string& program, const Words& words, NamedTerminal);
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    pid_t id() const { return child_; }
    /// Waits until the child has printed `part`; false if it ended without.
    bool says(const std::string& part);
    /// Waits until `there` is true; false if the child ended before.
    bool waits_for(const std::function<bool()>& there);
    void send(int signal) const { kill(child_, signal); }
    /// Waits for the end of the child.
    Finished finish();

  private:
    void start(const Workshop& workshop, const std::string& program, const Words& words, bool as_error);
    void listen();

    fs::path folder_;
    int terminal_ = -1;   ///< our end
    int kept_open_ = -1;  ///< the child's end
    pid_t child_ = 0;
    bool over_ = false;
    Finished finished_;
};

std::string read_text(const fs::path& path);
inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}
Words joined(Words first, const Words& second);

/// Folders of scenes: the project's own, and the data beside the project, if present.
fs::path own_scene(const std::string& name);
fs::path shared_scenes();

/// Expects what must hold in every report: every key of the format is there, messages are conserved, sums are
/// right, and nothing is fuller than it can be.
void expect_sound(const Json& report);

/// The picture's hash in a report.
inline std::string image(const Json& report) { return report.at("hash").at("image"); }
inline std::string schedule(const Json& report) { return report.at("hash").at("schedule"); }

}  // namespace raycell::system_test

#define SKIP_WITHOUT_SHARED_SCENES()                                             \
    if (!std::filesystem::is_directory(raycell::system_test::shared_scenes())) { \
        GTEST_SKIP() << "the scene data beside the project is missing: "         \
                     << raycell::system_test::shared_scenes().string();          \
    }                                                                            \
    static_assert(true)
