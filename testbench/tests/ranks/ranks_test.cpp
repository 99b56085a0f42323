// One machine simulated by several processes: the run is equal to the last bit, and all processes end alike.
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "../system/program.hpp"

namespace raycell::system_test {
namespace {

constexpr const char* mpirun = "/usr/bin/mpirun";

#define SKIP_WITHOUT_MPIRUN() \
    if (!fs::exists(mpirun)) GTEST_SKIP() << mpirun << " is missing: several ranks can't be tried"
#define SKIP_WITHOUT_MPI() \
    SKIP_WITHOUT_MPIRUN(); \
    if (!RAYCELL_HAS_MPI) GTEST_SKIP() << "the program is built without MPI"

/// The arguments of mpirun for `ranks` processes of raycell. By default mpirun refuses to run as root and to
/// start more ranks than cores; these options allow both.
Words by_ranks(int ranks, const Words& words) {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    return joined({"-q", "--oversubscribe", "-np", std::to_string(ranks), RAYCELL_PROGRAM}, words);
}

Words render(const fs::path& scene, const std::string& name, const Words& more) {
    return joined({"render", scene.string(), "--quiet", "-o", "results/" + name}, more);
}

/// A report without the parts that may differ: names, times, memory, and which rank did what.
Json comparable(const Workshop& workshop, const std::string& name) {
    Json json = Json::parse(read_text(workshop.result(name + ".json")));
    json.erase("model");
    json.erase("ranks");
    json.at("config").erase("output");
    // Several ranks trace no tree once more: only one process knows how long the longest takes alone.
    if (json.contains("bound")) json.at("bound").erase("trace");
    return json;
}

/// Runs a scene in one process and with each number of ranks, and expects equal results, files included.
/// Scenes should take only some thousand exchanges: with more ranks than cores, each can take a millisecond.
void expect_same(const fs::path& scene, const Words& words, int exit_code = 0,
                 const std::vector<int>& counts = {2, 3}) {
    const Workshop workshop;
    const Finished alone = workshop.run(render(scene, "1", words));
    ASSERT_EQ(alone.exit_code, exit_code) << alone.err;
    const Json expected = comparable(workshop, "1");
    for (const int ranks : counts) {
        const std::string name = std::to_string(ranks);
        SCOPED_TRACE(name + " ranks");
        const Finished finished = workshop.run_program(mpirun, by_ranks(ranks, render(scene, name, words)));
        ASSERT_EQ(finished.exit_code, exit_code) << finished.err;
        EXPECT_EQ(finished.err, alone.err) << "what is stuck, line by line";
        const Json json = comparable(workshop, name);
        for (const auto& [key, value] : expected.items()) EXPECT_EQ(json.value(key, Json()), value) << key;
        EXPECT_EQ(json.size(), expected.size());
        for (const std::string file :
             {".exr", ".png", ".cells.csv", ".ledger.csv", ".waits.json", ".knot.svg"}) {
            EXPECT_EQ(fs::exists(workshop.result(name + file)), fs::exists(workshop.result("1" + file)))
                << file;
            EXPECT_TRUE(read_text(workshop.result(name + file)) == read_text(workshop.result("1" + file)))
                << file << " differs";
        }
        const Json each = Json::parse(read_text(workshop.result(name + ".json"))).at("ranks").at("each");
        ASSERT_EQ(each.size(), std::size_t(ranks));
        std::uint64_t hops = 0;
        for (const Json& rank : each) {
            EXPECT_GT(rank.at("hops").get<std::uint64_t>(), 0u) << "a rank that does nothing proves nothing";
            hops += rank.at("hops").get<std::uint64_t>();
        }
        const Json& all = expected.at("hops");
        EXPECT_EQ(hops, all.at("load").get<std::uint64_t>() + all.at("ray").get<std::uint64_t>() +
                            all.at("return").get<std::uint64_t>());
    }
}

TEST(Ranks, MakeTheSameRunWithTheExterior) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "20x26"});
}

TEST(Ranks, MakeTheSameRunWithBlocksOfPixelsAndSamples) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "12x10", "--pixels", "24x30", "--own-rays", "2"});
    expect_same(own_scene("cornell.nff"), {"--cells", "12x10", "--samples", "5", "--sample-until", "0.05"});
}

TEST(Ranks, MakeTheSameRunWithRowsCutAnywhere) {
    SKIP_WITHOUT_MPI();
    const Workshop workshop;
    const fs::path scene = own_scene("cornell.nff");
    const Words words = {"--cells", "16x16", "--ray-store", "2"};
    ASSERT_EQ(workshop.run(render(scene, "1", words)).exit_code, 0);
    const auto rows_of = [&](int ranks, const std::string& cuts) {
        const Finished finished = workshop.run_program(
            mpirun, by_ranks(ranks, joined(render(scene, "n", words), {"--rank-rows", cuts})));
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        EXPECT_EQ(comparable(workshop, "n"), comparable(workshop, "1"));
        EXPECT_EQ(read_text(workshop.result("n.cells.csv")), read_text(workshop.result("1.cells.csv")));
        std::vector<int> rows;
        const Json report = Json::parse(read_text(workshop.result("n.json")));
        for (const Json& rank : report.at("ranks").at("each")) rows.push_back(rank.at("rows"));
        return rows;
    };
    EXPECT_EQ(rows_of(4, "1,11,12"), (std::vector<int>{1, 10, 1, 4}));
    EXPECT_EQ(rows_of(2, "1,3,4,5,12"), (std::vector<int>{1 + 1 + 7, 2 + 1 + 4}));
    EXPECT_EQ(rows_of(3, "2,3,4,10,15"), (std::vector<int>{2 + 6, 1 + 5, 1 + 1}));
}

TEST(Ranks, MakeTheSameRunOfAPublicScene) {
    SKIP_WITHOUT_MPI();
    SKIP_WITHOUT_SHARED_SCENES();
    expect_same(shared_scenes() / "spd" / "teapot-s2.nff", {"--cells", "48x48", "--exterior", "none"}, 0,
                {2});
}

TEST(Ranks, MakeTheSameRunWithMemoShadowsAndStalls) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "31x23", "--shadows", "memo", "--stall", "0.3",
                                           "--buffer", "2", "--slots", "free", "--ray-store", "6"});
}

TEST(Ranks, MakeTheSameRunWithPrecastShadowsOnOtherNetworks) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "24x24", "--shadows", "precast", "--networks",
                                           "quadrant", "--arithmetic", "exact", "--granularity", "cell"});
}

TEST(Ranks, MakeTheSameRunWhenRaysArePostponed) {
    SKIP_WITHOUT_MPI();
    const Words words = {"--cells", "24x24", "--ray-store", "5"};
    const Workshop workshop;
    ASSERT_GT(workshop.report(own_scene("cornell.nff"), words).at("deadlock").at("postponed"), 20);
    expect_same(own_scene("cornell.nff"), words);
}

TEST(Ranks, MakeTheSameLoading) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "16x20", "--stage", "load", "--display", "gouraud"});
}

TEST(Ranks, ProveTheSameDeadlock) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"),
                {"--cells", "30x16", "--networks", "shared", "--slots", "free", "--exterior", "none"}, 3);
}

TEST(Ranks, CallTheSameLivelock) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "24x24", "--ray-store", "2"}, 3);
}

TEST(Ranks, StopAtTheSameLimit) {
    SKIP_WITHOUT_MPI();
    expect_same(own_scene("cornell.nff"), {"--cells", "16x16", "--max-cycles", "3000"}, 4);
}

// ---- abnormal ends

/// Id of the program's process of this rank that was started from the workshop's folder; 0 if there is none.
pid_t process_of_rank(const Workshop& workshop, int rank) {
    const std::string wanted = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank);
    for (const auto& entry : fs::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::error_code error;
        if (fs::read_symlink(entry.path() / "cwd", error) != workshop.path() || error) continue;
        if (fs::read_symlink(entry.path() / "exe", error) != fs::path(RAYCELL_PROGRAM) || error) continue;
        if (contains(read_text(entry.path() / "environ"), wanted + '\0')) return pid_t(std::stol(name));
    }
    return 0;
}

/// A run of minutes with two ranks. mpirun gives them no terminal as standard error, so the test does.
class RunByRanks : public Running {
  public:
    explicit RunByRanks(const Workshop& workshop)
        : Running(workshop, mpirun, words(), NamedTerminal()), workshop_(workshop) {}

    /// Waits until the run is loading, and sends one rank a signal.
    void signal(int rank, int number) {
        ASSERT_TRUE(says("load: cycle")) << "it ended by itself";
        const pid_t process = process_of_rank(workshop_, rank);
        ASSERT_NE(process, 0) << "rank " << rank << " ended by itself";
        kill(process, number);
    }

  private:
    static Words words() {
        Words all = by_ranks(2, {"render", own_scene("still_life.nff").string(), "-o", "results/a", "--cells",
                                 "256x256", "--link-bits", "1"});
        // The last word is the terminal's name.
        const Words shell = {"/bin/sh", "-c",
                             "for terminal; do :; done; exec " RAYCELL_PROGRAM
                             " \"$1\" \"$2\" \"$3\" \"$4\" \"$5\" \"$6\" \"$7\" \"$8\" 2>\"$terminal\"",
                             "sh"};
        const auto program = std::find(all.begin(), all.end(), RAYCELL_PROGRAM);
        all.insert(all.erase(program), shell.begin(), shell.end());
        return all;
    }

    const Workshop& workshop_;
};

TEST(Ranks, EndAllWithoutAFileWhenOneIsKilled) {
    SKIP_WITHOUT_MPI();
    const Workshop workshop;
    RunByRanks run(workshop);
    run.signal(1, SIGKILL);
    const Finished finished = run.finish();
    EXPECT_NE(finished.exit_code, 0);
    EXPECT_TRUE(workshop.results().empty());
    EXPECT_EQ(process_of_rank(workshop, 0), 0) << "rank 0 lives on";
}

TEST(Ranks, KeepWhatTheyHaveWhenOneIsInterrupted) {
    SKIP_WITHOUT_MPI();
    const Workshop workshop;
    RunByRanks run(workshop);
    run.signal(1, SIGTERM);
    const Finished finished = run.finish();
    EXPECT_EQ(finished.exit_code, 5) << finished.err;
    EXPECT_TRUE(contains(finished.err, "verdict interrupted")) << finished.err;
    EXPECT_EQ(workshop.usual_results(),
              (std::vector<std::string>{"a.cells.csv", "a.exr", "a.json", "a.png", "a.toml"}));
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "interrupted");
    expect_sound(json);
}

TEST(Ranks, SayOnceThatResultsCannotBeWritten) {
    SKIP_WITHOUT_MPI();
    const Workshop workshop;
    RunByRanks run(workshop);
    ASSERT_TRUE(run.says("load: cycle"));
    fs::create_directory(workshop.result("a.json"));  // after the program has checked the place
    run.signal(0, SIGTERM);
    const Finished finished = run.finish();
    EXPECT_EQ(finished.exit_code, 1);
    const std::string message = "raycell: can't write results/a.json";
    const std::size_t first = finished.err.find(message);
    ASSERT_NE(first, std::string::npos) << finished.err;
    EXPECT_EQ(finished.err.find(message, first + 1), std::string::npos) << "said twice:\n" << finished.err;
    EXPECT_EQ(workshop.results(), std::vector<std::string>{"a.json"});
}

/// Expects a run with `ranks` ranks to print `message` once and to leave no results.
void expect_refused(const Words& words, int exit_code, const std::string& message, int ranks = 2) {
    const Workshop workshop;
    workshop.write("bad.nff", "v\ngarbage\n");
    const Finished finished = workshop.run_program(mpirun, by_ranks(ranks, words));
    EXPECT_FALSE(finished.timed_out);
    EXPECT_EQ(finished.exit_code, exit_code);
    EXPECT_TRUE(contains(finished.err, message)) << finished.err;
    const std::size_t first = finished.err.find(message);
    EXPECT_EQ(finished.err.find(message, first + 1), std::string::npos) << "said twice:\n" << finished.err;
    EXPECT_TRUE(workshop.results().empty());
}

TEST(Ranks, SayOnceWhatIsWrongWithAScene) {
    SKIP_WITHOUT_MPI();
    expect_refused({"render", "bad.nff", "-o", "results/a"}, 1, "bad.nff:2: 'v' in line 1: found 'garbage'");
}

TEST(Ranks, SayOnceWhatIsWrongWithTheOutput) {
    SKIP_WITHOUT_MPI();
    const std::string scene = own_scene("cornell.nff").string();
    expect_refused({"render", scene, "-o", "/dev/null/a"}, 1, "--output /dev/null/a");
    expect_refused({"render", scene, "-o", std::string(300, 'a')}, 1, "File name too long");
}

/// Runs a process that believes to be rank 0 of several. Expects a refusal before it contacts the others.
void expect_refused_alone(const Words& words, const std::string& message, int ranks = 2) {
    SCOPED_TRACE(message);
    const Workshop workshop;
    setenv("OMPI_COMM_WORLD_SIZE", std::to_string(ranks).c_str(), 1);
    const Finished finished = workshop.run(words);
    unsetenv("OMPI_COMM_WORLD_SIZE");
    EXPECT_FALSE(finished.timed_out);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_EQ(finished.error_lines(), 1u);
    EXPECT_TRUE(contains(finished.err, message)) << finished.err;
    EXPECT_TRUE(workshop.results().empty());
}

TEST(Ranks, RefuseWhatOnlyOneProcessCanDo) {
    const std::string scene = own_scene("cornell.nff").string();
    const Words words = {"render", scene, "-o", "results/a", "--cells", "16x2"};
    const auto refuses = [&](const Words& more, const std::string& message, int ranks = 2) {
        expect_refused_alone(joined(words, more), message, ranks);
    };
    refuses({"--engine", "untimed"}, "--engine untimed can't be had of several ranks");
    refuses({"--probe", "1,1"}, "--probe can't");
    refuses({"--vcd-on-deadlock"}, "--vcd-on-deadlock can't");
    refuses({"--golden", "1,1"}, "--golden can't");
    refuses({"--watch-pixel", "1,1"}, "--watch-pixel can't");
    refuses({"--watch-ray", "1/1"}, "--watch-ray can't");
    refuses({}, "3 ranks for 2 rows of cells; expected a row for each", 3);
    expect_refused_alone({"truth", scene, "-o", "results/a"}, "truth can't be run by several ranks");
    if (!RAYCELL_HAS_MPI) expect_refused_alone(words, "started as one of 2 ranks, but built without MPI");
}

TEST(Ranks, RefuseRowsThatDoNotFit) {
    const Words words = {"render", own_scene("cornell.nff").string(), "-o", "results/a", "--cells", "16x8"};
    const auto refuses = [&](const std::string& rows, int ranks, const std::string& expected) {
        SCOPED_TRACE(rows);
        const Workshop workshop;
        setenv("OMPI_COMM_WORLD_SIZE", std::to_string(ranks).c_str(), 1);
        const Finished finished = workshop.run(joined(words, {"--rank-rows", rows}));
        unsetenv("OMPI_COMM_WORLD_SIZE");
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, "--rank-rows: expected " + expected)) << finished.err;
        EXPECT_TRUE(workshop.results().empty());
    };
    refuses("0", 2, "1 or more rising numbers from 1 to 7 for 2 ranks");
    refuses("8", 2, "1 or more rising numbers from 1 to 7 for 2 ranks");
    refuses("3,3", 3, "2 or more rising numbers from 1 to 7 for 3 ranks");
    refuses("3", 3, "2 or more rising numbers from 1 to 7 for 3 ranks");
    refuses("3", 1, "several ranks, started by mpirun");
}

TEST(Ranks, SayOnceWhatTheyRefuse) {
    SKIP_WITHOUT_MPIRUN();
    expect_refused({"render", own_scene("cornell.nff").string(), "-o", "results/a", "--engine", "untimed"}, 2,
                   "--engine untimed can't be had of several ranks");
}

}  // namespace
}  // namespace raycell::system_test
