// cell_tb's scenarios, run and written as golden vectors.
#include "golden_files.hpp"

namespace raycell::system_test {
namespace {

TEST(CellTb, PassesEveryScenario) {
    const Workshop workshop;
    const Finished all = workshop.run_program(RAYCELL_CELL_TB, {});
    EXPECT_EQ(all.exit_code, 0) << all.err;
    EXPECT_EQ(all.err, "");
    for (const char* name :
         {"broadcast", "span", "straight", "hit", "hit_returns", "return", "full_store", "back_pressure"})
        EXPECT_TRUE(contains(all.out, std::string("passed  ") + name + ":")) << all.out;
    EXPECT_FALSE(contains(all.out, "FAILED"));
    EXPECT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"--quiet"}).out, "");
}

/// Without its bits a message may hold anything: what would break the cell is told.
TEST(CellTb, AMessageThatNoCellCanBeSentIsRefused) {
    const Workshop workshop;
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"blocked", "--write", "results/a.txt"}).exit_code, 0);
    const Vectors vectors = read_vectors(workshop.result("a.txt").string());
    const auto said = [&](const std::string& kind, std::size_t word, const std::string& other) {
        Vectors altered = vectors;
        for (std::size_t i = altered.first; i < altered.lines.size(); ++i) {
            Words words = split(altered.lines[i]);
            if (words.size() < word || words[1] != "in" || words[6] != kind) continue;
            words[5] = "-";
            words[word] = other;
            altered.lines[i].clear();
            for (const std::string& each : words)
                altered.lines[i] += (altered.lines[i].empty() ? "" : " ") + each;
        }
        EXPECT_NE(altered.lines, vectors.lines);
        const Finished finished =
            replay(workshop, {workshop.write("b.txt", text_of(altered.lines)).string()});
        EXPECT_EQ(finished.signal, 0);
        EXPECT_GT(finished.exit_code, 0);
        return finished.err;
    };
    const std::string own = said("shadow_ray", 18, "1");  // home_x: of this cell, which has sent none
    EXPECT_TRUE(contains(own, "a slot that was never used")) << own;
    const std::string infinite = said("span", 11, "inf");
    EXPECT_TRUE(contains(infinite, "not far outside its format")) << infinite;
}

TEST(CellTb, EveryScenarioAsAFileReplaysAndAnyAlteredWordOfWhatIsExpectedIsFound) {
    const Workshop workshop;
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"--write", "results/"}).exit_code, 0);
    Words files;
    for (const std::string& name : workshop.results()) {
        if (contains(name, ".txt")) files.push_back(workshop.result(name).string());
    }
    ASSERT_GE(files.size(), 22u);
    EXPECT_EQ(workshop.results().size(), 3 * files.size()) << "each with two files for $readmemh";
    const Finished all = replay(workshop, files);
    EXPECT_EQ(all.exit_code, 0) << all.err.substr(0, 2000);
    for (const std::string& file : files) {
        property::Random random(std::hash<std::string>{}(fs::path(file).filename().string()));
        Vectors vectors = read_vectors(file);
        for (std::size_t line = vectors.first; line + 1 < vectors.lines.size(); ++line) {
            const std::string original = vectors.lines[line];
            Words words = counted(original);
            EXPECT_EQ(has_bits(words), words[1] == "in" || words[1] == "out") << file << ": " << original;
            if (words[1] != "out" && words[1] != "take" && words[1] != "pixel") continue;
            const auto at = std::size_t(random.whole(2, int(words.size()) - 1));
            words[at] = at == bits_at && has_bits(words) ? other_bits(words[at], random) : other(words[at]);
            vectors.lines[line].clear();
            for (const std::string& word : words) vectors.lines[line] += word + " ";
            const Finished found =
                replay(workshop, {workshop.write("altered.txt", text_of(vectors.lines)).string()});
            EXPECT_GT(found.exit_code, 0) << file << ": " << vectors.lines[line] << "\nwas " << original;
            vectors.lines[line] = original;
        }
    }
}

TEST(CellTb, AScenarioFailsWhereACycleIsAnother) {
    const Workshop workshop;
    const std::string file = workshop.result("hit.txt").string();
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"hit_returns", "--write", file}).exit_code, 0);
    EXPECT_EQ(replay(workshop, {file}).exit_code, 0);
    Vectors vectors = read_vectors(file);
    std::size_t line = vectors.first;
    while (!contains(vectors.lines[line], " take west 0") || std::stoi(split(vectors.lines[line])[0]) < 100)
        ++line;
    const std::string cycle = split(vectors.lines[line])[0];
    const std::string early = std::to_string(std::stoi(cycle) - 1);
    vectors.lines[line].replace(0, cycle.size(), early);
    const Finished finished =
        replay(workshop, {workshop.write("early.txt", text_of(vectors.lines)).string()});
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_TRUE(contains(finished.err, "expected in cycle " + early)) << finished.err;
    EXPECT_TRUE(contains(finished.out, "0 of 1 passed"));
}

TEST(CellTb, DrawsWaveformsOfOneScenario) {
    const Workshop workshop;
    const std::string vcd = workshop.result("hit.vcd").string();
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"hit", "--vcd", vcd}).exit_code, 0);
    EXPECT_EQ(workshop.results(), (std::vector<std::string>{"hit.gtkw", "hit.vcd"}));
    EXPECT_TRUE(contains(read_text(vcd), "cell_1_1"));
    EXPECT_TRUE(contains(read_text(vcd), "$enddefinitions"));
}

TEST(CellTb, RefusesWhatItDoesNotKnow) {
    const Workshop workshop;
    const auto exit_code = [&](const Words& words) {
        return workshop.run_program(RAYCELL_CELL_TB, words).exit_code;
    };
    EXPECT_EQ(exit_code({"no_such_scenario"}), 1);
    EXPECT_EQ(exit_code({"--replay", "nowhere.txt"}), 1);
    EXPECT_EQ(exit_code({"--vcd", "all.vcd"}), 1) << "waveforms of more than one cell";
    EXPECT_EQ(exit_code({"hit", "--vcd", "name"}), 1);
    EXPECT_EQ(exit_code({"--write", "file"}), 1);
    EXPECT_EQ(exit_code({"hit", "span", "--write", "file"}), 1);
    EXPECT_EQ(exit_code({"--replay", "a", "--list"}), 1);
    EXPECT_EQ(exit_code({"--list"}), 0);
    EXPECT_TRUE(workshop.results().empty());
}

}  // namespace
}  // namespace raycell::system_test
