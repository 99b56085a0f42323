// A run stopped in any cycle reports nothing later than its end, and reports what waited for what.
#include <sstream>

#include "../property.hpp"
#include "program.hpp"

namespace raycell::system_test {
namespace {

/// The cycles after "since cycle " in a report's lines.
std::vector<std::uint64_t> times_in(const Json& lines) {
    std::vector<std::uint64_t> times;
    for (const std::string line : lines) {
        const auto at = line.find("since cycle ");
        if (at != std::string::npos) times.push_back(std::stoull(line.substr(at + 12)));
    }
    return times;
}

/// A column of a table with a header, by its name.
std::vector<std::uint64_t> column(const std::string& table, const std::string& name) {
    std::istringstream lines(table);
    std::string line;
    std::vector<std::uint64_t> values;
    std::size_t place = std::string::npos;
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        std::size_t at = 0;
        for (std::string field; std::getline(fields, field, ','); ++at) {
            if (place == std::string::npos && field == name) place = at;
            if (place == at && field != name) values.push_back(std::stoull(field));
        }
    }
    return values;
}

std::uint64_t last_time(const std::string& vcd) {
    std::istringstream lines(vcd);
    std::uint64_t last = 0;
    for (std::string line; std::getline(lines, line);)
        if (line[0] == '#') last = std::max(last, std::uint64_t(std::stoull(line.substr(1))));
    return last;
}

void expect_nothing_after_the_end(const Workshop& workshop, const Json& report, std::uint64_t limit) {
    if (!fs::exists(workshop.result("a.waits.json"))) {  // between two phases
        for (const auto& [kind, figures] : report.at("messages").items())
            EXPECT_EQ(figures.at("in_flight"), 0);
        EXPECT_LE(report.at("cycles").at("total"), limit);
        return;
    }
    const Json waits = Json::parse(read_text(workshop.result("a.waits.json")));
    const std::uint64_t ended = waits.at("cycle");
    EXPECT_LE(ended, limit);
    for (const Json& node : waits.at("nodes")) {
        EXPECT_LE(node.at("since"), ended) << node;
        EXPECT_FALSE(node.at("holds").get<std::string>().empty()) << node;
        EXPECT_FALSE(node.at("wants").get<std::string>().empty()) << node;
        EXPECT_EQ(node.at("moves").get<bool>(), node.at("waits_for").empty()) << node;
    }
    const Json& deadlock = report.at("deadlock");
    EXPECT_FALSE(deadlock.at("report").empty());
    for (const std::uint64_t time : times_in(deadlock.at("report"))) EXPECT_LE(time, ended);
    if (deadlock.contains("knot")) {
        EXPECT_LE(deadlock.at("knot").at("formed"), ended);
    }
    if (fs::exists(workshop.result("a.ledger.csv"))) {
        for (const std::uint64_t cycle : column(read_text(workshop.result("a.ledger.csv")), "cycle"))
            EXPECT_LE(cycle, ended);
    }
    const Json& cycles = report.at("cycles");
    EXPECT_LE(cycles.at("total"), ended);
    const std::uint64_t traced =
        cycles.at("precast").get<std::uint64_t>() + cycles.at("trace").get<std::uint64_t>();
    const std::string cells = read_text(workshop.result("a.cells.csv"));
    const std::uint64_t units = report.at("config").at("traversal-units");
    for (const std::uint64_t busy : column(cells, "traversal_cycles")) EXPECT_LE(busy, units * traced);
    for (const std::uint64_t busy : column(cells, "shading_cycles")) EXPECT_LE(busy, traced);
    for (const std::uint64_t busy : column(cells, "link_busy_cycles")) EXPECT_LE(busy, 4 * traced);
    for (const auto& [unit, figures] : report.at("units").items())
        EXPECT_LE(figures.at("utilisation"), 1) << unit;
    for (const auto& [name, figures] : report.at("stages").items())
        EXPECT_LE(figures.at("utilisation"), 1) << name;
    const Json& activity = report.at("activity");
    EXPECT_LE(activity.at("start_cycle").get<std::uint64_t>() + activity.at("cycles").get<std::uint64_t>(),
              ended + 1);
    EXPECT_LE(activity.at("start_cycle"), ended);
    if (!activity.at("trace_start").is_null()) {
        EXPECT_LE(activity.at("trace_start"), ended);
    }
    constexpr std::uint64_t nanoseconds = 50;  // a cycle at 20 MHz
    EXPECT_LE(last_time(read_text(workshop.result("a.vcd"))), ended * nanoseconds);
}

struct Stopped {
    const char* name;
    Words words;
};
void PrintTo(const Stopped& each, std::ostream* out) { *out << each.name; }

class StoppedRun : public ::testing::TestWithParam<Stopped> {};

TEST_P(StoppedRun, ReportsNothingLaterThanItsEndWhateverTheLimitOfCycles) {
    const Workshop workshop;
    const Words words = joined({"--cells", "7x5", "--probe", "2..4,2"}, GetParam().words);
    const Json whole = workshop.report(own_scene("still_life.nff"), words);
    const std::uint64_t total = whole.at("cycles").at("total");
    const std::uint64_t load = whole.at("cycles").at("load");
    for (const std::uint64_t seed : property::seeds(1, 1)) {
        property::Random random(seed);
        std::vector<std::uint64_t> limits = {1,        2,    3,        5,        9,        30,
                                             load - 1, load, load + 1, load + 2, total - 1};
        for (int i = 0; i < 12; ++i) limits.push_back(std::uint64_t(random.whole(1, int(load))));
        for (int i = 0; i < 12; ++i) limits.push_back(std::uint64_t(random.whole(int(load), int(total) - 1)));
        for (const std::uint64_t limit : limits) {
            SCOPED_TRACE("--max-cycles " + std::to_string(limit) + "; " + property::rerun(seed));
            const Json report = workshop.report(own_scene("still_life.nff"),
                                                joined(words, {"--max-cycles", std::to_string(limit)}), 4);
            if (!report.is_null()) expect_nothing_after_the_end(workshop, report, limit);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kind, StoppedRun,
    ::testing::Values(Stopped{"default", {}},
                      Stopped{"slow",
                              {"--link-bits", "1", "--cost", "walk_step=50", "--exterior-latency", "900"}},
                      Stopped{"precast", {"--shadows", "precast", "--buffer", "3", "--networks", "quadrant"}},
                      Stopped{"postponed", {"--ray-store", "5", "--stall", "0.2"}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace raycell::system_test
