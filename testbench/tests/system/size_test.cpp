// raycell size: the machine found is accurate enough, and no machine one step smaller is.
#include <algorithm>
#include <map>
#include <set>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const Words small_array = {"--cells", "24x18"};

/// Runs `raycell size` on an own scene and expects `exit_code`; returns its JSON.
Json size(const Workshop& workshop, const std::string& scene, const Words& words, int exit_code = 0) {
    const Finished finished = workshop.run(joined(
        {"size", own_scene(scene).string(), "--quiet", "-o", "results/s"}, joined(small_array, words)));
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
    EXPECT_EQ(finished.out, "") << "--quiet";
    if (!fs::exists(workshop.result("s.json"))) {
        ADD_FAILURE() << "no report was written";
        return {};
    }
    return Json::parse(read_text(workshop.result("s.json")));
}

/// Renders the machine found, changed by `words`, and the truth; returns the report.
Json rendered(const Workshop& workshop, const Words& words, int exit_code = 0) {
    const Finished finished = workshop.run(
        joined({"render", "--config", "results/s.toml", "--truth", "--quiet", "-o", "results/a"}, words));
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
    if (finished.exit_code != 0 && finished.exit_code != 4) return {};
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    expect_sound(report);
    return report;
}

bool reaches(const Json& report, const Json& goal) {
    return report.at("accuracy").at("scene").at("psnr_db").get<double>() >=
               goal.at("psnr_db").get<double>() &&
           report.at("accuracy").at("wrong_hit_percent").get<double>() <=
               goal.at("wrong_hit_percent").get<double>();
}

void expect_rendered_as_found(const Workshop& workshop, const Json& sized) {
    const Json report = rendered(workshop, {});
    const Json& found = sized.at("found");
    EXPECT_EQ(report.at("verdict"), "completed");
    EXPECT_TRUE(reaches(report, sized.at("goal")));
    EXPECT_EQ(report.at("accuracy").at("scene").at("psnr_db"), found.at("psnr_db"));
    EXPECT_EQ(report.at("accuracy").at("wrong_hit_percent"), found.at("wrong_hit_percent"));
    EXPECT_EQ(report.at("voxels").at("max_bits_per_cell"), found.at("bits_fullest_cell"));
    EXPECT_EQ(report.at("voxels").at("max_per_cell"), found.at("voxel_capacity"));
    EXPECT_EQ(report.at("ray_store"), sized.at("timed").at("ray_store"));
    EXPECT_EQ(image(report), image(sized.at("timed")));
    EXPECT_EQ(schedule(report), schedule(sized.at("timed")));
}

/// Options of render that each make one property of the machine found smaller.
std::vector<Words> steps_down(const Json& found) {
    std::vector<Words> steps;
    const int words = found.at("word_bits");
    const int levels = found.at("depth_levels");
    if (words > 8) steps.push_back({"--word-bits", std::to_string(words - 1)});
    if (levels > 1) {
        int power = 1;
        while (2 * power < levels) power *= 2;
        steps.push_back({"--depth", std::to_string(power)});
    }
    if (found.at("normals") == "linear") steps.push_back({"--normals", "voxel"});
    if (found.at("shadows") != "per-hit") steps.push_back({"--shadows", "per-hit"});
    const Words rungs = {"depth", "interval", "plane", "mask", "edge"};
    const auto rung = std::find(rungs.begin(), rungs.end(), found.at("hit").get<std::string>());
    if (rung != rungs.begin()) steps.push_back({"--hit", *(rung - 1)});
    return steps;
}

/// Whether the table lists the setting of a rendered report, with the same accuracy.
bool was_tried(const Json& sized, const Json& report) {
    const Json& config = report.at("config");
    const auto same = [&](const Json& trial) {
        return trial.at("hit") == config.at("hit") && trial.at("normals") == config.at("normals") &&
               trial.at("shadows") == config.at("shadows") &&
               trial.at("depth_levels") == config.at("depth") &&
               trial.at("word_bits") == config.at("word-bits") &&
               trial.at("psnr_db") == report.at("accuracy").at("scene").at("psnr_db");
    };
    const Json& tried = sized.at("tried");
    return std::any_of(tried.begin(), tried.end(), same);
}

void expect_smallest(const Workshop& workshop, const Json& sized) {
    for (const Words& step : steps_down(sized.at("found"))) {
        SCOPED_TRACE(step[0] + " " + step[1]);
        const Json report =
            rendered(workshop, joined({"--engine", "untimed", "--voxel-capacity", "0"}, step));
        const bool smaller = report.at("voxels").at("max_bits_per_cell").get<int>() <
                             sized.at("found").at("bits_fullest_cell").get<int>();
        EXPECT_FALSE(smaller && reaches(report, sized.at("goal")));
        EXPECT_TRUE(!smaller || was_tried(sized, report)) << "the table must show that it falls short";
    }
    const int capacity = sized.at("found").at("voxel_capacity");
    ASSERT_GT(capacity, 1);
    const Json report =
        rendered(workshop, {"--engine", "untimed", "--voxel-capacity", std::to_string(capacity - 1)}, 4);
    EXPECT_EQ(report.at("verdict"), "capacity");
}

TEST(Size, TheMachineFoundReachesThePsnrAndNoneOneStepSmallerDoes) {
    // The lowest goal is reached at a rung without planes, the highest only with edges and linear normals.
    for (const std::string psnr : {"14", "25", "33", "45"}) {
        SCOPED_TRACE(psnr + " dB");
        const Workshop workshop;
        const Json sized = size(workshop, "still_life.nff", {"--psnr", psnr});
        ASSERT_TRUE(sized.contains("found"));
        expect_rendered_as_found(workshop, sized);
        expect_smallest(workshop, sized);
    }
}

TEST(Size, TheMachineFoundHasFewEnoughWrongHitsAndNoneOneStepSmallerHas) {
    const Workshop workshop;
    const Json sized = size(workshop, "still_life.nff", {"--wrong-hits", "3"});
    ASSERT_TRUE(sized.contains("found"));
    expect_rendered_as_found(workshop, sized);
    expect_smallest(workshop, sized);
}

TEST(Size, BothGoalsAreReachedWhereBothAreGiven) {
    const Workshop workshop;
    const Json sized = size(workshop, "still_life.nff", {"--psnr", "20", "--wrong-hits", "0.5"});
    ASSERT_TRUE(sized.contains("found"));
    EXPECT_GE(sized.at("found").at("psnr_db").get<double>(), 20);
    EXPECT_LE(sized.at("found").at("wrong_hit_percent").get<double>(), 0.5);
    const Workshop loose;
    const Json one = size(loose, "still_life.nff", {"--psnr", "20"});
    EXPECT_GT(one.at("found").at("wrong_hit_percent").get<double>(), 0.5) << "else this tests nothing";
    EXPECT_LT(one.at("found").at("bits_fullest_cell").get<int>(),
              sized.at("found").at("bits_fullest_cell").get<int>());
}

TEST(Size, WithoutExteriorTheTruthIsClippedAndSoSaysTheConfiguration) {
    const Workshop workshop;
    const Json sized =
        size(workshop, "still_life.nff", {"--psnr", "30", "--exterior", "none", "--depth", "100"});
    ASSERT_TRUE(sized.contains("found"));
    EXPECT_LE(sized.at("found").at("depth_levels").get<int>(), 100);
    expect_rendered_as_found(workshop, sized);
}

TEST(Size, AGoalOutOfReachIsSaidPlainlyWithTheNearestAndNoConfigurationIsWritten) {
    const Workshop workshop;
    const Json sized = size(workshop, "still_life.nff", {"--psnr", "190"}, 2);
    EXPECT_EQ(sized.at("reached"), false);
    EXPECT_FALSE(sized.contains("found"));
    const std::string message = read_text(workshop.path() / "stderr.txt");
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    EXPECT_TRUE(contains(message, "no setting reaches the goal")) << message;
    const Json& nearest = sized.at("nearest");
    EXPECT_TRUE(contains(message, "words of " + nearest.at("word_bits").dump() + " bits")) << message;
    for (const Json& trial : sized.at("tried")) {
        EXPECT_FALSE(trial.at("meets").get<bool>());
        EXPECT_LE(trial.at("psnr_db").get<double>(), nearest.at("psnr_db").get<double>());
    }
    EXPECT_EQ(workshop.results(), (std::vector<std::string>{"s.csv", "s.json"}));
}

/// Accuracy may be a matter of luck in this scene, but the text must agree with the table.
TEST(Size, NoneIsSaidOnlyWhereNoRowOfTheTableMeetsTheGoal) {
    SKIP_WITHOUT_SHARED_SCENES();
    for (const std::string psnr : {"31", "34", "36", "60", "150", "200"}) {
        SCOPED_TRACE(psnr + " dB");
        const Workshop workshop;
        const Finished finished =
            workshop.run({"size", (shared_scenes() / "found" / "edge_on_pixels.nff").string(), "--psnr", psnr,
                          "--cells", "32x32", "-o", "results/s"});
        const bool row_meets = contains(finished.out, " yes |");
        EXPECT_EQ(finished.exit_code, row_meets ? 0 : 2) << finished.err << finished.out;
        EXPECT_EQ(contains(finished.err, "no setting reaches the goal"), !row_meets) << finished.err;
        EXPECT_EQ(contains(finished.out, "smallest machine: "), row_meets);
    }
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Size, TheTablesListWhatWasTriedAndTheFoundIsTheSmallestThatMeetsThere) {
    const Workshop workshop;
    const Finished finished = workshop.run(joined(
        {"size", own_scene("still_life.nff").string(), "-o", "results/s", "--psnr", "33"}, small_array));
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const Json sized = Json::parse(read_text(workshop.result("s.json")));
    const Json& tried = sized.at("tried");
    ASSERT_GT(tried.size(), 10u);
    EXPECT_EQ(lines_of(read_text(workshop.result("s.csv"))).size(), tried.size() + 1);
    const auto lines = lines_of(finished.out);
    ASSERT_GT(lines.size(), tried.size() + 2);
    std::set<std::string> hits;
    bool listed = false;
    for (std::size_t i = 0; i < tried.size(); ++i) {
        const Json& trial = tried[i];
        const std::string& line = lines[i + 2];
        EXPECT_EQ(line.size(), lines[0].size()) << "aligned";
        EXPECT_EQ(line.rfind("| " + trial.at("hit").get<std::string>() + " ", 0), 0u) << line;
        EXPECT_TRUE(contains(line, trial.at("meets").get<bool>() ? " yes |" : " no |")) << line;
        hits.insert(trial.at("hit").get<std::string>());
        EXPECT_TRUE(contains(line, " " + trial.at("bits_fullest_cell").dump() + " |")) << line;
        const bool meets = trial.at("psnr_db").get<double>() >= 33;
        EXPECT_EQ(trial.at("meets"), meets);
        if (meets) {
            EXPECT_GE(trial.at("bits_fullest_cell"), sized.at("found").at("bits_fullest_cell"));
        }
        listed = listed || trial.at("psnr_db") == sized.at("found").at("psnr_db");
    }
    EXPECT_TRUE(listed);
    EXPECT_EQ(hits.size(), 5u) << "every hit test is looked at";
    for (const std::string part : {"smallest machine: hit ", " 320 |", " 40960 |", "timed run: completed",
                                   "configuration: results/s.toml"}) {
        EXPECT_TRUE(contains(finished.out, part)) << part;
    }
}

TEST(Size, IsTheSameEveryTime) {
    std::map<std::string, std::set<std::string>> contents;
    for (int i = 0; i < 2; ++i) {
        const Workshop workshop;
        const Finished finished = workshop.run(joined(
            {"size", own_scene("cornell.nff").string(), "-o", "results/s", "--psnr", "25"}, small_array));
        ASSERT_EQ(finished.exit_code, 0) << finished.err;
        contents["output"].insert(finished.out);
        for (const std::string& name : workshop.results())
            contents[name].insert(read_text(workshop.result(name)));
    }
    EXPECT_EQ(contents.size(), 4u) << "text, .csv, .json, .toml";
    for (const auto& [name, texts] : contents) EXPECT_EQ(texts.size(), 1u) << name;
}

TEST(Size, TakesTheConfigurationThatItWrote) {
    const Workshop workshop;
    const Json sized = size(workshop, "cornell.nff", {"--psnr", "20"});
    ASSERT_TRUE(sized.contains("found"));
    const Finished again =
        workshop.run({"size", "--config", "results/s.toml", "--psnr", "20", "-o", "results/b"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(fs::exists(workshop.result("b.toml")));
}

// ---- what is refused

void expect_refused(const Words& words, const std::string& part) {
    const Workshop workshop;
    std::string line = "raycell size";
    for (const std::string& word : words) line += " '" + word + "'";
    SCOPED_TRACE(line);
    workshop.write("wrong.toml", "psnr = 300\n");
    const Finished finished = workshop.run(joined({"size"}, words));
    EXPECT_EQ(finished.exit_code, 1) << finished.err;
    EXPECT_EQ(finished.out, "");
    EXPECT_TRUE(contains(finished.err, part)) << "no '" << part << "' in: " << finished.err;
    EXPECT_EQ(workshop.results(), std::vector<std::string>());
}

TEST(Size, OnATerminalItShowsHowFarItIs) {
    const Workshop workshop;
    Running running(
        workshop, RAYCELL_PROGRAM,
        {"size", own_scene("cornell.nff").string(), "--cells", "8x8", "--psnr", "35", "-o", "results/s"});
    for (const std::string words :
         {"size: step 1 of 4, hit tests; run ", "size: step 2 of 4, normals and shadows; run ",
          "size: step 3 of 4, word lengths 1 of "}) {
        EXPECT_TRUE(running.says(words)) << words;
    }
    EXPECT_EQ(running.finish().exit_code, 0);
}

TEST(Size, GoalsThatCannotBeAreRefused) {
    const std::string scene = own_scene("cornell.nff").string();
    expect_refused({scene, "-o", "results/s"}, "no goal given");
    for (const std::string value : {"-1", "201", "nan", "inf", "abc", ""})
        expect_refused({scene, "-o", "results/s", "--psnr", value}, "--psnr: ");
    for (const std::string value : {"-0.1", "101", "nan", "many", ""})
        expect_refused({scene, "-o", "results/s", "--wrong-hits", value}, "--wrong-hits: ");
    expect_refused({scene, "-o", "results/s", "--psnr"}, "--psnr");
    expect_refused({scene, "-o", "results/s", "--config", "wrong.toml"}, "wrong.toml");
}

TEST(Size, WrongScenesPlacesAndOptionsAreRefused) {
    const std::string scene = own_scene("cornell.nff").string();
    const Words goal = {"--psnr", "30"};
    expect_refused(joined(goal, {"-o", "results/s"}), "no scene given");
    expect_refused(joined(goal, {"none.nff", "-o", "results/s"}), "none.nff");
    expect_refused(joined(goal, {scene, "-o", "/dev/null/s"}), "--output /dev/null/s");
    expect_refused(joined(goal, {scene, "-o", "results/s", "--depth", "0"}), "--depth: ");
    // Options that the search determines can't be given.
    expect_refused(joined(goal, {scene, "-o", "results/s", "--hit", "edge"}), "--hit");
    expect_refused(joined(goal, {scene, "-o", "results/s", "--word-bits", "20"}), "--word-bits");
}

}  // namespace
}  // namespace raycell::system_test
