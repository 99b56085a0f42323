// Unwritable results, files that must not be overwritten, lack of memory, unwritable output: one clear
// message, the documented exit code, nothing lost.
#include <algorithm>

#include "limited.hpp"

namespace raycell::system_test {
namespace {

void expect_one_message(const Finished& finished, const std::string& part) {
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.signal, 0);
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_TRUE(contains(finished.err, part)) << "no '" << part << "' in: " << finished.err;
}

// ---- found before the run, before the scene is even looked for

TEST(Output, AFolderWhereAnyFileShouldGoIsFoundBeforeTheRun) {
    const Workshop workshop;
    const auto refuses = [&](const std::string& program, const Words& words,
                             const std::vector<std::string>& suffixes) {
        for (const std::string& suffix : suffixes) {
            SCOPED_TRACE(program + ", a folder stands where a" + suffix + " should go");
            fs::create_directory(workshop.result("a" + suffix));
            expect_one_message(workshop.run_program(program, joined(words, {"-o", "results/a", "--quiet"})),
                               "results/a" + suffix);
            EXPECT_EQ(workshop.results(), std::vector<std::string>{"a" + suffix});
            fs::remove(workshop.result("a" + suffix));
        }
    };
    const std::vector<std::string> render = {".exr",        ".png",      ".cells.csv", ".ledger.csv",
                                             ".waits.json", ".knot.svg", ".toml",      ".json"};
    refuses(RAYCELL_PROGRAM, {"render", "none.nff"}, render);
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--engine", "untimed"}, render);
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--truth"},
            {".truth.exr", ".truth.png", ".difference.png"});
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--probe", "1,1"}, {".vcd", ".gtkw"});
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--vcd-on-deadlock"}, {".vcd", ".gtkw"});
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--golden", "1,1..2"},
            {".golden_1_1.txt", ".golden_1_2.txt"});
    refuses(RAYCELL_PROGRAM, {"render", "none.nff", "--save-array", "results/a.array"}, {".array"});
    refuses(RAYCELL_PROGRAM, {"truth", "none.nff"}, {".exr", ".png", ".toml", ".json"});
    refuses(RAYCELL_PROGRAM, {"size", "none.nff", "--psnr", "40"}, {".csv", ".json", ".toml"});
    refuses(RAYCELL_LOADING_TB, {"none.nff"}, {".columns.csv", ".rows.csv", ".links.csv", ".toml", ".json"});
    refuses(RAYCELL_DEADLOCK_TB, {"--cells", "4x4"}, {".waits.json", ".toml", ".json"});
}

TEST(Output, ANameThatIsTooLongIsFoundBeforeTheRun) {
    const Workshop workshop;
    const std::string name = "results/" + std::string(250, 'a');
    for (const Words& words : {Words{"render", "none.nff"}, Words{"truth", "none.nff"}}) {
        expect_one_message(workshop.run(joined(words, {"-o", name})), "File name too long");
    }
    expect_one_message(workshop.run({"render", "none.nff", "-o", "results/a", "--save-array", name}),
                       "File name too long");
    EXPECT_TRUE(workshop.results().empty());
}

// ---- input files are not overwritten

class Spared : public ::testing::Test {
  protected:
    Spared() {
        workshop.write("scene.nff", scene);
        fs::create_hard_link(workshop.path() / "scene.nff", workshop.path() / "hard");
        fs::create_symlink("scene.nff", workshop.path() / "link");
    }
    void refuses(const Words& words, const std::string& what) const {
        std::string line;
        for (const std::string& word : words) line += word + " ";
        SCOPED_TRACE(line);
        expect_one_message(workshop.run(words), what);
        EXPECT_TRUE(workshop.results().empty());
    }

    const std::string scene = read_text(own_scene("cornell.nff"));
    Workshop workshop;
};

TEST_F(Spared, TheSceneByWhateverName) {
    for (const std::string name : {"scene.nff", "./results/../scene.nff", "hard", "link"}) {
        refuses({"render", "scene.nff", "--cells", "4x4", "-o", "results/a", "--save-array", name},
                name + ": it would be overwritten, but is the run's scene");
        EXPECT_EQ(read_text(workshop.path() / "scene.nff"), scene);
    }
}

TEST_F(Spared, EveryOtherInput) {
    workshop.write("view", scene);
    workshop.write("run.toml", "depth = 9\n");
    workshop.write("plain.json", "depth = 9\n");
    workshop.write("mesh.obj", "mtllib mesh.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    workshop.write("mesh.mtl", "newmtl red\nKd 1 0 0\n");
    const Words render = {"render", "scene.nff", "--cells", "4x4", "-o", "results/a"};
    refuses(joined(render, {"--view", "view", "--save-array", "view"}), "is the run's view");
    refuses(joined(render, {"--config", "run.toml", "--save-array", "run.toml"}),
            "is the run's configuration");
    refuses({"render", "scene.nff", "--cells", "4x4", "--config", "plain.json", "-o", "plain"},
            "is the run's configuration");
    refuses({"render", "mesh.obj", "--cells", "4x4", "-o", "results/a", "--save-array", "mesh.mtl"},
            "is the run's material library");
    refuses(joined(render, {"--save-array", "results/a.json"}), "--output has a file of this name");
    ASSERT_EQ(workshop.run(joined(render, {"--save-array", "b.exr"})).exit_code, 0);
    for (const std::string& name : workshop.results()) fs::remove(workshop.result(name));
    refuses({"render", "scene.nff", "--cells", "4x4", "--load-array", "b.exr", "-o", "b"},
            "is the run's loaded array");
}

TEST_F(Spared, AConfigurationMayBeReplacedByThatOfItsOwnRepetition) {
    ASSERT_EQ(workshop.run({"render", "scene.nff", "--cells", "4x4", "-o", "results/a"}).exit_code, 0);
    const std::string before = read_text(workshop.result("a.toml"));
    const Finished finished = workshop.run({"render", "--config", "results/a.toml", "-o", "results/a"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(read_text(workshop.result("a.toml")), before);
}

TEST_F(Spared, PicturesThatAreCompared) {
    for (const std::string name : {"a", "b"})
        ASSERT_EQ(workshop.render("scene.nff", {"--cells", "4x4", "--engine", "untimed"}, name).exit_code, 0);
    fs::create_hard_link(workshop.result("a.exr"), workshop.path() / "other");
    const auto before = workshop.contents();
    for (const std::string name : {"results/a.exr", "results/b.exr", "results/../other"}) {
        expect_one_message(workshop.run({"compare", "results/a.exr", "results/b.exr", "-o", name}),
                           "it would be overwritten, but is to be compared");
        EXPECT_EQ(workshop.contents(), before);
    }
}

TEST_F(Spared, GoldenVectorsThatAreReplayed) {
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"hit", "--write", "results/golden.vcd"}).exit_code, 0);
    const auto before = workshop.contents();
    expect_one_message(workshop.run_program(RAYCELL_CELL_TB, {"--replay", "results/golden.vcd", "--vcd",
                                                              "results/golden.vcd"}),
                       "it would be overwritten, but is to be replayed");
    EXPECT_EQ(workshop.contents(), before);
}

// ---- standard output

/// Runs the program with its standard output redirected by a shell.
Finished run_led(const Workshop& workshop, const std::string& where, const std::string& program,
                 const Words& words) {
    return workshop.run_program("/bin/sh", joined({"-c", "exec \"$0\" \"$@\" " + where, program}, words));
}

TEST(StandardOutput, ThatFailsIsAnErrorOfEveryProgram) {
    const Workshop workshop;
    const std::string scene = own_scene("cornell.nff").string();
    ASSERT_EQ(workshop.render(scene, {"--cells", "4x4"}, "old").exit_code, 0);
    const std::string old = "results/old.exr";
    const std::vector<std::pair<std::string, Words>> runs = {
        {RAYCELL_PROGRAM, {"render", scene, "--cells", "4x4", "-o", "results/a"}},
        {RAYCELL_PROGRAM, {"truth", scene, "--cells", "4x4", "-o", "results/a"}},
        {RAYCELL_PROGRAM, {"truth", scene, "--count", "3"}},
        {RAYCELL_PROGRAM, {"size", scene, "--cells", "4x4", "--psnr", "10", "-o", "results/a"}},
        {RAYCELL_PROGRAM, {"compare", old, old}},
        {RAYCELL_PROGRAM, {"compare", old, old, "--json"}},
        {RAYCELL_PROGRAM, {"render", "--help"}},
        {RAYCELL_DEADLOCK_TB, {"--cells", "4x4"}},
        {RAYCELL_LOADING_TB, {scene, "--cells", "4x4"}},
        {RAYCELL_CELL_TB, {"hit"}},
        {RAYCELL_CELL_TB, {"--list"}}};
    for (const auto& [program, words] : runs) {
        for (const std::string where : {">/dev/full", ">&-"}) {
            SCOPED_TRACE(program + " " + words[0] + " " + where);
            expect_one_message(run_led(workshop, where, program, words), "standard output can't be written");
        }
    }
}

TEST(StandardOutput, ThatIsClosedGoesIntoNoFile) {
    const Workshop workshop;
    const Words words = {"render", own_scene("cornell.nff").string(), "--cells", "4x4", "-o", "results/a"};
    ASSERT_EQ(workshop.run(words).exit_code, 0);
    const auto before = workshop.contents();
    for (const std::string where : {">&-", "2>&-", "<&- >&- 2>&-"}) {
        run_led(workshop, where, RAYCELL_PROGRAM, words);
        for (const auto& [name, content] : workshop.contents()) {
            EXPECT_TRUE(name == "a.json" || content == before.at(name)) << name << " " << where;
        }
        EXPECT_TRUE(Json::accept(read_text(workshop.result("a.json"))));
        EXPECT_EQ(run_led(workshop, where, RAYCELL_PROGRAM, joined(words, {"--quiet"})).exit_code, 0)
            << "nothing was to be printed";
    }
}

TEST(StandardOutput, WhoseReaderIsGoneIsAnError) {
    const Workshop workshop;
    const Finished finished =
        workshop.run_program("/bin/sh", {"-c", "(\"$@\"; echo $? >code) | true", "sh", RAYCELL_PROGRAM,
                                         "render", own_scene("cornell.nff").string(), "--cells", "8x8",
                                         "--watch-pixel", "1..4,1..4", "-o", "results/a"});
    const std::string code = read_text(workshop.path() / "code");
    EXPECT_TRUE(code == "1\n" || code == "0\n") << code << finished.err;  // 0: written before it was gone
}

// ---- memory

#ifndef __SANITIZE_ADDRESS__
TEST(Memory, ThatRunsOutIsSaidInOneMessage) {
    const Workshop workshop;
    const std::string scene = own_scene("still_life.nff").string();
    const std::vector<std::pair<std::string, Words>> runs = {
        {RAYCELL_PROGRAM, {"render", scene, "--cells", "96x96", "--max-cycles", "3000", "-o", "results/a"}},
        {RAYCELL_PROGRAM,
         {"render", scene, "--cells", "96x96", "--granularity", "cell", "--max-cycles", "3000", "-o",
          "results/a"}},
        {RAYCELL_PROGRAM,
         {"render", scene, "--cells", "128x128", "--engine", "untimed", "--depth", "1024", "-o",
          "results/a"}},
        {RAYCELL_PROGRAM, {"truth", scene, "--cells", "256x256", "-o", "results/a"}},
        {RAYCELL_DEADLOCK_TB, {"--cells", "96x96", "--max-cycles", "1000", "-o", "results/a"}},
        {RAYCELL_LOADING_TB, {scene, "--cells", "64x64", "--max-cycles", "3000", "-o", "results/a"}}};
    for (const auto& [program, words] : runs) {
        int refused = 0;
        int ran_out = 0;
        for (int megabytes = 20; megabytes < 800; megabytes += std::max(4, megabytes / 16)) {
            SCOPED_TRACE(program + " " + words[0] + " with " + std::to_string(megabytes) + " MB");
            // A program that can't even be loaded reports that itself.
            if (run_within(megabytes, workshop, program, {"--help"}).exit_code != 0) continue;
            const Finished finished = run_within(megabytes, workshop, program, words);
            if (finished.exit_code == 0 || finished.exit_code == 4) break;  // enough
            ++refused;
            // Foretold before the run, or found in it.
            const bool foretold = contains(finished.err, "are free; expected a smaller array");
            ran_out += !foretold;
            expect_one_message(finished, foretold ? "--cells: " : "out of memory");
            EXPECT_TRUE(workshop.results().empty());
        }
        EXPECT_GT(refused, 0) << program << " " << words[0];
        EXPECT_GT(ran_out, 0) << program << " " << words[0];
        for (const std::string& name : workshop.results()) fs::remove(workshop.result(name));
    }
}

// Libraries meet the end of memory in places of their own, each between two limits that lie close together.
TEST(Memory, ThatRunsOutInALibraryIsSaidTheSameWay) {
    const Workshop workshop;
    const Words run = {"render",
                       own_scene("still_life.nff").string(),
                       "--cells",
                       "40x40",
                       "--granularity",
                       "cell",
                       "--max-cycles",
                       "100",
                       "-o",
                       "results/a"};
    int kilobytes = 20000;
    while (run_within_kilobytes(kilobytes, workshop, RAYCELL_PROGRAM, {"--help"}).exit_code != 0)
        kilobytes += 2000;
    int refused = 0;
    for (;; kilobytes += 440) {
        SCOPED_TRACE(std::to_string(kilobytes) + " kB");
        const Finished finished = run_within_kilobytes(kilobytes, workshop, RAYCELL_PROGRAM, run);
        if (finished.exit_code == 4) break;  // enough
        ASSERT_LT(kilobytes, 800000);
        ++refused;
        const bool foretold = contains(finished.err, "are free; expected a smaller array");
        expect_one_message(finished, foretold ? "--cells: " : "out of memory");
    }
    EXPECT_GT(refused, 10);
}
#endif

}  // namespace
}  // namespace raycell::system_test
