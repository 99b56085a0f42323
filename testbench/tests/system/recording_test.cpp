// --film and --rays: what a run records for its page.
#include <algorithm>
#include <numeric>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

const std::vector<std::string> layers = {"loads", "voxels", "rays", "answers", "slots", "pixels_done"};

/// The sums of a film's layer, frame by frame.
std::vector<std::int64_t> sums_of(const Json& film, const std::string& layer) {
    std::vector<std::int64_t> map(film.at("columns").get<std::size_t>() * film.at("rows").get<std::size_t>());
    std::vector<std::int64_t> sums;
    for (const Json& changes : film.at("layers").at(layer)) {
        for (std::size_t i = 0; i < changes.size(); i += 2) map.at(changes[i]) = changes[i + 1];
        sums.push_back(std::accumulate(map.begin(), map.end(), std::int64_t(0)));
    }
    return sums;
}

Json film_of(const Workshop& workshop, const std::string& name = "a") {
    return Json::parse(read_text(workshop.result(name + ".film.json")));
}

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const Workshop& workshop, const std::string& name = "a") {
    std::istringstream lines(read_text(workshop.result(name + ".rays.csv")));
    const auto fields = [](const std::string& line) {
        std::vector<std::string> all;
        std::istringstream text(line);
        for (std::string field; std::getline(text, field, ',');) all.push_back(field);
        return all;
    };
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = fields(line);
    std::vector<Row> rows;
    while (std::getline(lines, line)) {
        const std::vector<std::string> values = fields(line);
        EXPECT_EQ(values.size(), names.size()) << line;
        Row row;
        for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values.at(i);
        rows.push_back(row);
    }
    return rows;
}

std::int64_t sum_of(const std::vector<Row>& rows, const std::string& column) {
    std::int64_t sum = 0;
    for (const Row& row : rows) sum += std::stoll(row.at(column));
    return sum;
}

TEST(Film, EndsWithEveryVoxelStoredAndEveryPixelDone) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("still_life.nff"), {"--cells", "70x40", "--film", "40"});
    const Json film = film_of(workshop);
    EXPECT_EQ(film.at("cells_per_block"), 2) << "more than 64 cells a side";
    EXPECT_EQ(film.at("columns"), 35);
    EXPECT_EQ(film.at("rows"), 20);
    const std::vector<std::int64_t> cycles = film.at("cycles");
    EXPECT_LE(cycles.size(), 40u);
    EXPECT_GE(cycles.size(), 20u);
    for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_LT(cycles[i - 1], cycles[i]);
    for (const std::string& layer : layers) EXPECT_EQ(sums_of(film, layer).size(), cycles.size()) << layer;
    EXPECT_EQ(sums_of(film, "voxels").back(), report.at("voxels").at("stored"));
    EXPECT_EQ(sums_of(film, "pixels_done").back(), 70 * 40);
    for (const std::string layer : {"loads", "rays", "answers", "slots"}) {
        const auto sums = sums_of(film, layer);
        EXPECT_EQ(sums.back(), 0) << layer << ": a completed run leaves nothing behind";
        EXPECT_GT(*std::max_element(sums.begin(), sums.end()), 0) << layer;
    }
    const std::vector<std::string> phases = film.at("phases");
    EXPECT_EQ(phases.front(), "load");
    EXPECT_EQ(phases.back(), "trace");
    const auto loading = std::count(phases.begin(), phases.end(), "load");
    EXPECT_GE(loading, 8) << "half of the frames are for loading, in equal distances";
    EXPECT_LE(loading, 20);
}

TEST(Film, VoxelsNeverGetFewer) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "24x24", "--film", "100"});
    const auto voxels = sums_of(film_of(workshop), "voxels");
    EXPECT_TRUE(std::is_sorted(voxels.begin(), voxels.end()));
}

TEST(Film, ItsLastFrameHasTheMessagesOfADeadlock) {
    const Workshop workshop;
    const Json report =
        workshop.report(own_scene("facing_mirrors.nff"),
                        {"--buffer", "1", "--networks", "shared", "--cells", "32x32", "--film", "64"}, 3);
    const Json film = film_of(workshop);
    EXPECT_EQ(sums_of(film, "answers").back(), report.at("messages").at("answers").at("in_flight"));
    // The rest is in slots, and in the exterior.
    EXPECT_LE(sums_of(film, "rays").back() + sums_of(film, "slots").back(),
              report.at("messages").at("rays").at("in_flight"));
    EXPECT_GT(sums_of(film, "rays").back(), 0);
}

TEST(Recording, ChangesNoPictureAndNoSchedule) {
    const Workshop workshop;
    const Words words = {"--cells", "24x24", "--ray-store", "5", "--shadows", "precast"};
    const Json plain = workshop.report(own_scene("facing_mirrors.nff"), words, 0, "plain");
    std::string film;
    std::string rays;
    for (const std::string hosts : {"cell", "tile"}) {
        const Json report =
            workshop.report(own_scene("facing_mirrors.nff"),
                            joined(words, {"--film", "60", "--rays", "--granularity", hosts}), 0, hosts);
        EXPECT_EQ(image(report), image(plain));
        EXPECT_EQ(schedule(report), schedule(plain));
        if (!film.empty()) EXPECT_TRUE(film == read_text(workshop.result(hosts + ".film.json")));
        if (!rays.empty()) EXPECT_TRUE(rays == read_text(workshop.result(hosts + ".rays.csv")));
        film = read_text(workshop.result(hosts + ".film.json"));
        rays = read_text(workshop.result(hosts + ".rays.csv"));
    }
}

TEST(RayTable, ItsSumsAreTheReports) {
    const std::vector<Words> variants = {
        {}, {"--ray-store", "5"}, {"--shadows", "precast"}, {"--exterior", "none"}};
    for (const Words& words : variants) {
        const Workshop workshop;
        const Json report =
            workshop.report(own_scene("facing_mirrors.nff"), joined({"--cells", "20x20", "--rays"}, words));
        const std::vector<Row> rows = rows_of(workshop);
        std::map<std::string, std::int64_t> kinds;
        std::map<std::string, std::int64_t> ends;
        for (const Row& row : rows) {
            ++kinds[row.at("kind")];
            ++ends[row.at("end")];
            EXPECT_FALSE(row.at("ended").empty()) << "every ray of a completed run is home";
            const bool first = row.at("generation") == "0" || row.at("kind") == "precast";
            EXPECT_EQ(row.at("parent").empty(), first) << row.at("ray");
        }
        for (const auto& [kind, count] : kinds) EXPECT_EQ(report.at("rays").at(kind), count) << kind;
        EXPECT_EQ(report.at("rays").at("exterior"), ends["exterior"]);
        EXPECT_EQ(ends[""], 0);
        EXPECT_EQ(sum_of(rows, "hops") + sum_of(rows, "answer_hops"),
                  report.at("hops").at("ray").get<std::int64_t>() +
                      report.at("hops").at("return").get<std::int64_t>());
        EXPECT_EQ(sum_of(rows, "postponed"), report.at("deadlock").at("postponed"));
    }
}

TEST(RayTable, TellsOfARayWhatWatchingItTells) {
    const Workshop workshop;
    const Finished finished =
        workshop.render(own_scene("facing_mirrors.nff"),
                        {"--cells", "16x16", "--rays", "--watch-pixel", "5,6", "--ray-store", "5"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    std::size_t rays = 0;
    for (const Row& row : rows_of(workshop)) {
        if (row.at("ray").rfind("101/", 0) != 0) continue;  // 6 * 16 + 5
        ++rays;
        const std::string line =
            "ray " + row.at("ray") + ": " + row.at("kind") + ", generation " + row.at("generation") +
            ", from cell (" + row.at("home_x") + ", " + row.at("home_y") + "), cycles " + row.at("launched") +
            " to " + row.at("ended") + ", " +
            std::to_string(std::stoll(row.at("ended")) - std::stoll(row.at("launched"))) + " cycles, hops " +
            row.at("hops") + " + " + row.at("answer_hops") + " of answers, waited " + row.at("waited");
        EXPECT_TRUE(contains(finished.out, line)) << line;
    }
    EXPECT_TRUE(contains(finished.out, "watched: " + std::to_string(rays) + " rays"));
    EXPECT_GT(rays, 3u);
}

TEST(RayTable, TrafficWithoutASceneHasOneToo) {
    const Workshop workshop;
    const std::string bench = (fs::path(RAYCELL_PROGRAM).parent_path() / "deadlock_tb").string();
    const Finished finished = workshop.run_program(
        bench, {"--cells", "16x16", "--film", "40", "--rays", "-o", "results/a", "--quiet"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    EXPECT_EQ(rows_of(workshop).size(), report.at("messages").at("rays").at("answered"));
    EXPECT_EQ(sums_of(film_of(workshop), "pixels_done").back(), 256);
}

TEST(Recording, TheRunRepeatedForItsWaveformsRecordsNothing) {
    const Workshop workshop;
    workshop.report(own_scene("facing_mirrors.nff"),
                    {"--buffer", "1", "--networks", "split", "--cells", "32x32", "--film", "20", "--rays",
                     "--vcd-on-deadlock"},
                    3);
    for (const std::string& name : workshop.results()) EXPECT_EQ(name.rfind("a.", 0), 0u) << name;
    EXPECT_TRUE(fs::exists(workshop.result("a.vcd")));
    EXPECT_TRUE(fs::exists(workshop.result("a.film.json")));
}

TEST(Film, OfLessThanTwoFramesForEachHalfIsRefused) {
    const Workshop workshop;
    for (const std::string frames : {"1", "3"}) {
        const Finished finished =
            workshop.render(own_scene("cornell.nff"), {"--cells", "8x8", "--film", frames});
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, "expected 0, or 4 to 2000")) << finished.err;
    }
    for (const std::size_t frames : {4, 7, 9}) {
        workshop.report(own_scene("cornell.nff"), {"--cells", "8x8", "--film", std::to_string(frames)});
        EXPECT_LE(film_of(workshop).at("cycles").size(), frames);
    }
}

TEST(Recording, WithoutTimeItIsRefused) {
    const Workshop workshop;
    for (const Words& words : std::vector<Words>{{"--film", "10"}, {"--rays"}}) {
        const Finished finished = workshop.render(own_scene("cornell.nff"),
                                                  joined({"--cells", "8x8", "--engine", "untimed"}, words));
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, words[0] + ": the untimed engine has no cycles")) << finished.err;
    }
}

}  // namespace
}  // namespace raycell::system_test
