// Golden vectors, end to end: raycell records the inputs and outputs of cells in a run, and cell_tb replays
// them with a cell alone.
#include <sstream>

#include "../property.hpp"
#include "program.hpp"

namespace raycell::system_test {
namespace {

Words records(const Workshop& workshop) {
    Words files;
    for (const std::string& name : workshop.results()) {
        if (contains(name, ".golden_")) files.push_back(workshop.result(name).string());
    }
    return files;
}

Finished replay(const Workshop& workshop, const Words& files, const Words& more = {}) {
    return workshop.run_program(RAYCELL_CELL_TB, joined(joined({"--replay"}, files), more));
}

struct Recorded {
    const char* name;
    const char* scene;
    Words options;
    int exit_code;
};

void PrintTo(const Recorded& r, std::ostream* out) { *out << r.name; }

class Golden : public ::testing::TestWithParam<Recorded> {};

TEST_P(Golden, WhatACellOfARunDidACellAloneDoesAgain) {
    const Workshop workshop;
    const Words options = joined({"--cells", "12x9"}, GetParam().options);
    const Finished plain =
        workshop.render(own_scene(std::string(GetParam().scene) + ".nff"), options, "plain");
    const Finished run = workshop.render(own_scene(std::string(GetParam().scene) + ".nff"),
                                         joined(options, {"--golden", "0..11,3..5"}), "a");
    ASSERT_EQ(run.exit_code, GetParam().exit_code) << run.err;
    ASSERT_EQ(plain.exit_code, run.exit_code);
    EXPECT_EQ(schedule(Json::parse(read_text(workshop.result("a.json")))),
              schedule(Json::parse(read_text(workshop.result("plain.json")))))
        << "recording changes nothing";
    const Words files = records(workshop);
    ASSERT_EQ(files.size(), 36u);
    const Finished again = replay(workshop, files);
    EXPECT_EQ(again.exit_code, 0) << again.err.substr(0, 3000);
    EXPECT_TRUE(contains(again.out, "36 of 36 passed")) << again.out;
    EXPECT_EQ(again.err, "");
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Golden,
    ::testing::Values(
        Recorded{"default", "still_life", {}, 0},
        Recorded{"mirrors", "facing_mirrors", {"--ray-store", "5"}, 0},
        Recorded{
            "stalls", "cornell", {"--stall", "0.3", "--networks", "quadrant", "--shadows", "precast"}, 0},
        Recorded{"exact", "still_life", {"--arithmetic", "exact", "--hit", "mask", "--buffer", "3"}, 0},
        Recorded{"long_words", "cornell", {"--word-bits", "32", "--slots", "nested", "--link-bits", "7"}, 0},
        Recorded{"short_words",
                 "cornell",
                 {"--word-bits", "8", "--viewer", "infinity", "--display", "gouraud"},
                 0},
        Recorded{"memo", "still_life", {"--shadows", "memo", "--ray-store", "8"}, 0},
        Recorded{"livelock",
                 "still_life",
                 {"--shadows", "memo", "--ray-store", "2", "--cost", "backoff=1", "--exterior", "none"},
                 3},
        Recorded{"cut_off",
                 "still_life",
                 {"--networks", "shared", "--recovery", "none", "--max-cycles", "130000"},
                 4},
        Recorded{"loaded", "cornell", {"--stage", "load"}, 0}),
    [](const auto& c) { return std::string(c.param.name); });

/// The lines of one record; its events begin at `first`.
struct Vectors {
    std::vector<std::string> lines;
    std::size_t first = 0;
};

Vectors read_vectors(const std::string& path) {
    Vectors v;
    std::istringstream in(read_text(path));
    for (std::string line; std::getline(in, line);) {
        if (line == "begin") v.first = v.lines.size() + 1;
        v.lines.push_back(line);
    }
    return v;
}

std::string text_of(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

Words split(const std::string& line) {
    std::istringstream in(line);
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

/// Another value of the same kind: a number or mantissa increased by one, or another word.
std::string other(const std::string& word) {
    if (word.find_first_not_of("-0123456789") == std::string::npos)
        return std::to_string(std::stoll(word) + 1);
    if (word.find_first_not_of("-0123456789:") == std::string::npos)
        return std::to_string(std::stoll(word) + 1) + word.substr(word.find(':'));
    return word == "inf" ? "1" : word == "shadow" ? "memo" : "shadow";
}

/// Changes one word of a record and replays the record.
class AlteredVectors : public ::testing::Test {
  protected:
    AlteredVectors() {
        workshop_.render(own_scene("still_life.nff"), {"--cells", "12x9", "--golden", "6,6"});
        original_ = read_vectors(workshop_.result("a.golden_6_6.txt").string());
    }
    Finished replay_with(std::size_t line, std::size_t at) {
        Vectors changed = original_;
        Words words = split(changed.lines[line]);
        words[at] = other(words[at]);
        std::string text;
        for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
        changed.lines[line] = text;
        return replay(workshop_, {workshop_.write("altered.txt", text_of(changed.lines)).string()});
    }
    std::size_t drawn_line(property::Random& random, bool expected) const {
        for (;;) {
            const auto line =
                std::size_t(random.whole(int(original_.first), int(original_.lines.size()) - 2));
            const std::string what = split(original_.lines[line])[1];
            if ((what == "out" || what == "take" || what == "pixel") == expected) return line;
        }
    }
    Workshop workshop_;
    Vectors original_;
};

TEST_F(AlteredVectors, AnyWordOfWhatIsExpectedCounts) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const std::size_t line = drawn_line(random, true);
        const Words words = split(original_.lines[line]);
        const auto at = std::size_t(random.whole(0, int(words.size()) - 1));
        if (words[at] == "take" || words[at] == "out" || words[at] == "pixel") continue;
        const Finished finished = replay_with(line, at);
        EXPECT_NE(finished.exit_code, 0) << words[at] << " in " << original_.lines[line];
        EXPECT_EQ(finished.signal, 0);
        EXPECT_NE(finished.err, "");
    }
}

TEST_F(AlteredVectors, ADifferenceIsNamedByCycleLineAndField) {
    std::size_t line = original_.first;
    while (!contains(original_.lines[line], " out ") || !contains(original_.lines[line], " ray ")) ++line;
    const Finished finished = replay_with(line, 17);  // dx
    EXPECT_EQ(finished.exit_code, 2);
    const Words words = split(original_.lines[line]);
    EXPECT_TRUE(contains(finished.err, "cycle " + words[0] + " (line " + std::to_string(line + 1) +
                                           "): out " + words[2] + " " + words[3] + ": field 'dx' is " +
                                           words[17]))
        << finished.err;
}

TEST_F(AlteredVectors, WhateverACellIsToldItIsCheckedAndNothingBreaks) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const std::size_t line = drawn_line(random, false);
        const Words words = split(original_.lines[line]);
        const Finished finished = replay_with(line, std::size_t(random.whole(0, int(words.size()) - 1)));
        EXPECT_EQ(finished.signal, 0) << original_.lines[line];
        EXPECT_GE(finished.exit_code, 0);
        EXPECT_LE(finished.exit_code, 2);
        EXPECT_EQ(finished.exit_code == 0, finished.err.empty());
    }
}

/// The record is unchanged, but the cell has other costs.
TEST_F(AlteredVectors, ACellThatTakesAnotherTimeFails) {
    for (const std::string change : {"walk_step=5", "route_return=2", "shade_setup=21", "load_voxel=13"}) {
        Vectors changed = original_;
        const std::string name = change.substr(0, change.find('=') + 1);
        for (std::string& line : changed.lines) {
            const auto at = line.find("\"" + name);
            if (at != std::string::npos) line.replace(at + 1, line.find('"', at + 1) - at - 1, change);
        }
        ASSERT_NE(changed.lines, original_.lines) << change;
        const Finished finished =
            replay(workshop_, {workshop_.write("other.txt", text_of(changed.lines)).string()});
        EXPECT_EQ(finished.exit_code, 2) << change;
        EXPECT_TRUE(contains(finished.err, "expected in cycle")) << finished.err.substr(0, 500);
    }
}

TEST_F(AlteredVectors, ARecordThatWasCutOffIsRefused) {
    Vectors half = original_;
    half.lines.resize(half.lines.size() / 2);
    const Finished finished = replay(workshop_, {workshop_.write("half.txt", text_of(half.lines)).string()});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err, "half.txt:" + std::to_string(half.lines.size()))) << finished.err;
}

TEST(GoldenOption, RefusesWhatItCantRecord) {
    const Workshop workshop;
    const fs::path scene = own_scene("cornell.nff");
    EXPECT_EQ(workshop.render(scene, {"--cells", "9x9", "--golden", "9,0"}).exit_code, 1);
    EXPECT_EQ(workshop.render(scene, {"--cells", "9x9", "--golden", "0,0", "--engine", "untimed"}).exit_code,
              1);
    EXPECT_EQ(workshop.render(scene, {"--cells", "20x20", "--golden", "0..19,0..19"}).exit_code, 1);
    EXPECT_TRUE(workshop.results().empty());
}

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

TEST(CellTb, WritesScenariosThatReplayAndFailsWhereACycleIsAnother) {
    const Workshop workshop;
    const std::string file = workshop.result("hit.txt").string();
    ASSERT_EQ(workshop.run_program(RAYCELL_CELL_TB, {"hit_returns", "--write", file}).exit_code, 0);
    EXPECT_EQ(replay(workshop, {file}).exit_code, 0);
    std::string text = read_text(file);
    const auto at = text.find("\n131 take west 0");
    ASSERT_NE(at, std::string::npos) << text;
    text.replace(at, 4, "\n130");
    const Finished finished = replay(workshop, {workshop.write("early.txt", text).string()});
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_TRUE(contains(finished.err, "expected in cycle 130")) << finished.err;
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
    EXPECT_EQ(exit_code({"--replay", "a", "--list"}), 1);
    EXPECT_EQ(exit_code({"--list"}), 0);
    EXPECT_TRUE(workshop.results().empty());
}

}  // namespace
}  // namespace raycell::system_test
