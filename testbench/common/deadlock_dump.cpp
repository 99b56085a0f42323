#include "testbench/common/deadlock_dump.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "testbench/common/configuration.hpp"
#include "testbench/common/interruptible.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/raycell/commands.hpp"

extern char** environ;

namespace raycell {
namespace {

namespace fs = std::filesystem;

/// A folder beside the results, removed at the end.
class ScratchFolder {
  public:
    explicit ScratchFolder(const std::string& prefix) {
        std::string name = prefix + ".XXXXXX";
        if (!mkdtemp(name.data())) fail("make a folder beside", prefix, reason_of(errno));
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

std::string read_text(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Runs this program again with these words, its standard error going to a file. Returns its exit code, -1 if
/// a signal ended it. Throws Interrupted.
int run_again(std::vector<std::string> words, const std::string& errors) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = 0;
    const int error = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail("run", "/proc/self/exe", reason_of(error));
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (*noted_signal()) kill(child, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    stop_if_interrupted();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The configuration of the second run, whose results go to `prefix`.
nlohmann::ordered_json probing(nlohmann::ordered_json config, const RenderOptions& options,
                               const DeadlockedCells& where, const std::string& prefix,
                               const std::string& array) {
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (const auto& [x, y] : where.cells) cells.push_back(std::to_string(x) + "," + std::to_string(y));
    const Cycle last = Cycle(options.probes.last);
    config["probe"] = cells;
    config["window"] = std::to_string(where.formed > last ? where.formed - last : 0) + ":";
    config["vcd-mark"] = where.formed;
    config["vcd-on-deadlock"] = false;
    config["film"] = 0;
    config["rays"] = false;
    if (config.contains("truth")) config["truth"] = false;
    config["quiet"] = true;
    config["output"] = prefix;
    if (!array.empty()) {  // saved by the first run; no need to load again
        config["load-array"] = array;
        config["save-array"] = "";
    }
    return config;
}

/// Repeats the second run's warnings of the dump's size, under the dump's final name.
void pass_on_warnings(const std::string& said, const std::string& prefix) {
    std::istringstream lines(said);
    for (std::string line; std::getline(lines, line);) {
        const auto at = line.find("warning: the dump");
        if (at != std::string::npos) std::cerr << prefix << ".vcd: " << line.substr(at) << '\n';
    }
}

/// The scope of a node's signals in the dump if it is an input's buffer, else empty.
std::string scope_of(const WaitGraph::Node& node) {
    const std::string input = "input ";
    if (node.what.rfind(input, 0) != 0) return "";
    std::string rest = node.what.substr(input.size());  // side and class
    std::replace(rest.begin(), rest.end(), ' ', '.');
    return "cell_" + std::to_string(node.x) + "_" + std::to_string(node.y) + "." + rest;
}

/// Goes round each knot: from a node to one that it waits for and that was not visited.
std::vector<std::string> buffers_in_turn(const WaitGraph& graph) {
    std::vector<std::string> scopes;
    std::set<WaitGraph::Index> to_visit;
    for (const auto& knot : graph.knots()) to_visit.insert(knot.begin(), knot.end());
    while (!to_visit.empty()) {
        std::optional<WaitGraph::Index> at = *to_visit.begin();
        while (at) {
            to_visit.erase(*at);
            const WaitGraph::Node& node = graph.nodes()[*at];
            const std::string scope = scope_of(node);
            if (!scope.empty()) scopes.push_back(scope);
            at.reset();
            for (const WaitGraph::Index other : node.waits_for) {
                if (!at && to_visit.count(other) > 0) at = other;
            }
        }
    }
    return scopes;
}

/// Puts a group with the knot's buffers before the cells' groups of a save file.
std::string with_knot(std::string save, const std::vector<std::string>& buffers) {
    if (buffers.empty()) return save;
    std::string group = "@800200\n-knot\n@820\n";  // GTKWave: a group begins; words, to the right
    for (const std::string& buffer : buffers) {
        // GTKWave shows what follows a name's last dot alone, so these have names of their own without dots.
        std::string shown = buffer;
        std::replace(shown.begin(), shown.end(), '.', ' ');
        for (const std::string signal : {"type", "ray", "stall"})
            group += "+{" + shown + ": " + signal + "} raycell." + buffer + "." + signal + "\n";
    }
    const auto first = save.find("@800200\n");
    save.insert(first == std::string::npos ? save.size() : first, group + "@1000200\n-knot\n");
    return save;
}

}  // namespace

DeadlockedCells deadlocked_cells(const RunResult& result, Machine& machine) {
    constexpr std::size_t most = 64;
    DeadlockedCells where;
    where.cells = result.knot_cells.empty() ? machine.blocked_cells(most) : result.knot_cells;
    where.buffers = buffers_in_turn(result.waits);
    where.formed = std::min(result.knot_formed, machine.environment().scheduler.now());
    return where;
}

void dump_deadlock(const std::vector<std::string>& program, const RenderOptions& options,
                   nlohmann::ordered_json config, const DeadlockedCells& where, std::uint64_t schedule_hash,
                   OutputSet& outputs) {
    const ScratchFolder folder(options.prefix);
    const std::string prefix = (folder.path() / fs::path(options.prefix).filename()).string();
    const std::string file = (folder.path() / "configuration").string();
    const std::string errors = (folder.path() / "errors").string();
    const std::string array = options.save_array.empty() ? "" : outputs.partial(options.save_array);
    write_text(file, to_toml(probing(std::move(config), options, where, prefix, array)));
    std::vector<std::string> words = program;
    words.insert(words.end(), {"--config", file});
    const int code = run_again(std::move(words), errors);
    const std::string said = read_text(errors);
    if (code != exit_stuck) {
        throw std::runtime_error("--vcd-on-deadlock: the second run ended with exit code " +
                                 std::to_string(code) + ": " + said);
    }
    pass_on_warnings(said, options.prefix);
    const auto report = nlohmann::ordered_json::parse(read_text(prefix + ".json"));
    if (report["hash"]["schedule"] != hex(schedule_hash)) {
        throw std::logic_error("internal error: the second run is not the first: schedule " +
                               report["hash"]["schedule"].get<std::string>() + ", expected " +
                               hex(schedule_hash));
    }
    outputs.adopt(".vcd", prefix + ".vcd");
    outputs.write(".gtkw", with_knot(read_text(prefix + ".gtkw"), where.buffers));
}

}  // namespace raycell
