// Every run ends with a stated verdict, its exit code and its files.
#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

/// Seconds of processor time within which a stuck run must end; measured: 3 at most.
constexpr double soon = 60;

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t times = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
    return times;
}

/// Runs to `verdict` and returns the report.
Json expect_verdict(const Workshop& workshop, const std::string& scene, const Words& words,
                    const std::string& verdict, int exit_code) {
    const Finished finished = workshop.render(own_scene(scene), joined({"--cells", "32x32"}, words));
    std::string line = scene;
    for (const std::string& word : words) line += " " + word;
    SCOPED_TRACE(line);
    EXPECT_FALSE(finished.timed_out) << "it hangs";
    EXPECT_LT(finished.seconds, soon);
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err.substr(0, 2000);
    EXPECT_TRUE(contains(finished.err, "verdict " + verdict)) << finished.err.substr(0, 2000);
    EXPECT_LE(finished.error_lines(), 20u) << "the rest of a long report belongs into the JSON";
    const bool stuck = verdict == "deadlock" || verdict == "livelock";
    EXPECT_EQ(count(finished.err, "; certain to end with --"), stuck ? 2u : 0u)
        << "a warning before the run, and why it was right: " << finished.err.substr(0, 2000);
    EXPECT_EQ(workshop.usual_results(),
              (std::vector<std::string>{"a.cells.csv", "a.exr", "a.json", "a.png", "a.toml"}))
        << "what a machine did until it stopped is of use";
    EXPECT_EQ(fs::exists(workshop.result("a.knot.svg")), verdict == "deadlock");
    if (!fs::exists(workshop.result("a.json"))) return {};
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    expect_sound(report);
    EXPECT_EQ(report.at("verdict"), verdict);
    for (const Pixel& pixel : read_exr(workshop.result("a.exr")).pixels) {
        if (!std::isfinite(pixel.colour.r + pixel.colour.g + pixel.colour.b)) {
            ADD_FAILURE() << "a pixel is no number";
            break;
        }
    }
    return report;
}

TEST(Verdict, OneNetworkForAllDeadlocksOnMirrors) {
    const Workshop workshop;
    const Json report = expect_verdict(workshop, "facing_mirrors.nff",
                                       {"--buffer", "1", "--networks", "shared"}, "deadlock", 3);
    EXPECT_GE(report.at("deadlock").at("report").size(), 2u);
    EXPECT_LT(report.at("cycles").at("trace").get<double>(), 1e7);  // counted up to where it stopped
    EXPECT_GT(report.at("ray_store").at("mean").get<double>(), 0);  // stuck rays count
    EXPECT_LE(report.at("ray_store").at("mean").get<double>(),
              report.at("ray_store").at("peak").get<double>());
    for (const auto& line : report.at("deadlock").at("report")) {
        EXPECT_TRUE(contains(line, "cell (") || contains(line, "link ")) << line;
    }
}

TEST(Verdict, RaysApartFromAnswersDeadlockOnMirrors) {
    const Workshop workshop;
    expect_verdict(workshop, "facing_mirrors.nff", {"--buffer", "1", "--networks", "split"}, "deadlock", 3);
}

TEST(Verdict, ShadowBitsCastOverOneNetworkDeadlock) {
    const Workshop workshop;
    const Json report =
        expect_verdict(workshop, "still_life.nff",
                       {"--buffer", "1", "--networks", "shared", "--shadows", "precast"}, "deadlock", 3);
    EXPECT_EQ(report.at("cycles").at("trace"), 0) << "it never came to tracing";
}

TEST(Verdict, AStoreOfOneWithoutRecoveryDeadlocks) {
    const Workshop workshop;
    const Json report = expect_verdict(workshop, "facing_mirrors.nff",
                                       {"--recovery", "none", "--ray-store", "1"}, "deadlock", 3);
    EXPECT_EQ(report.at("deadlock").at("postponed"), 0);
}

TEST(Verdict, MessagesThatCanNeverMoveAgainAreADeadlockWhileOthersArePostponed) {
    // Some trees are postponed for ever, but the ring of full buffers is a knot all the same.
    const Workshop workshop;
    expect_verdict(workshop, "still_life.nff", {"--buffer", "1", "--networks", "shared"}, "deadlock", 3);
}

TEST(Verdict, AStoreOfOneIsALivelockWhereTreesComeBackToTheirCells) {
    const Workshop workshop;
    for (const std::string slots : {"reserved", "free"}) {
        const Json report = expect_verdict(workshop, "facing_mirrors.nff",
                                           {"--ray-store", "1", "--slots", slots}, "livelock", 3);
        EXPECT_GT(report.at("deadlock").at("postponed").get<int>(), 0);
    }
}

/// The warning printed before a run, and the bound in its JSON.
struct Told {
    std::string err;
    Json bound;
};
Told told(const Workshop& workshop, const Words& words) {
    const Finished finished = workshop.render(own_scene("still_life.nff"),
                                              joined({"--cells", "12x12", "--max-cycles", "500"}, words));
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    return {finished.err.substr(0, finished.err.find("raycell: verdict")), report.at("deadlock").at("bound")};
}

TEST(Verdict, AMachineThatMayNeverEndIsWarnedOfBeforeItRunsWithTheOptionThatHelps) {
    const Workshop workshop;
    const Told few = told(workshop, {"--ray-store", "4", "--networks", "quadrant"});
    EXPECT_EQ(
        few.err,
        "raycell: warning: the run may end in a livelock: --ray-store 4 is less than the 5 generations that "
        "may have to wait; certain to end with --ray-store 5\n");
    EXPECT_FALSE(few.bound.at("met"));
    EXPECT_EQ(few.bound.at("may"), "livelock");
    EXPECT_EQ(few.bound.at("generations"), 5);
    EXPECT_EQ(few.bound.at("ray_store_needed"), 5);
    EXPECT_EQ(few.bound.at("options"), "--ray-store 5");
    EXPECT_TRUE(contains(few.err, few.bound.at("reason").get<std::string>()));

    const Told many = told(workshop, {"--ray-store", "5", "--networks", "quadrant"});
    EXPECT_EQ(many.err, "");
    EXPECT_TRUE(many.bound.at("met"));
    EXPECT_EQ(many.bound.at("options"), "");

    for (const auto& [words, option] : std::vector<std::pair<Words, std::string>>{
             {{"--buffer", "1", "--networks", "shared"}, "--networks half"},
             {{"--buffer", "1", "--networks", "split"}, "--networks half"},
             {{"--recovery", "none", "--ray-store", "200"}, "--recovery postpone"},
             {{"--slots", "free"}, "--slots reserved"}}) {
        const Told other = told(workshop, words);
        EXPECT_EQ(count(other.err, "\n"), 1u) << other.err;
        EXPECT_TRUE(contains(other.err, "certain to end with " + option + "\n")) << other.err;
        EXPECT_TRUE(other.bound.at("ray_store_needed").is_null());
    }
}

TEST(Verdict, NoWarningIsGivenWhereNothingIsTracedInTime) {
    const Workshop workshop;
    for (const Words& words : {Words{"--stage", "load"}, Words{"--engine", "untimed"}}) {
        const Finished finished = workshop.render(own_scene("still_life.nff"),
                                                  joined({"--cells", "12x12", "--ray-store", "1"}, words));
        EXPECT_EQ(finished.err, "");
    }
}

TEST(Verdict, AsManySlotsAsGenerationsAlwaysComeToAnEnd) {
    const Workshop workshop;
    for (const std::string scene : {"cornell.nff", "facing_mirrors.nff", "still_life.nff"}) {
        for (const int depth : {0, 1, 2, 4, 7}) {
            for (const std::string networks : {"half", "quadrant"}) {
                SCOPED_TRACE(networks);
                // One slot more than max_depth, since the last generation waits for its shadow rays.
                const Json report = workshop.report(
                    own_scene(scene), {"--cells", "24x24", "--max-depth", std::to_string(depth),
                                       "--ray-store", std::to_string(depth + 1), "--networks", networks});
                if (!report.is_null()) {
                    EXPECT_EQ(report.at("verdict"), "completed") << scene << " " << depth;
                }
            }
        }
    }
}

TEST(Verdict, AnArrayOfOneRowOrColumnOrCellComesToAnEnd) {
    const Workshop workshop;
    for (const std::string cells : {"1x1", "2x1", "1x2", "100x1", "1x100"}) {
        for (const std::string shadows : {"per-hit", "precast", "memo"}) {
            const Json report =
                workshop.report(own_scene("still_life.nff"), {"--cells", cells, "--shadows", shadows});
            if (!report.is_null()) {
                EXPECT_EQ(report.at("verdict"), "completed");
            }
        }
    }
}

/// Cycles of each phase of a run.
struct PhaseCycles {
    std::int64_t load, precast, trace, total;
};
PhaseCycles phases(const Json& report) {
    const Json& cycles = report.at("cycles");
    return {cycles.at("load"), cycles.at("precast"), cycles.at("trace"), cycles.at("total")};
}

TEST(Verdict, ALimitOfCyclesHoldsInEveryPhase) {
    const Workshop workshop;
    const Words shadows = {"--shadows", "precast"};
    const PhaseCycles whole =
        phases(workshop.report(own_scene("cornell.nff"), joined({"--cells", "32x32"}, shadows)));
    ASSERT_GT(whole.precast, 1);
    for (const std::int64_t limit : {std::int64_t(1), whole.load / 2, whole.load + whole.precast / 2,
                                     whole.load + whole.precast + whole.trace / 2}) {
        const PhaseCycles cut = phases(
            expect_verdict(workshop, "cornell.nff", joined(shadows, {"--max-cycles", std::to_string(limit)}),
                           "cycle_limit", 4));
        EXPECT_LE(cut.total, limit);
        // Nothing else may move while a cell makes a voxel.
        EXPECT_GT(cut.total, limit - 2500) << "it stopped long before";
    }
}

TEST(Verdict, ALimitOfCyclesThatARunDoesNotReachChangesNothing) {
    const Workshop workshop;
    const Words words = {"--cells", "32x32", "--shadows", "precast"};
    const Json whole = workshop.report(own_scene("cornell.nff"), words);
    const std::int64_t total = phases(whole).total;
    for (const std::int64_t limit : {total - 1, total, total + 1, 2 * total}) {
        const Finished finished =
            workshop.render(own_scene("cornell.nff"), joined(words, {"--max-cycles", std::to_string(limit)}));
        if (finished.exit_code == 4 && limit < total) continue;
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        const Json report = Json::parse(read_text(workshop.result("a.json")));
        EXPECT_EQ(report.at("cycles"), whole.at("cycles")) << "with --max-cycles " << limit;
        EXPECT_EQ(schedule(report), schedule(whole));
        EXPECT_EQ(image(report), image(whole));
    }
}

TEST(Verdict, VoxelsThatDoNotFitAreCountedAndNamed) {
    const Workshop workshop;
    const Json whole = workshop.report(own_scene("still_life.nff"), {"--cells", "32x32"});
    for (const std::string engine : {"timed", "untimed"}) {
        const Json report = expect_verdict(workshop, "still_life.nff",
                                           {"--voxel-capacity", "1", "--engine", engine}, "capacity", 4);
        const Json& voxels = report.at("voxels");
        EXPECT_GT(voxels.at("overflowed"), 0);
        EXPECT_EQ(voxels.at("max_per_cell"), 1);
        EXPECT_EQ(voxels.at("stored").get<int>() + voxels.at("overflowed").get<int>(),
                  whole.at("voxels").at("stored").get<int>())
            << "none is dropped in silence";
    }
    const int most = whole.at("voxels").at("max_per_cell");
    const Json fits = workshop.report(own_scene("still_life.nff"),
                                      {"--cells", "32x32", "--voxel-capacity", std::to_string(most)});
    EXPECT_EQ(fits.at("verdict"), "completed");
    EXPECT_EQ(image(fits), image(whole));
}

TEST(Verdict, ALoadedPictureNeedsNoCycleOfTracing) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("still_life.nff"), {"--cells", "32x32", "--stage", "load"});
    EXPECT_EQ(report.at("verdict"), "completed");
    EXPECT_EQ(report.at("cycles").at("precast"), 0);
    EXPECT_EQ(report.at("cycles").at("trace"), 0);
    EXPECT_EQ(report.at("rays").at("primary"), 0);
}

// ---- compare

class Compare : public ::testing::Test {
  protected:
    Compare() {
        for (const std::string hit : {"edge", "interval"}) {
            workshop.report(own_scene("still_life.nff"),
                            {"--cells", "16x16", "--engine", "untimed", "--hit", hit}, 0, hit);
        }
        workshop.report(own_scene("still_life.nff"), {"--cells", "16x17", "--engine", "untimed"}, 0, "other");
    }
    Finished compare(const std::string& a, const std::string& b, const Words& words = {}) const {
        return workshop.run(joined({"compare", "results/" + a, "results/" + b}, words));
    }
    Workshop workshop;
};

TEST_F(Compare, EndsWithTwoWherePicturesDifferByMoreThanAllowed) {
    EXPECT_EQ(compare("interval.exr", "edge.exr").exit_code, 0) << "nothing was asked for";
    EXPECT_EQ(compare("interval.exr", "edge.exr", {"--psnr", "5"}).exit_code, 0);
    EXPECT_EQ(compare("interval.exr", "edge.exr", {"--psnr", "60"}).exit_code, 2);
    EXPECT_EQ(compare("interval.png", "edge.png", {"--psnr", "60"}).exit_code, 2);
    EXPECT_EQ(compare("interval.exr", "edge.exr", {"--wrong-hits", "0"}).exit_code, 2);
}

TEST_F(Compare, FindsAPictureEqualToItself) {
    const Finished finished = compare(
        "edge.exr", "edge.exr", {"--psnr", "200", "--wrong-hits", "0", "--json", "-o", "results/d.png"});
    EXPECT_EQ(finished.exit_code, 0);
    const Json json = Json::parse(finished.out);
    EXPECT_EQ(json.at("psnr_db"), 200);
    EXPECT_EQ(json.at("max_error"), 0);
    EXPECT_EQ(json.at("wrong_hit_percent"), 0);
    for (const Pixel& pixel : read_png(workshop.result("d.png")).pixels) ASSERT_EQ(pixel.colour, dvec3(0));
}

TEST_F(Compare, FindsThePngAsNearToTheExrAsEightBitsAllow) {
    EXPECT_EQ(compare("edge.png", "edge.exr", {"--psnr", "52"}).exit_code, 0);
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
    for (const std::string file : {"other.exr", "edge.json", "missing.png"}) {
        const Finished finished = compare("edge.exr", file);
        EXPECT_EQ(finished.exit_code, 1) << file;
        EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    }
    EXPECT_EQ(compare("edge.exr", "edge.exr", {"--psnr", "nan"}).exit_code, 1);
    EXPECT_EQ(compare("edge.exr", "edge.exr", {"--psnr", "201"}).exit_code, 1);
    EXPECT_EQ(compare("edge.exr", "edge.exr", {"-o", "/dev/null/d.png"}).exit_code, 1);
}

}  // namespace
}  // namespace raycell::system_test
