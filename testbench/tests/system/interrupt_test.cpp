// A run that is told to stop: its verdict, its results so far, and no trace of a half-written file.
#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Starts a run and sends it a signal after `seconds`.
Finished interrupted(const Workshop& workshop, const std::string& signal, const std::string& seconds,
                     const Words& words) {
    return workshop.run_program("/usr/bin/timeout",
                                joined({"--preserve-status", "-s", signal, seconds}, words), 60);
}

/// The runs below take several times as long as they are left to run, and what comes before the phase in
/// which they are stopped takes a part of it: on other machines, too.
Words render(const char* scene, const Words& more) {
    return joined({RAYCELL_PROGRAM, "render", own_scene(scene).string(), "-o", "results/a", "--quiet"}, more);
}

void expect_interrupted(const Workshop& workshop, const Finished& finished) {
    EXPECT_EQ(finished.exit_code, 5) << finished.err.substr(0, 2000);
    EXPECT_EQ(finished.signal, 0);
    EXPECT_TRUE(contains(finished.err, "verdict interrupted")) << finished.err;
    EXPECT_EQ(workshop.usual_results(),
              (std::vector<std::string>{"a.cells.csv", "a.exr", "a.json", "a.png", "a.toml"}));
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "interrupted");
    EXPECT_GT(json.at("cycles").at("total").get<std::int64_t>(), 0);
    expect_sound(json);
}

TEST(Interrupted, WhileLoadingARunKeepsWhatItHas) {
    const Workshop workshop;
    const Finished finished = interrupted(
        workshop, "TERM", "3", render("still_life.nff", {"--cells", "512x512", "--link-bits", "1"}));
    expect_interrupted(workshop, finished);
    EXPECT_EQ(Json::parse(read_text(workshop.result("a.json"))).at("cycles").at("trace"), 0);
    EXPECT_LT(finished.seconds, 15);
}

TEST(Interrupted, WhileTracingARunKeepsWhatItHas) {
    const Workshop workshop;
    // Little to load, much to trace.
    const Finished finished =
        interrupted(workshop, "INT", "10",
                    render("facing_mirrors.nff", {"--cells", "384x384", "--link-bits", "4", "--max-depth",
                                                  "60", "--min-weight", "0", "--ray-store", "61"}));
    expect_interrupted(workshop, finished);
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_GT(json.at("cycles").at("trace").get<std::int64_t>(), 0);
    EXPECT_GT(json.at("messages").at("rays").at("in_flight").get<std::int64_t>(), 0);
}

TEST(Interrupted, SyntheticTrafficToo) {
    const Workshop workshop;
    const Finished finished = interrupted(workshop, "TERM", "4",
                                          {RAYCELL_DEADLOCK_TB, "--cells", "256x256", "--generations", "40",
                                           "--ray-store", "41", "-o", "results/a"});
    EXPECT_EQ(finished.exit_code, 5) << finished.err.substr(0, 2000);
    const Json json = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(json.at("verdict"), "interrupted");
    EXPECT_TRUE(json.at("equals_untimed").get<bool>()) << "of the pixels that are finished";
}

}  // namespace
}  // namespace raycell::system_test
