// Golden vectors of the traversal unit, end to end.
#include <map>

#include "golden_files.hpp"

namespace raycell::system_test {
namespace {

Words files_with(const Workshop& workshop, const std::string& part) {
    Words files;
    for (const std::string& name : workshop.results()) {
        if (contains(name, part) && contains(name, ".txt")) files.push_back(workshop.result(name).string());
    }
    return files;
}

struct Recorded {
    const char* name;
    const char* scene;
    Words options;
};

void PrintTo(const Recorded& r, std::ostream* out) { *out << r.name; }

class TraversalVectors : public ::testing::TestWithParam<Recorded> {};

TEST_P(TraversalVectors, OfARunReplayAndRecordingChangesNothing) {
    const Workshop workshop;
    const fs::path scene = own_scene(std::string(GetParam().scene) + ".nff");
    const Words options = joined({"--cells", "12x9"}, GetParam().options);
    const Finished plain = workshop.render(scene, options, "plain");
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
    const Finished run =
        workshop.render(scene, joined(options, {"--golden", "0..11,4", "--golden-part", "traversal"}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(schedule(Json::parse(read_text(workshop.result("a.json")))),
              schedule(Json::parse(read_text(workshop.result("plain.json")))));
    const Words files = files_with(workshop, ".traversal_");
    ASSERT_EQ(files.size(), 12u);
    const Finished again = replay(workshop, files);
    EXPECT_EQ(again.exit_code, 0) << again.err.substr(0, 3000);
    EXPECT_TRUE(contains(again.out, "12 of 12 passed")) << again.out;
    std::map<std::string, int> decisions;
    const bool exact = contains(GetParam().name, "exact");
    for (const std::string& file : files) {
        const Vectors vectors = read_vectors(file);
        for (std::size_t line = vectors.first; line < vectors.lines.size(); ++line) {
            const Words words = counted(vectors.lines[line]);
            if (words[1] == "found") ++decisions[words[6]];
            if (!exact) {
                EXPECT_FALSE(contains(vectors.lines[line], "0x")) << vectors.lines[line];
            }
            if (words[1] == "test") {
                EXPECT_EQ(words[4] == "-", exact) << vectors.lines[line];
            }
        }
    }
    EXPECT_GT(decisions["hit"], 0);
    EXPECT_GT(decisions["side"], 0);
    EXPECT_GT(decisions["source"] + decisions["lost"] + decisions["border"] + decisions["outside"], 0);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, TraversalVectors,
    ::testing::Values(Recorded{"edge", "still_life", {}},
                      Recorded{"mask", "still_life", {"--hit", "mask", "--rounding", "truncate"}},
                      Recorded{"plane", "cornell", {"--hit", "plane", "--normals", "voxel"}},
                      Recorded{"interval", "still_life", {"--hit", "interval", "--word-bits", "16"}},
                      Recorded{"depth", "cornell", {"--hit", "depth", "--exterior", "none"}},
                      Recorded{"precast", "still_life", {"--shadows", "precast", "--networks", "quadrant"}},
                      Recorded{"memo", "cornell", {"--shadows", "memo", "--stall", "0.3"}},
                      Recorded{"postponed", "facing_mirrors", {"--ray-store", "5"}},
                      Recorded{"exact", "still_life", {"--arithmetic", "exact"}}),
    [](const auto& c) { return std::string(c.param.name); });

/// "pixel P branch B" of a line's remarks.
std::string ray_of(const std::string& line) {
    const Words words = split(line.substr(line.find(';') + 1));
    return words.at(1) + "/" + words.at(3);
}

TEST(TraversalVectorsOfACell, TellWhereItsRaysGo) {
    const Workshop workshop;
    const Words options = {"--cells", "12x9", "--golden", "6,6"};
    workshop.render(own_scene("still_life.nff"), options);
    workshop.render(own_scene("still_life.nff"), joined(options, {"--golden-part", "traversal"}), "b");
    const Vectors cell = read_vectors(workshop.result("a.golden_6_6.txt").string());
    const Vectors unit = read_vectors(workshop.result("b.traversal_6_6.txt").string());
    // Where each ray goes by the unit's decisions, a place for each of its tests.
    std::map<std::string, std::vector<Words>> places;
    for (std::size_t line = unit.first; line < unit.lines.size(); ++line) {
        const Words words = counted(unit.lines[line]);
        if (words[1] != "found" || words[6] != "side") continue;
        places[ray_of(unit.lines[line - 1])].push_back({words[7], words[9], words[10], words[11]});
    }
    int rays = 0;
    for (std::size_t line = cell.first; line < cell.lines.size(); ++line) {
        const Words words = counted(cell.lines[line]);
        if (words[1] != "out" || !contains(words.at(6), "ray")) continue;
        const std::vector<Words>& all = places[ray_of(cell.lines[line])];
        const Words place = {words[2], words[7], words[8], words[9]};
        EXPECT_NE(std::find(all.begin(), all.end(), place), all.end()) << cell.lines[line];
        ++rays;
    }
    EXPECT_GT(rays, 10);
}

TEST(TraversalVectorsOfACell, AnyAlteredWordOfADecisionIsFound) {
    const Workshop workshop;
    workshop.render(own_scene("still_life.nff"),
                    {"--cells", "12x9", "--golden", "6,6", "--golden-part", "traversal"});
    const Vectors original = read_vectors(workshop.result("a.traversal_6_6.txt").string());
    for (const std::uint64_t seed : property::seeds(1, 40)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        std::size_t line = 0;
        do {
            line = std::size_t(random.whole(int(original.first), int(original.lines.size()) - 2));
        } while (!contains(original.lines[line], " found ") && !contains(original.lines[line], " test "));
        Words words = counted(original.lines[line]);
        const bool test = words[1] == "test";
        // Of a ray anything may be changed in words: its bits tell; the two bits before them need not matter.
        const auto at = std::size_t(random.whole(test ? 4 : 0, int(words.size()) - 1));
        words[at] = test && at == 4 ? other_bits(words[at], random) : other(words[at]);
        Vectors altered = original;
        altered.lines[line].clear();
        for (const std::string& word : words) altered.lines[line] += word + " ";
        const Finished found =
            replay(workshop, {workshop.write("altered.txt", text_of(altered.lines)).string()});
        EXPECT_GT(found.exit_code, 0) << altered.lines[line] << "\nwas " << original.lines[line];
        EXPECT_EQ(found.signal, 0);
    }
}

TEST(TraversalVectorsOfACell, HaveNoWaveforms) {
    const Workshop workshop;
    workshop.render(own_scene("still_life.nff"),
                    {"--cells", "12x9", "--golden", "6,6", "--golden-part", "traversal"});
    const std::string file = workshop.result("a.traversal_6_6.txt").string();
    EXPECT_EQ(replay(workshop, {file}, {"--vcd", "wave.vcd"}).exit_code, 1);
    EXPECT_EQ(replay(workshop, {file}).exit_code, 0);
}

}  // namespace
}  // namespace raycell::system_test
