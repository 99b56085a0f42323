// deadlock_tb, end to end: options, verdicts, exit codes, files.
#include <sys/wait.h>

#include <cstdlib>

#include "program.hpp"

namespace raycell::system_test {
namespace {

Finished run_deadlock_tb(const Workshop& workshop, const std::string& arguments) {
    const fs::path out = workshop.path() / "out.txt";
    const fs::path err = workshop.path() / "err.txt";
    const std::string command = "cd \"" + workshop.path().string() + "\" && timeout " +
                                std::to_string(int(ages)) + " \"" + RAYCELL_DEADLOCK_TB + "\" " + arguments +
                                " >\"" + out.string() + "\" 2>\"" + err.string() + "\"";
    const int status = std::system(command.c_str());
    Finished finished;
    if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
    finished.out = read_text(out);
    finished.err = read_text(err);
    return finished;
}

/// The JSON of a run that is expected to end with `exit_code`.
Json report(const Workshop& workshop, const std::string& arguments, int exit_code = 0) {
    SCOPED_TRACE("deadlock_tb " + arguments);
    const Finished finished = run_deadlock_tb(workshop, arguments + " --quiet -o results/a");
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err.substr(0, 2000);
    EXPECT_EQ(finished.out, "") << "--quiet";
    if (!fs::exists(workshop.result("a.json"))) return {};
    Json json = Json::parse(read_text(workshop.result("a.json")));
    std::vector<std::string> files{"a.cells.csv", "a.json"};
    if (json.at("deadlock").contains("knot")) files.push_back("a.knot.svg");
    files.push_back("a.toml");
    if (exit_code == 3 || exit_code == 4) files.push_back("a.waits.json");
    EXPECT_EQ(workshop.results(), files);
    EXPECT_TRUE(json.at("equals_untimed").get<bool>());
    const Json& rays = json.at("messages").at("rays");
    EXPECT_LE(rays.at("answered").get<int>() + rays.at("destroyed").get<int>(), rays.at("sent").get<int>());
    return json;
}

TEST(DeadlockTb, ShowsTheCellsOfADeadlockAsWaveformsThatOpenAtIt) {
    const Workshop workshop;
    const Finished finished = run_deadlock_tb(
        workshop, "--buffer 1 --networks shared --cells 16x16 --vcd-on-deadlock --quiet -o results/a");
    EXPECT_EQ(finished.exit_code, 3) << finished.err;
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    const std::string vcd = read_text(workshop.result("a.vcd"));
    const std::string save = read_text(workshop.result("a.gtkw"));
    const Json& cell = report.at("deadlock").at("knot").at("cells").at(0);
    EXPECT_TRUE(contains(vcd, "$scope module cell_" + cell.at(0).dump() + "_" + cell.at(1).dump())) << cell;
    EXPECT_TRUE(contains(vcd, " cycle "));
    // A cycle lasts 50 ns; the save file's line of the zoom ends in the marker's time.
    const std::uint64_t formed = report.at("deadlock").at("knot").at("formed");
    EXPECT_TRUE(contains(save, " " + std::to_string(50 * formed) + "\n[sst_expanded]"))
        << save.substr(0, 300);
    // First of all the knot's buffers, so that they are in view.
    const Json& node = report.at("deadlock").at("knot").at("nodes").at(0);
    EXPECT_TRUE(contains(save, "} raycell.cell_")) << "with names that tell their cell";
    const std::string input = "raycell.cell_" + node.at("x").dump() + "_" + node.at("y").dump() + "." +
                              node.at("side").get<std::string>() + ".all.stall";
    EXPECT_LT(save.find("-knot"), save.find("-cell_"));
    EXPECT_LT(save.find(input), save.find("-cell_")) << input;
    const auto units = save.find("-traversal");
    const auto buffers = save.find("-west all");
    const auto quiet = save.find("-quiet buffers");
    EXPECT_TRUE(units < buffers) << save.substr(0, 2000);
    EXPECT_TRUE(quiet == std::string::npos || buffers < quiet);
}

TEST(DeadlockTb, ProbesCellsAsRenderDoes) {
    const Workshop workshop;
    const Finished finished = run_deadlock_tb(
        workshop, "--cells 8x8 --probe 3,4 --window 0:500 --vcd-mark 100 --quiet -o results/a");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(contains(read_text(workshop.result("a.vcd")), "$scope module cell_3_4"));
    EXPECT_TRUE(contains(read_text(workshop.result("a.gtkw")), " 5000\n[sst_expanded]"));
    EXPECT_EQ(run_deadlock_tb(workshop, "--cells 8x8 --probe 3,4").exit_code, 1) << "no place for the files";
}

TEST(DeadlockTb, CompletesByDefaultAndSaysSo) {
    const Workshop workshop;
    const Finished finished = run_deadlock_tb(workshop, "");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    for (const char* part : {"verdict completed", "seed 1", "1024 of 1024 pixels", "untimed picture equal",
                             "ray store: peak", "postponed"}) {
        EXPECT_TRUE(contains(finished.out, part)) << finished.out;
    }
    EXPECT_TRUE(workshop.results().empty()) << "no files unless they are asked for";
}

TEST(DeadlockTb, LocksOverOneNetworkAtAnyRayStore) {
    const Workshop workshop;
    for (const std::string slots : {"1", "8", "200"}) {
        const Json json =
            report(workshop, "--buffer 1 --networks shared --recovery none --ray-store " + slots, 3);
        EXPECT_EQ(json.at("verdict"), "deadlock");
        EXPECT_FALSE(json.at("deadlock").at("report").empty());
        EXPECT_LT(json.at("pixels").at("completed").get<int>(), json.at("pixels").at("all").get<int>());
    }
}

TEST(DeadlockTb, FindsAKnotLongBeforeRaysThatAreSentAgainForEverWouldBeCalledALivelock) {
    const Workshop workshop;
    const Finished finished =
        run_deadlock_tb(workshop, "--buffer 1 --networks shared --ray-store 1 --quiet -o results/a");
    EXPECT_EQ(finished.exit_code, 3);
    EXPECT_TRUE(contains(finished.err, "deadlock_tb: warning: the run may end in a deadlock: "))
        << finished.err;
    EXPECT_TRUE(contains(finished.err, "certain to end with --networks half --ray-store 3\n"))
        << finished.err;
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "deadlock");
    const int formed = json.at("deadlock").at("knot").at("formed");
    EXPECT_LT(formed, 2000);
    EXPECT_LT(json.at("cycles").at("trace").get<int>(), 50000);
    EXPECT_GT(json.at("deadlock").at("postponed").get<int>(), 0);
}

TEST(DeadlockTb, LeavesNoGraphOfAnEarlierRunBesideAResultWithoutOne) {
    const Workshop workshop;
    report(workshop, "--buffer 1 --networks shared --recovery none", 3);
    report(workshop, "");  // expects a.json and a.toml alone
}

/// Runs the independent search that the sweep uses.
Finished check_knots(const Workshop& workshop, const fs::path& graph) {
    return workshop.run_program(
        "/usr/bin/python3",
        {fs::path(RAYCELL_SOURCE_DIR) / "scripts/studies/deadlock/check_knots.py", graph});
}

TEST(DeadlockTb, ItsKnotsAreAcceptedByASearchOfTheSweepsOwn) {
    const Workshop workshop;
    report(workshop, "--buffer 1 --networks split --recovery none --cells 24x24 --seed 1", 3);
    const fs::path graph = workshop.result("a.waits.json");
    const Finished accepted = check_knots(workshop, graph);
    EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
    EXPECT_TRUE(contains(accepted.out, "knots, accepted")) << accepted.out;

    // Altered graphs: a node of a knot that can move, a knot without one of its nodes, and no knot at all.
    const Json json = Json::parse(read_text(graph));
    ASSERT_FALSE(json.at("knots").empty());
    Json moves = json, smaller = json, none = json;
    moves["nodes"][json["knots"][0][0].get<std::size_t>()]["moves"] = true;
    smaller["knots"][0].erase(0);
    none["knots"] = Json::array();
    for (const Json& altered : {moves, smaller, none})
        EXPECT_EQ(check_knots(workshop, workshop.write("altered.json", altered.dump())).exit_code, 2);
    EXPECT_EQ(check_knots(workshop, workshop.write("other.json", "{}")).exit_code, 1);
}

TEST(DeadlockTb, LocksInHalvesBelowASmallStoreWithoutRecoveryAndEndsWithIt) {
    const Workshop workshop;
    for (const std::string networks : {"half", "quadrant"}) {
        const std::string which = "--networks " + networks + " --ray-store ";
        EXPECT_EQ(report(workshop, which + "2 --recovery none", 3).at("verdict"), "deadlock");
        EXPECT_EQ(report(workshop, which + "16 --recovery none").at("verdict"), "completed");
        const Json json = report(workshop, which + "3 --recovery postpone");
        EXPECT_EQ(json.at("verdict"), "completed");
        EXPECT_GT(json.at("deadlock").at("postponed").get<int>(), 0);
    }
}

TEST(DeadlockTb, StopsAtTheLimitOfCycles) {
    const Workshop workshop;
    const Json json = report(workshop, "--max-cycles 1000", 4);
    EXPECT_EQ(json.at("verdict"), "cycle_limit");
    EXPECT_LE(json.at("cycles").at("total").get<int>(), 1000);
}

TEST(DeadlockTb, DoesTheSameAgainFromItsConfiguration) {
    const Workshop workshop;
    const Json first =
        report(workshop,
               "--cells 12x9 --directions axial --branching 0.7,0.3 --sources 2 --seed 5 --cost walk_step=9");
    const Finished again = run_deadlock_tb(workshop, "--config results/a.toml --quiet -o results/a");
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const Json second = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(schedule(second), schedule(first));
    EXPECT_EQ(image(second), image(first));
    EXPECT_EQ(second.at("config"), first.at("config"));
    EXPECT_EQ(second.at("config").at("branching"), "0.7,0.3");
    const Json other = report(workshop, "--config results/a.toml --seed 6");
    EXPECT_NE(image(other), image(first)) << "the command line has precedence";
}

TEST(DeadlockTb, GivesOnePictureWhateverOnlyTimeDependsOn) {
    const Workshop workshop;
    const std::string traffic = "--cells 16x16 --branching 1,0.4 --sources 1 --seed 3 ";
    const std::string whole = image(report(workshop, traffic));
    for (const std::string machine : {"--networks quadrant --buffer 3", "--ray-store 4", "--link-bits 300",
                                      "--slots free --ray-store 12", "--cost shade_setup=90"}) {
        EXPECT_EQ(image(report(workshop, traffic + machine)), whole) << machine;
    }
}

TEST(DeadlockTb, RefusesWhatItCannotUnderstand) {
    const Workshop workshop;
    for (const std::string words : {"--hit-probability 1.5",
                                    "--hit-probability x",
                                    "--generations 63",
                                    "--branching 1,2",
                                    "--branching 0.5,0.5,0.5",
                                    "--branching ,1",
                                    "--directions left",
                                    "--turn-back -1",
                                    "--sources 65",
                                    "--cells 0x4",
                                    "--ray-store 0",
                                    "--networks thirds",
                                    "--seed -1",
                                    "--cost walk_step",
                                    "--nonsense",
                                    "word",
                                    "--config missing.toml",
                                    "--config",
                                    "-o /dev/null/a",
                                    "--max-cycles -1"}) {
        const Finished finished = run_deadlock_tb(workshop, words);
        EXPECT_EQ(finished.exit_code, 1) << words;
        EXPECT_GE(finished.error_lines(), 1u) << words;
        EXPECT_LE(finished.error_lines(), 3u) << finished.err;
        EXPECT_EQ(finished.out, "") << words;
    }
    workshop.write("odd.toml", "cells = \"8x8\"\nscene = \"a.nff\"\n");
    const Finished finished = run_deadlock_tb(workshop, "--config odd.toml");
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "odd.toml:2: unknown key 'scene'")) << finished.err;
    EXPECT_TRUE(workshop.results().empty());
}

TEST(DeadlockTb, HelpNamesEveryOptionWithItsRange) {
    const Workshop workshop;
    const Finished finished = run_deadlock_tb(workshop, "--help");
    EXPECT_EQ(finished.exit_code, 0);
    for (const char* part : {"--cells",       "--hit-probability",
                             "--generations", "--branching",
                             "P[,Q]",         "isotropic|axial|diagonal|back",
                             "--turn-back",   "--sources",
                             "--ray-store",   "--buffer",
                             "--networks",    "--recovery",
                             "--slots",       "--link-bits",
                             "--max-cycles",  "--cost",
                             "--seed",        "--output",
                             "--config",      "--quiet",
                             "0..62"}) {
        EXPECT_TRUE(contains(finished.out, part)) << part;
    }
}

}  // namespace
}  // namespace raycell::system_test
