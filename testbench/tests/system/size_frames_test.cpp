// raycell size --frame-cycles: what it finds is accurate enough and in time when it is run.
#include <map>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

Finished size(const Workshop& workshop, const Words& words) {
    return workshop.run(
        joined({"size", own_scene("still_life.nff").string(), "--cells", "16x16", "-o", "results/s"}, words));
}

/// The lines of a CSV by the names of its first.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
    std::vector<std::map<std::string, std::string>> rows;
    std::istringstream lines(csv);
    std::string line;
    Words names;
    while (std::getline(lines, line)) {
        Words values;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');) values.push_back(field);
        if (names.empty()) {
            names = values;
            continue;
        }
        values.resize(names.size());
        rows.emplace_back();
        for (std::size_t i = 0; i < names.size(); ++i) rows.back()[names[i]] = values[i];
    }
    return rows;
}

TEST(SizeOfFrames, FindsAMachineWhoseFileReachesBothGoalsInATimedRun) {
    const Workshop workshop;
    const Finished sized = size(workshop, {"--psnr", "30", "--frame-cycles", "150000"});
    ASSERT_EQ(sized.exit_code, 0) << sized.err;
    EXPECT_NE(sized.out.find("smallest machine: "), std::string::npos);
    const Json report = Json::parse(read_text(workshop.result("s.json")));
    const Json& found = report.at("found");
    const Finished rendered =
        workshop.run({"render", "--config", "results/s.toml", "--truth", "--quiet", "-o", "results/a"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    const Json run = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_GE(run.at("accuracy").at("scene").at("psnr_db").get<double>(), 30);
    EXPECT_LE(run.at("cycles").at("total").get<std::uint64_t>(), 150000u);
    EXPECT_EQ(run.at("cycles").at("total"), found.at("frame_cycles"));
    EXPECT_EQ(run.at("accuracy").at("scene").at("psnr_db"), found.at("psnr_db"));
    EXPECT_EQ(run.at("load_queue").at("max_bits_per_cell"), found.at("voxel_bits"));
    const auto number = [](const Json& json) { return json.get<std::uint64_t>(); };
    const std::uint64_t feed = (number(run.at("feed_bits").at("total")) + 255) / 256;  // a cell's share
    EXPECT_EQ(number(found.at("bits_per_cell")),
              number(run.at("storage_bits").at("total")) + number(found.at("voxel_bits")) + feed);

    const auto rows = rows_of(read_text(workshop.result("s.csv")));
    ASSERT_EQ(rows.size(), report.at("tried").size());
    std::size_t front = 0;
    for (const auto& row : rows) {
        front += row.at("front") == "true";
        if (row.at("meets") == "true")
            EXPECT_GE(std::stoull(row.at("bits_per_cell")), found.at("bits_per_cell").get<std::uint64_t>());
    }
    EXPECT_GE(front, 1u);
    const std::string chart = read_text(workshop.result("s.svg"));
    EXPECT_NE(chart.find("</svg>"), std::string::npos);
}

TEST(SizeOfFrames, DoesNotRepeatRunsAndGivesTheSameFiles) {
    const Workshop workshop;
    const Words goals = {"--frame-cycles", "150000", "--quiet"};
    ASSERT_EQ(size(workshop, goals).exit_code, 0);
    const std::string csv = read_text(workshop.result("s.csv"));
    const auto folder = workshop.result("s.runs");
    std::map<fs::path, fs::file_time_type> made;
    for (const auto& file : fs::directory_iterator(folder)) {
        if (file.path().extension() == ".json") made[file.path()] = file.last_write_time();
    }
    ASSERT_FALSE(made.empty());
    ASSERT_EQ(size(workshop, goals).exit_code, 0);
    EXPECT_EQ(read_text(workshop.result("s.csv")), csv);
    std::size_t runs = 0;
    for (const auto& file : fs::directory_iterator(folder)) {
        if (file.path().extension() != ".json") continue;
        ++runs;
        EXPECT_TRUE(made.count(file.path()) && made[file.path()] == file.last_write_time());
    }
    EXPECT_EQ(runs, made.size());
}

TEST(SizeOfFrames, SaysWhichMachineComesNearestWhereNoneReachesTheGoals) {
    const Workshop workshop;
    const Finished sized = size(workshop, {"--frame-cycles", "1000"});
    EXPECT_EQ(sized.exit_code, 2);
    EXPECT_NE(sized.err.find("no machine tried reaches the goal; nearest: "), std::string::npos) << sized.err;
    EXPECT_NE(sized.err.find(" cycles"), std::string::npos);
    EXPECT_FALSE(fs::exists(workshop.result("s.toml")));
    const Json report = Json::parse(read_text(workshop.result("s.json")));
    EXPECT_EQ(report.at("reached"), false);
    EXPECT_GT(report.at("nearest").at("frame_cycles").get<std::uint64_t>(), 1000u);
}

}  // namespace
}  // namespace raycell::system_test
