// Golden vectors of the traversal unit as text: voxels come back word for word, and the replay names what is
// wrong.
#include "testbench/golden/traversal.hpp"

#include <sstream>

#include "../equal_voxels.hpp"
#include "../property.hpp"

namespace raycell {
namespace {

dvec3 drawn_vector(const Arithmetic& arithmetic, const Format& format, property::Random& random) {
    const auto drawn = [&] { return arithmetic.hold(format, random.uniform(format.least(), format.most())); };
    const double x = drawn(), y = drawn();
    return {x, y, drawn()};
}

Voxel drawn_voxel(const Arithmetic& arithmetic, property::Random& random, CellStore& store) {
    const Formats& f = arithmetic.formats();
    Voxel voxel;
    voxel.polygon = std::uint32_t(random.whole(0, 1 << 20));
    voxel.object = std::uint32_t(random.whole(0, 100));
    voxel.near_level = random.whole(0, 1023);
    voxel.far_level = voxel.near_level + 1;
    voxel.near = arithmetic.hold(f.depth, random.uniform(0, 100));
    voxel.far = arithmetic.hold(f.depth, voxel.near + random.uniform(0, 1));
    voxel.drop = std::uint8_t(random.whole(0, 2));
    voxel.plane.n = drawn_vector(arithmetic, f.unit, random);
    voxel.plane.c = drawn_vector(arithmetic, f.offset, random).x;
    voxel.normal.base = drawn_vector(arithmetic, f.normal, random);
    voxel.normal.du = drawn_vector(arithmetic, f.normal, random);
    voxel.normal.dv = drawn_vector(arithmetic, f.normal, random);
    voxel.point = drawn_vector(arithmetic, f.unit, random);
    voxel.point.z = arithmetic.hold(f.depth, random.uniform(0, 100));
    voxel.mask = random.engine()();
    voxel.window[2] = std::uint8_t(random.whole(0, 32));
    voxel.first_edge = std::uint32_t(store.edges.size());
    voxel.edge_count = std::uint32_t(random.whole(0, 5));
    voxel.pieces = voxel.edge_count > 0;
    for (std::uint32_t i = 0; i < voxel.edge_count; ++i) {
        EdgeFunction edge;
        edge.a = drawn_vector(arithmetic, f.unit, random).x;
        edge.c = drawn_vector(arithmetic, f.edge_offset, random).x;
        edge.piece = std::uint32_t(random.whole(0, 3));
        store.edges.push_back(edge);
    }
    return voxel;
}

TEST(TraversalText, VoxelsComeBackWordForWord) {
    for (const std::uint64_t seed : property::seeds(1, 200)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        NumberSettings numbers;
        numbers.word_bits = random.whole(8, 32);
        if (random.chance(0.25)) numbers.arithmetic = Numbers::exact;
        const Arithmetic arithmetic(numbers, {64, 64, 150, 1});
        const Words words(arithmetic);
        CellStore store;
        for (int i = random.whole(1, 5); i > 0; --i)
            store.voxels.push_back(drawn_voxel(arithmetic, random, store));
        const std::string text = voxel_lines(words, store);
        if (!arithmetic.exact()) {
            // A voxel's mask has hexadecimal digits, but no x.
            EXPECT_EQ(text.find("0x"), std::string::npos) << "a word is an integer: " << text;
        }
        CellStore again;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) read_voxel(words, tokens_of(line), again);
        EXPECT_EQ(voxel_lines(words, again), text);
        for (std::size_t i = 0; i < store.voxels.size(); ++i) {
            expect_equal_voxels(again.voxels[i], store.voxels[i]);
            EXPECT_EQ(again.voxels[i].object, store.voxels[i].object);
            EXPECT_EQ(again.voxels[i].plane.c, store.voxels[i].plane.c);
        }
        EXPECT_EQ(again.edges.size(), store.edges.size());
    }
}

/// A record of cell (1, 1) of 3x3, empty, with one ray that goes east. Its words are those of the format
/// unit, Q2.18.
const char* const one_test =
    "raycell-golden 2\n"
    "part traversal\n"
    "cell 1 1\n"
    "links east south west north\n"
    "frame 0x1.4p+3 1 0x0p+0 0x0p+0 -0x1p+0\n"
    "begin\n"
    "100 test 0 0 - ray 0 131072 1310720 262144 0 0 262144:1 0:0 262144 -1 1 0 0 1 2 0 ; pixel 3 branch 7\n"
    "104 found 4 0 0 0 side east 262144 0 131072 1310720 inf\n"
    "200 end\n";

TraversalReplay replayed(const std::string& text) {
    std::istringstream in(text);
    const GoldenFile file = read_golden(in, "vectors");
    EXPECT_TRUE(file.traversal);
    CellSetup setup;
    setup.picture.width = setup.picture.height = 3;
    setup.machine.costs.walk_step = 4;
    read_setup(file, setup);
    return replay_traversal(file, setup);
}

std::string with(const std::string& old, const std::string& changed) {
    std::string text = one_test;
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), changed);
}

TEST(TraversalReplays, ADecisionThatIsRightPassesAndAnotherIsNamedByItsField) {
    const TraversalReplay good = replayed(one_test);
    EXPECT_EQ(good.tests, 1u);
    EXPECT_EQ(good.failures, std::vector<std::string>());
    const std::vector<std::pair<std::string, std::string>> changes = {
        {"104 found 4", "105 found 4"},
        {"found 4 0 0 0 side", "found 5 0 0 0 side"},
        {"side east 262144 0", "side west 262144 0"},
        {"side east 262144 0", "side east 262143 0"},
        {"side east 262144 0 131072", "side east 262144 0 131073"},
        {"side east 262144 0 131072 1310720 inf", "border east"},
        {"side east 262144 0 131072 1310720 inf", "hit 0 1 5"}};
    const std::vector<std::string> said = {"cycle 104, expected 105",
                                           "field 'cycles' is 4, expected 5",
                                           "field 'side' is east, expected west",
                                           "field 't' is 262144, expected 262143",
                                           "field 'y' is 131072, expected 131073",
                                           "expected another decision",
                                           "expected another decision"};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        SCOPED_TRACE(changes[i].second);
        const TraversalReplay replay = replayed(with(changes[i].first, changes[i].second));
        ASSERT_EQ(replay.failures.size(), 1u);
        EXPECT_EQ(replay.failures[0].rfind("line 8: " + said[i], 0), 0u) << replay.failures[0];
    }
}

TEST(TraversalReplays, AVoxelThatNoCellCanHoldIsRefused) {
    const auto voxel = [](const std::string& object, const std::string& far) {
        return "begin\nvoxel 0 5 " + object + " 0 1 262144 " + far +
               " 2 0 0 262144 0 0 0 65536 0 0 0 0 0 0 0 0 262144 0 0 0 0 0 0 0\n";
    };
    const auto said = [&](const std::string& object, const std::string& far) {
        try {
            replayed(with("begin\n", voxel(object, far)));
        } catch (const GoldenError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_NE(said("4000000000", "524288").find("field 'object': expected one of the head's 0"),
              std::string::npos)
        << said("4000000000", "524288");
}

TEST(TraversalReplays, LinesThatMakeNoSenseAreRefused) {
    const std::vector<std::pair<std::string, std::string>> changes = {
        {"100 test", "x test"},
        {"test 0 0", "test 2 0"},
        {"test 0 0 -", "test 0 0 00"},
        {"- ray", "- lit"},
        {"- ray 0", "- ray"},
        {"100 test", "100 rest"},
        {"104 found", "104 test"},
        {"begin\n", "begin\nvoxel 0\n"},
        {"begin\n", "begin\nvoxel 1 1\n"},
        {"begin\n", "begin\n1 found 4 0 0 0 source\n"},
        {"part traversal", "part shading"}};
    for (const auto& [old, changed] : changes) {
        SCOPED_TRACE(changed);
        EXPECT_THROW(
            {
                std::istringstream in(with(old, changed));
                const GoldenFile file = read_golden(in, "vectors");
                CellSetup setup;
                setup.picture.width = setup.picture.height = 3;
                read_setup(file, setup);
                replay_traversal(file, setup);
            },
            GoldenError);
    }
}

}  // namespace
}  // namespace raycell
