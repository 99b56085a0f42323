// Golden vectors, end to end: raycell records the inputs and outputs of cells in a run, and cell_tb replays
// them with a cell alone.
#include <cstdio>

#include "golden_files.hpp"

namespace raycell::system_test {
namespace {

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
        Recorded{"loaded", "cornell", {"--stage", "load"}, 0},
        Recorded{"plane", "still_life", {"--hit", "plane", "--rounding", "truncate"}, 0},
        Recorded{"interval", "cornell", {"--hit", "interval", "--normals", "voxel"}, 0},
        Recorded{"depth", "still_life", {"--hit", "depth", "--networks", "split"}, 0},
        Recorded{"truncated", "facing_mirrors", {"--rounding", "truncate", "--word-bits", "16"}, 0},
        Recorded{
            "shared", "facing_mirrors", {"--networks", "shared", "--ray-store", "40", "--buffer", "40"}, 0}),
    [](const auto& c) { return std::string(c.param.name); });

/// Changes one word of a record and replays the record.
class AlteredVectors : public ::testing::Test {
  protected:
    AlteredVectors() {
        workshop_.render(own_scene("still_life.nff"), {"--cells", "12x9", "--golden", "6,6"});
        original_ = read_vectors(workshop_.result("a.golden_6_6.txt").string());
    }
    Finished replay_words(std::size_t line, const Words& words) {
        Vectors changed = original_;
        std::string text;
        for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
        changed.lines[line] = text;
        return replay(workshop_, {workshop_.write("altered.txt", text_of(changed.lines)).string()});
    }
    Finished replay_with(std::size_t line, std::size_t at, property::Random& random) {
        Words words = split(original_.lines[line]);
        words[at] = at == bits_at && has_bits(words) ? other_bits(words[at], random) : other(words[at]);
        return replay_words(line, words);
    }
    /// The first line with this text, and its words.
    std::pair<std::size_t, Words> line_with(const std::string& a, const std::string& b) const {
        std::size_t line = original_.first;
        while (!contains(original_.lines[line], a) || !contains(original_.lines[line], b)) ++line;
        return {line, split(original_.lines[line])};
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
        const Words words = counted(original_.lines[line]);
        const auto at = std::size_t(random.whole(0, int(words.size()) - 1));
        if (at == 1) continue;  // what happens: another word may be as good, as for an own event
        const Finished finished = replay_with(line, at, random);
        EXPECT_NE(finished.exit_code, 0) << words[at] << " in " << original_.lines[line];
        EXPECT_EQ(finished.signal, 0);
        EXPECT_NE(finished.err, "");
    }
}

TEST_F(AlteredVectors, ADifferenceIsNamedByCycleLineAndField) {
    auto [line, words] = line_with(" out ", " ray ");
    const std::string dx = words[10];
    words[10] = other(dx);
    const Finished unlike = replay_words(line, words);
    EXPECT_EQ(unlike.exit_code, 1);
    EXPECT_TRUE(contains(unlike.err, "(line " + std::to_string(line + 1) +
                                         "): bits and words differ: field 'dx' is " + dx + ", expected " +
                                         words[10]))
        << unlike.err;
    words[bits_at] = "-";
    const Finished finished = replay_words(line, words);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_TRUE(contains(finished.err, "cycle " + words[0] + " (line " + std::to_string(line + 1) +
                                           "): out " + words[2] + " " + words[3] + ": field 'dx' is " + dx +
                                           ", expected " + words[10]))
        << finished.err;
}

TEST_F(AlteredVectors, WhatTheWiresDoNotCarryIsNotCompared) {
    for (const char* type : {" ray ", " shadow_ray ", " intensity ", " lit "}) {
        const std::size_t line = line_with(" out ", type).first;
        const Finished without = replay_words(line, counted(original_.lines[line]));
        EXPECT_EQ(without.exit_code, 0) << without.err;
        Words other_tree = counted(original_.lines[line]);
        other_tree.insert(other_tree.end(), {";", "pixel", "1", "branch", "2", "and", "more"});
        EXPECT_EQ(replay_words(line, other_tree).exit_code, 0) << type;
    }
}

TEST_F(AlteredVectors, AnotherVersionIsRefusedWithWhatToDo) {
    Vectors old = original_;
    old.lines[0] = "raycell-golden 1";
    const Finished finished = replay(workshop_, {workshop_.write("old.txt", text_of(old.lines)).string()});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_TRUE(contains(finished.err,
                         "old.txt:1: golden vectors of version '1': expected 'raycell-golden 2'; "
                         "record them anew"))
        << finished.err;
}

/// One line of a file for $readmemh.
struct MemoryLine {
    unsigned long long cycle = 0;
    unsigned what = 0, side = 0, index = 0, link = 0, bits = 0;
    std::string message;
};

MemoryLine memory_line(const std::string& text) {
    MemoryLine line;
    char message[200] = "";
    EXPECT_EQ(std::sscanf(text.c_str(), "%12llx_%1x_%1x_%1x_%8x_%4x_%199[0-9a-f]", &line.cycle, &line.what,
                          &line.side, &line.index, &line.link, &line.bits, message),
              7)
        << text;
    line.message = message;
    return line;
}

TEST_F(AlteredVectors, TheFilesForReadmemhSayTheSame) {
    const Words whats = {"in", "free", "phase", "drain", "out", "take", "pixel"};
    const Words sides = {"east", "south", "west", "north", "load"};
    std::vector<std::string> memory[2];
    std::size_t at[2] = {1, 1};
    for (const int out : {0, 1}) {
        memory[out] =
            lines_of(workshop_.result(out ? "a.golden_6_6.out.hex" : "a.golden_6_6.in.hex").string());
        ASSERT_GT(memory[out].size(), 2u);
        EXPECT_EQ(memory[out][0].rfind("// raycell-golden 2: ", 0), 0u);
        for (const std::string& line : memory[out]) {
            if (&line != &memory[out][0]) {
                EXPECT_EQ(line.size(), memory[out][1].size()) << "of one width";
            }
        }
    }
    for (std::size_t i = original_.first; i + 1 < original_.lines.size(); ++i) {
        SCOPED_TRACE(original_.lines[i]);
        const Words words = counted(original_.lines[i]);
        const auto what = std::size_t(std::find(whats.begin(), whats.end(), words[1]) - whats.begin());
        const int out = what >= 4;
        ASSERT_LT(at[out], memory[out].size());
        const MemoryLine line = memory_line(memory[out][at[out]++]);
        EXPECT_EQ(std::to_string(line.cycle), words[0]);
        EXPECT_EQ(line.what, what);
        std::string message;
        if (words[1] == "phase") {
            EXPECT_EQ(line.index, words[2] == "precast" ? 1u : 2u);
        } else if (words[1] == "pixel") {
            EXPECT_EQ(line.bits, 60u);
            for (std::size_t channel = 2; channel < 5; ++channel) {
                char digits[8];
                std::snprintf(digits, sizeof digits, "%05x", unsigned(std::stoi(words[channel])) & 0xfffffU);
                message += digits;
            }
        } else {
            EXPECT_EQ(sides.at(line.side), words[2]);
            EXPECT_EQ(std::to_string(line.index), words[3]);
            if (words.size() > 4) {
                EXPECT_EQ(std::to_string(line.link), words[4]);
            }
            if (has_bits(words)) {
                message = words[bits_at];
                EXPECT_EQ((line.bits + 3) / 4, message.size());
            }
        }
        message.resize(line.message.size(), '0');
        EXPECT_EQ(line.message, message);
    }
    for (const int out : {0, 1}) {
        ASSERT_EQ(at[out] + 1, memory[out].size());
        const MemoryLine last = memory_line(memory[out].back());
        EXPECT_EQ(last.what, 15u);
        EXPECT_EQ(std::to_string(last.cycle), split(original_.lines.back())[0]);
    }
}

TEST_F(AlteredVectors, WhateverACellIsToldItIsCheckedAndNothingBreaks) {
    for (const std::uint64_t seed : property::seeds(1, 60)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const std::size_t line = drawn_line(random, false);
        const Words words = split(original_.lines[line]);
        const Finished finished =
            replay_with(line, std::size_t(random.whole(0, int(words.size()) - 1)), random);
        EXPECT_EQ(finished.signal, 0) << original_.lines[line];
        EXPECT_GE(finished.exit_code, 0);
        EXPECT_LE(finished.exit_code, 2);
        EXPECT_EQ(finished.exit_code == 0, finished.err.empty());
    }
}

/// The record is unchanged, but the cell has other costs.
TEST_F(AlteredVectors, ACellThatTakesAnotherTimeFails) {
    for (const std::string change : {"walk_step=5", "route_return=2", "shade_setup=21", "load_advance=2"}) {
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

/// A run with options drawn from all that cells differ in.
Words drawn_options(property::Random& random) {
    const auto one_of = [&](const Words& all) {
        return all[std::size_t(random.whole(0, int(all.size()) - 1))];
    };
    return {"--cells",     one_of({"9x12", "12x9", "10x10"}),
            "--hit",       one_of({"depth", "interval", "plane", "mask", "edge"}),
            "--shadows",   one_of({"per-hit", "memo", "precast"}),
            "--networks",  one_of({"split", "half", "quadrant"}),
            "--normals",   one_of({"voxel", "linear"}),
            "--rounding",  one_of({"nearest", "truncate"}),
            "--word-bits", one_of({"12", "16", "20", "27"}),
            "--link-bits", one_of({"8", "20", "64"}),
            "--ray-store", one_of({"5", "8"}),
            "--buffer",    one_of({"1", "2"}),
            "--stall",     one_of({"0", "0.2"})};
}

TEST(GoldenRuns, OfDrawnMachinesReplayAndAnyAlteredWordIsFound) {
    for (const std::uint64_t seed : property::seeds(1, 8)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Workshop workshop;
        const Words options = drawn_options(random);
        const Finished run = workshop.render(own_scene(random.chance(0.5) ? "still_life.nff" : "cornell.nff"),
                                             joined(options, {"--golden", "4..6,5"}));
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const Words files = records(workshop);
        ASSERT_EQ(files.size(), 3u);
        const Finished again = replay(workshop, files);
        EXPECT_EQ(again.exit_code, 0) << again.err.substr(0, 2000);
        for (int i = 0; i < 4; ++i) {
            const Vectors original = read_vectors(files[std::size_t(random.whole(0, 2))]);
            Vectors altered = original;
            std::size_t line = 0;
            do {
                line = std::size_t(random.whole(int(original.first), int(original.lines.size()) - 2));
            } while (!contains(original.lines[line], " out "));
            Words words = counted(original.lines[line]);
            std::string& word = words[std::size_t(random.whole(4, int(words.size()) - 1))];
            word = &word == &words[bits_at] && has_bits(words) ? other_bits(word, random) : other(word);
            altered.lines[line].clear();
            for (const std::string& w : words) altered.lines[line] += w + " ";
            const Finished found =
                replay(workshop, {workshop.write("altered.txt", text_of(altered.lines)).string()});
            EXPECT_GT(found.exit_code, 0) << altered.lines[line] << "\nwas " << original.lines[line];
        }
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

}  // namespace
}  // namespace raycell::system_test
