// A run that is told to stop: its verdict, its partial results or none, and never a half-written set. Signals
// are sent when the program's own output shows how far it is.
#include <array>
#include <cstdio>
#include <random>
#include <thread>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const std::vector<std::string> usual_set = {"a.cells.csv", "a.exr", "a.json", "a.png", "a.toml"};

Words render(const char* scene, const Words& more) {
    return joined({"render", own_scene(scene).string(), "-o", "results/a"}, more);
}

/// Sends the signal once the run has printed `when`; returns how the run ended.
Finished interrupted(const Workshop& workshop, const std::string& program, const Words& words,
                     const std::string& when, int signal = SIGTERM) {
    Running running(workshop, program, words);
    EXPECT_TRUE(running.says(when)) << "it ended before";
    running.send(signal);
    return running.finish();
}

void expect_interrupted(const Workshop& workshop, const Finished& finished) {
    EXPECT_EQ(finished.exit_code, 5) << finished.err.substr(0, 2000);
    EXPECT_TRUE(contains(finished.err, "verdict interrupted")) << finished.err;
    EXPECT_EQ(workshop.usual_results(), usual_set);
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "interrupted");
    EXPECT_GT(json.at("cycles").at("total").get<std::int64_t>(), 0);
    expect_sound(json);
}

TEST(Interrupted, WhileLoadingARunKeepsWhatItHas) {
    const Workshop workshop;
    const Finished finished =
        interrupted(workshop, RAYCELL_PROGRAM,
                    render("still_life.nff", {"--cells", "512x512", "--link-bits", "1"}), "load: cycle");
    expect_interrupted(workshop, finished);
    EXPECT_EQ(Json::parse(read_text(workshop.result("a.json"))).at("cycles").at("trace"), 0);
}

TEST(Interrupted, WhileTracingARunKeepsWhatItHas) {
    for (const int signal : {SIGINT, SIGHUP}) {
        const Workshop workshop;
        // Little to load and much to trace.
        const Finished finished =
            interrupted(workshop, RAYCELL_PROGRAM,
                        render("facing_mirrors.nff", {"--cells", "96x96", "--link-bits", "1", "--max-depth",
                                                      "60", "--min-weight", "0", "--ray-store", "61"}),
                        "trace: cycle", signal);
        expect_interrupted(workshop, finished);
        const Json json = Json::parse(read_text(workshop.result("a.json")));
        EXPECT_GT(json.at("cycles").at("trace").get<std::int64_t>(), 0);
        EXPECT_GT(json.at("messages").at("rays").at("in_flight").get<std::int64_t>(), 0);
    }
}

TEST(Interrupted, SyntheticTrafficToo) {
    const Workshop workshop;
    const Finished finished = interrupted(workshop, RAYCELL_DEADLOCK_TB,
                                          {"--cells", "128x128", "--generations", "40", "--ray-store", "41",
                                           "--link-bits", "1", "-o", "results/a"},
                                          "trace: cycle");
    EXPECT_EQ(finished.exit_code, 5) << finished.err.substr(0, 2000);
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "interrupted");
    EXPECT_TRUE(json.at("equals_untimed").get<bool>()) << "of the pixels that are finished";
}

TEST(Interrupted, TheLoadingPipelineAloneToo) {
    const Workshop workshop;
    const Finished finished = interrupted(
        workshop, RAYCELL_LOADING_TB,
        {own_scene("still_life.nff").string(), "--cells", "512x512", "--link-bits", "1", "-o", "results/a"},
        "load: cycle");
    EXPECT_EQ(finished.exit_code, 5) << finished.err.substr(0, 2000);
    EXPECT_EQ(Json::parse(read_text(workshop.result("a.json"))).at("verdict"), "interrupted");
    EXPECT_EQ(workshop.results().size(), 5u);
}

/// A command without cycles ends without results when interrupted.
void expect_no_files(const Words& words, const std::string& when) {
    SCOPED_TRACE(words[0]);
    const Workshop workshop;
    workshop.write("results/a.exr", "an earlier picture");
    workshop.write("results/a.json", "an earlier report");
    const auto before = workshop.contents();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const Finished finished = interrupted(workshop, RAYCELL_PROGRAM, words, when, signal);
        EXPECT_EQ(finished.exit_code, 5);
        EXPECT_TRUE(contains(finished.err, "raycell: interrupted; no files were written")) << finished.err;
        EXPECT_EQ(workshop.contents(), before);
    }
}

TEST(Interrupted, AnUntimedRunLeavesWhatWasThere) {
    expect_no_files(render("facing_mirrors.nff", {"--cells", "512x512", "--engine", "untimed", "--max-depth",
                                                  "60", "--min-weight", "0"}),
                    "row 1 of");
}

TEST(Interrupted, ATruthLeavesWhatWasThere) {
    const Words words = {"truth",        own_scene("facing_mirrors.nff").string(),
                         "-o",           "results/a",
                         "--cells",      "2048x2048",
                         "--max-depth",  "60",
                         "--min-weight", "0"};
    expect_no_files(words, "truth: row");
}

TEST(Interrupted, ASearchForTheSmallestMachineLeavesWhatWasThere) {
    expect_no_files({"size", own_scene("still_life.nff").string(), "-o", "results/a", "--cells", "256x256",
                     "--psnr", "60"},
                    "size: step");
}

TEST(Interrupted, WhileTheTruthIsRenderedARunKeepsItsOwnResults) {
    const Workshop workshop;
    const Finished finished =
        interrupted(workshop, RAYCELL_PROGRAM,
                    render("facing_mirrors.nff", {"--cells", "192x192", "--stage", "load", "--truth",
                                                  "--max-depth", "62", "--min-weight", "0"}),
                    "truth: row 1 of");
    EXPECT_EQ(finished.exit_code, 5) << finished.err;
    EXPECT_TRUE(contains(finished.err, "interrupted: no truth")) << finished.err;
    EXPECT_EQ(workshop.usual_results(), usual_set);
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "completed");
    EXPECT_FALSE(json.contains("accuracy"));
}

TEST(Interrupted, ASecondSignalEndsARunWithoutResults) {
    const Workshop workshop;
    workshop.write("results/a.exr", "an earlier picture");
    const auto before = workshop.contents();
    Running running(workshop, RAYCELL_PROGRAM,
                    render("still_life.nff",
                           {"--cells", "512x512", "--link-bits", "1", "--probe", "1,1", "--golden", "2,2"}));
    ASSERT_TRUE(running.says("load: cycle"));
    EXPECT_TRUE(workshop.results().size() > 1) << "waveforms are written meanwhile";
    // While stopped, the program receives both signals. They differ, so neither is lost.
    running.send(SIGSTOP);
    running.send(SIGINT);
    running.send(SIGTERM);
    running.send(SIGCONT);
    const Finished finished = running.finish();
    EXPECT_EQ(finished.exit_code, 5) << finished.err;
    EXPECT_TRUE(contains(finished.err, "no files were written")) << finished.err;
    EXPECT_EQ(workshop.contents(), before);
}

// ---- while results are written

/// The results of a run without the report's `model` section, which differs from run to run.
std::map<std::string, std::string> fixed_parts(const Workshop& workshop) {
    auto all = workshop.contents();
    const auto report = all.find("a.json");
    if (report != all.end()) {
        Json json = Json::parse(report->second);
        json.erase("model");
        report->second = json.dump();
    }
    return all;
}

/// Sends signals at random moments while a second run writes its results over those of a first one.
void expect_one_set_or_the_other(const std::string& program, const Words& first, const Words& second,
                                 int signals) {
    constexpr unsigned seed = 16;
    std::mt19937 random(seed);
    Workshop workshop;
    ASSERT_EQ(workshop.run_program(program, second).exit_code, 0);
    const auto later = fixed_parts(workshop);
    for (const std::string& name : workshop.results()) fs::remove(workshop.result(name));
    ASSERT_EQ(workshop.run_program(program, first).exit_code, 0);
    const auto earlier = fixed_parts(workshop);
    int kept = 0;
    for (int i = 0; i < 16; ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", try " + std::to_string(i));
        Running running(workshop, program, second);
        const std::string file = std::array{"a.exr", "a.png", "a.toml", "a.json", "a.json"}[random() % 5];
        running.waits_for([&] { return workshop.writes(file); });
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 500));
        for (int k = 0; k < signals; ++k) running.send(k == 0 ? SIGTERM : SIGINT);
        const Finished finished = running.finish();
        EXPECT_TRUE(finished.exit_code == 0 || finished.exit_code == 5) << finished.exit_code;
        EXPECT_EQ(finished.signal, 0);
        const auto there = fixed_parts(workshop);
        EXPECT_TRUE(there == earlier || there == later) << "a mixture";
        EXPECT_TRUE(finished.exit_code != 0 || there == later);
        kept += there == earlier;
        if (there == later) workshop.run_program(program, first);
    }
    std::printf("%d of 16 times the earlier set was kept\n", kept);
}

Words quiet_render(const Words& more) {
    return joined(
        {"render", own_scene("cornell.nff").string(), "--quiet", "--cells", "64x64", "-o", "results/a"},
        more);
}

TEST(Published, ATimedSetIsOneRunsWheneverASignalComes) {
    const Words words = {"--stage", "load"};
    expect_one_set_or_the_other(RAYCELL_PROGRAM, quiet_render(words),
                                quiet_render(joined(words, {"--display", "gouraud"})), 1);
}

TEST(Published, ATimedSetIsOneRunsWheneverTwoSignalsCome) {
    const Words words = {"--stage", "load"};
    expect_one_set_or_the_other(RAYCELL_PROGRAM, quiet_render(words),
                                quiet_render(joined(words, {"--display", "gouraud"})), 2);
}

TEST(Published, AnUntimedSetIsOneRunsWheneverASignalComes) {
    const Words words = {"--engine", "untimed"};
    expect_one_set_or_the_other(RAYCELL_PROGRAM, quiet_render(words),
                                quiet_render(joined(words, {"--hit", "plane"})), 1);
}

TEST(Published, ATruthIsOneRunsWheneverASignalComes) {
    const Words words = {"truth", own_scene("cornell.nff").string(), "--quiet", "-o", "results/a", "--cells",
                         "64x64"};
    expect_one_set_or_the_other(RAYCELL_PROGRAM, words, joined(words, {"--clip"}), 1);
}

// ---- a full disk

/// Runs the program with files limited to `blocks` blocks of 512 bytes.
Finished run_with_short_files(const Workshop& workshop, const std::string& program, const Words& words,
                              int blocks) {
    return workshop.run_program(
        "/bin/sh",
        joined({"-c", "ulimit -f " + std::to_string(blocks) + " && exec \"$0\" \"$@\"", program}, words));
}

void expect_set_kept_on_a_full_disk(const std::string& program, const Words& first, const Words& second) {
    SCOPED_TRACE(program + " " + first[0]);
    const Workshop workshop;
    ASSERT_EQ(workshop.run_program(program, first).exit_code, 0);
    const auto before = workshop.contents();
    std::size_t largest = 0;
    for (const auto& [name, content] : before) largest = std::max(largest, content.size());
    for (int blocks = 0; std::size_t(blocks) * 512 * 2 < largest; blocks = blocks * 3 / 2 + 1) {
        SCOPED_TRACE(std::to_string(blocks) + " blocks");
        const Finished finished = run_with_short_files(workshop, program, second, blocks);
        EXPECT_EQ(finished.signal, 0);
        EXPECT_EQ(finished.exit_code, 1);
        if (blocks > 0) {  // standard error is a file too
            EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
            EXPECT_TRUE(contains(finished.err, "can't write results/a.")) << finished.err;
            EXPECT_TRUE(contains(finished.err, "File too large")) << finished.err;
        }
        EXPECT_EQ(workshop.contents(), before);
    }
}

TEST(Published, AFullDiskLeavesAnEarlierSetWhole) {
    const std::string scene = own_scene("cornell.nff").string();
    const Words render = {"render", scene, "--quiet", "--cells", "32x32", "-o", "results/a"};
    for (const Words& more :
         {Words{}, Words{"--engine", "untimed"}, Words{"--probe", "1,1", "--golden", "2..3,2"},
          Words{"--save-array", "results/a.array"}, Words{"--truth"}}) {
        expect_set_kept_on_a_full_disk(RAYCELL_PROGRAM, joined(render, more),
                                       joined(render, joined(more, {"--depth", "9"})));
    }
    const Words truth = {"truth", scene, "--quiet", "--cells", "32x32", "-o", "results/a"};
    expect_set_kept_on_a_full_disk(RAYCELL_PROGRAM, truth, joined(truth, {"--clip"}));
    const Words traffic = {"--cells", "8x8", "--quiet", "-o", "results/a"};
    expect_set_kept_on_a_full_disk(RAYCELL_DEADLOCK_TB, traffic, joined(traffic, {"--seed", "9"}));
    const Words loading = {scene, "--cells", "16x16", "--quiet", "-o", "results/a"};
    expect_set_kept_on_a_full_disk(RAYCELL_LOADING_TB, loading, joined(loading, {"--depth", "9"}));
}

}  // namespace
}  // namespace raycell::system_test
