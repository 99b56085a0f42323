// The program under test as a child process, and what its tests share.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace raycell::system_test {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;  ///< limits of time and memory mean nothing then
#else
constexpr bool sanitized = false;
#endif

/// What became of a child process.
struct Finished {
    int exit_code = -1;  ///< -1 where a signal ended it
    int signal = 0;
    bool timed_out = false;  ///< it was killed because it took longer than allowed
    double seconds = 0;      ///< wall time
    double megabytes = 0;    ///< largest resident set, 10^6 bytes
    std::string out;
    std::string err;

    std::size_t error_lines() const;
};

/// A fresh folder in which the program is started, removed at the end. Results go to its `results` folder,
/// which holds nothing else.
class Workshop {
  public:
    Workshop();
    ~Workshop();
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    /// Runs `raycell words...`; after `limit_seconds` the child is killed.
    Finished run(const Words& words, double limit_seconds = 100) const;
    /// The same for another program, by its path.
    Finished run_program(const std::string& program, const Words& words, double limit_seconds = 100) const;
    /// Runs `raycell render scene --quiet -o results/NAME words...`.
    Finished render(const fs::path& scene, const Words& words, const std::string& name = "a",
                    double limit_seconds = 100) const;
    /// The same, expected to end with `exit_code`; returns NAME.json, checked for sense, and null without it.
    Json report(const fs::path& scene, const Words& words, int exit_code = 0,
                const std::string& name = "a") const;

    fs::path write(const std::string& name, const std::string& text) const;
    const fs::path& path() const { return path_; }
    fs::path result(const std::string& name) const { return path_ / "results" / name; }
    /// Names of the files in results/, sorted.
    std::vector<std::string> results() const;
    /// The same without what is there only where something waits, locked or was destroyed.
    std::vector<std::string> usual_results() const;

  private:
    fs::path path_;
};

std::string read_text(const fs::path& path);
inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}
Words joined(Words first, const Words& second);

/// The project's own scenes, and those that lie beside the project where they do.
fs::path own_scene(const std::string& name);
fs::path shared_scenes();

/// What must hold in every report, whatever the options: every key of the format is there, messages are
/// conserved, sums are sums, nothing is fuller than it can be.
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
