// A deadlock as the program reports it: a search independent of the model checks what it wrote.
#include "../cells/knot_check.hpp"
#include "program.hpp"

namespace raycell::system_test {
namespace {

std::vector<knot_check::Node> nodes_of(const Json& waits) {
    std::vector<knot_check::Node> nodes;
    for (const Json& node : waits.at("nodes")) {
        nodes.push_back({node.at("moves"), node.at("all"), node.at("waits_for")});
    }
    return nodes;
}

struct Locked {
    const char* name;
    const char* scene;
    Words words;
};
void PrintTo(const Locked& each, std::ostream* out) { *out << each.name; }

class Deadlock : public ::testing::TestWithParam<Locked> {};

TEST_P(Deadlock, IsReportedWithAKnotThatASearchOverTheDumpedGraphAccepts) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene(std::string(GetParam().scene) + ".nff"),
                                        joined({"--cells", "24x24"}, GetParam().words), 3);
    ASSERT_FALSE(report.is_null());
    EXPECT_EQ(report.at("verdict"), "deadlock");
    const Json& knot = report.at("deadlock").at("knot");
    const Json waits = Json::parse(read_text(workshop.result("a.waits.json")));
    const std::vector<knot_check::Node> nodes = nodes_of(waits);
    EXPECT_EQ(waits.at("knots").size(), knot.at("knots").get<std::size_t>());
    std::size_t in_knots = 0;
    for (const Json& one : waits.at("knots")) {
        const std::vector<std::size_t> members = one;
        EXPECT_EQ(knot_check::objection(nodes, {members.begin(), members.end()}), "");
        in_knots += members.size();
    }
    EXPECT_EQ(knot.at("nodes").size(), in_knots);
    EXPECT_EQ(report.at("deadlock").at("report").size(), in_knots) << "every node is named";
    EXPECT_EQ(knot_check::dead_nodes(nodes).size(), in_knots + knot.at("tails").get<std::size_t>());
    for (const Json& node : knot.at("nodes")) {
        const Json place = {node.at("x"), node.at("y")};
        const Json& cells = knot.at("cells");
        EXPECT_NE(std::find(cells.begin(), cells.end(), place), cells.end());
        EXPECT_LE(node.at("since").get<std::uint64_t>(), waits.at("cycle").get<std::uint64_t>());
        EXPECT_EQ(node.at("age").get<std::uint64_t>() + node.at("since").get<std::uint64_t>(),
                  waits.at("cycle").get<std::uint64_t>());
    }
    for (const Json& edge : knot.at("edges")) {
        EXPECT_EQ(knot.at("nodes")[edge[0].get<std::size_t>()].at("knot"),
                  knot.at("nodes")[edge[1].get<std::size_t>()].at("knot"));
    }
    const std::string svg = read_text(workshop.result("a.knot.svg"));
    EXPECT_TRUE(contains(svg, "class='knot'"));
    EXPECT_TRUE(contains(svg, "marker-end"));
    EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

INSTANTIATE_TEST_SUITE_P(
    Kind, Deadlock,
    ::testing::Values(Locked{"shared_buffers", "facing_mirrors", {"--buffer", "1", "--networks", "shared"}},
                      Locked{"split_buffers", "still_life", {"--buffer", "1", "--networks", "split"}},
                      Locked{"one_slot", "facing_mirrors", {"--ray-store", "1", "--recovery", "none"}},
                      Locked{"both",
                             "still_life",
                             {"--buffer", "1", "--networks", "split", "--ray-store", "1", "--recovery",
                              "none", "--slots", "free"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Livelock, HasAWaitForGraphWithoutAKnotAndNoPictureOfOne) {
    const Workshop workshop;
    const Json report =
        workshop.report(own_scene("facing_mirrors.nff"), {"--cells", "24x24", "--ray-store", "1"}, 3);
    EXPECT_EQ(report.at("verdict"), "livelock");
    EXPECT_FALSE(report.at("deadlock").contains("knot"));
    EXPECT_FALSE(std::filesystem::exists(workshop.result("a.knot.svg")));
    const std::vector<knot_check::Node> nodes =
        nodes_of(Json::parse(read_text(workshop.result("a.waits.json"))));
    EXPECT_TRUE(knot_check::dead_nodes(nodes).empty());
    const std::string ledger = read_text(workshop.result("a.ledger.csv"));
    EXPECT_EQ(std::count(ledger.begin(), ledger.end(), '\n'),
              report.at("deadlock").at("ledger").at("destroyed").get<int>() + 1);
}

TEST(Completed, LeavesNoTraceInARunThatCompletes) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("cornell.nff"), {"--cells", "16x16"});
    EXPECT_FALSE(report.at("deadlock").contains("knot"));
    for (const std::string& name : workshop.results()) {
        EXPECT_FALSE(contains(name, "waits") || contains(name, "knot")) << name;
    }
}

}  // namespace
}  // namespace raycell::system_test
