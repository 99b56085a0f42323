// --watch-ray and --watch-pixel: the life of rays as text.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "program.hpp"
#include "testbench/common/picture_file.hpp"

namespace raycell::system_test {
namespace {

/// One line of the watch: an event.
struct Event {
    std::int64_t cycle = 0;
    int x = 0;
    int y = 0;
    std::size_t indent = 0;
    std::string ray;
    std::string what;
};

/// The events and the summaries that follow them.
struct Lives {
    std::vector<Event> events;
    std::vector<std::string> summaries;
    std::string last;  ///< "watched: ..."
};

Lives read_lives(const std::string& text) {
    Lives lives;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("ray ", 0) == 0) {
            lives.summaries.push_back(line);
        } else if (line.rfind("watched: ", 0) == 0) {
            lives.last = line;
        } else {
            Event event;
            char comma = 0;
            char open = 0;
            char close = 0;
            std::istringstream words(line);
            words >> event.cycle >> open >> event.x >> comma >> event.y >> close;
            EXPECT_TRUE(words.good() && open == '(' && comma == ',' && close == ')') << line;
            const std::size_t ray = line.find_first_not_of(' ', line.find(')') + 1);
            const std::size_t behind = line.find("  ", ray);
            event.indent = ray;
            event.ray = line.substr(ray, behind - ray);
            event.what = line.substr(behind + 2);
            lives.events.push_back(event);
        }
    }
    return lives;
}

bool starts(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

bool is_hop(const Event& event) {
    return starts(event.what, "hops ") || starts(event.what, "answer hops ") ||
           starts(event.what, "answer from the exterior hops ");
}

Lives watch(const Workshop& workshop, const std::string& scene, const Words& words, int exit_code = 0) {
    const Finished finished = workshop.render(own_scene(scene), words);
    EXPECT_EQ(finished.exit_code, exit_code) << finished.err.substr(0, 1000);
    return read_lives(finished.out);
}

void expect_in_order(const Lives& lives, int width) {
    for (std::size_t i = 1; i < lives.events.size(); ++i) {
        const Event& a = lives.events[i - 1];
        const Event& b = lives.events[i];
        ASSERT_LE(a.cycle, b.cycle);
        if (a.cycle < b.cycle) continue;
        const auto place = [&](const Event& e) {
            const bool exterior = starts(e.what, "answer from the exterior");
            return std::make_pair(exterior, exterior ? 0 : e.y * width + e.x);
        };
        ASSERT_LE(place(a), place(b)) << "in cycle " << a.cycle;
    }
}

/// Expects every launched ray to end with its answer at home and nothing after that.
void expect_every_ray_to_end(const Lives& lives) {
    std::map<std::string, std::string> last;
    std::map<std::string, int> launches;
    for (const Event& event : lives.events) {
        if (starts(event.what, "launched")) {
            ++launches[event.ray];
        } else {
            EXPECT_GT(launches[event.ray], 0) << event.ray << " does something before it is launched";
        }
        last[event.ray] = event.what;
    }
    EXPECT_EQ(lives.summaries.size(), launches.size()) << "one line per ray";
    for (const auto& [ray, what] : last) {
        const bool home = starts(what, "answer is home: ");
        EXPECT_TRUE(home && !starts(what, "answer is home: postponed")) << ray << ": " << what;
    }
    for (const std::string& line : lives.summaries) EXPECT_FALSE(contains(line, "(not home)")) << line;
}

const Words mirrors = {"--cells", "16x16"};

TEST(Watch, EveryRayOfAPixelComesHomeAndItsHopsAreThePictures) {
    const std::vector<Words> variants = {
        {}, {"--ray-store", "5", "--buffer", "2"}, {"--shadows", "precast"}, {"--exterior", "none"}};
    for (const Words& words : variants) {
        const Workshop workshop;
        const Lives lives =
            watch(workshop, "facing_mirrors.nff", joined(joined(mirrors, words), {"--watch-pixel", "7,9"}));
        ASSERT_GT(lives.events.size(), 30u);
        expect_in_order(lives, 16);
        expect_every_ray_to_end(lives);
        const std::int64_t hops = std::count_if(lives.events.begin(), lives.events.end(), is_hop);
        EXPECT_EQ(hops, read_exr(workshop.result("a.exr")).at(7, 9).hops);
        EXPECT_EQ(lives.last, "watched: " + std::to_string(lives.summaries.size()) + " rays, " +
                                  std::to_string(hops) + " hops");
        for (const Event& event : lives.events) EXPECT_TRUE(starts(event.ray, "151/")) << event.ray;
        EXPECT_EQ(lives.events.front().what, "launched: primary, generation 0");
        EXPECT_EQ(lives.events.back().what, "answer is home: intensity");
        EXPECT_EQ(lives.events.back().ray, "151/0");
    }
}

TEST(Watch, ChildrenAreIndentedUnderTheirParents) {
    const Workshop workshop;
    const Lives lives = watch(workshop, "facing_mirrors.nff", joined(mirrors, {"--watch-pixel", "7,9"}));
    std::set<std::size_t> indents;
    for (const Event& event : lives.events) {
        if (!starts(event.what, "launched: ")) continue;
        const auto generation = std::stoul(event.what.substr(event.what.find("generation ") + 11));
        EXPECT_EQ(event.indent, lives.events.front().indent + 2 * generation) << event.what;
        indents.insert(event.indent);
    }
    EXPECT_GE(indents.size(), 3u);
}

TEST(Watch, AWatchedRunIsTheSameRun) {
    const Workshop workshop;
    for (const std::string shadows : {"per-hit", "precast", "memo"}) {
        const Words words = joined(mirrors, {"--shadows", shadows, "--ray-store", "5"});
        const Json plain = workshop.report(own_scene("facing_mirrors.nff"), words);
        watch(workshop, "facing_mirrors.nff",
              joined(words, {"--watch-pixel", "0..15,0..15", "--watch-ray", "17/0"}));
        const Json watched = Json::parse(read_text(workshop.result("a.json")));
        EXPECT_EQ(image(watched), image(plain));
        EXPECT_EQ(schedule(watched), schedule(plain));
        EXPECT_EQ(watched.at("cycles"), plain.at("cycles"));
        EXPECT_EQ(watched.at("activity"), plain.at("activity"));
    }
}

TEST(Watch, AllPixelsTogetherTellAllHopsAndAllWaiting) {
    const Workshop workshop;
    const Lives lives =
        watch(workshop, "facing_mirrors.nff", joined(mirrors, {"--watch-pixel", "0..15,0..15"}));
    expect_in_order(lives, 16);
    expect_every_ray_to_end(lives);
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    const Json& kinds = report.at("rays");
    std::int64_t rays = 0;
    for (const char* kind : {"primary", "reflected", "refracted", "shadow"})
        rays += kinds.at(kind).get<std::int64_t>();
    EXPECT_EQ(std::int64_t(lives.summaries.size()), rays);
    const std::int64_t hops = std::count_if(lives.events.begin(), lives.events.end(), is_hop);
    EXPECT_EQ(hops, report.at("hops").at("ray").get<std::int64_t>() +
                        report.at("hops").at("return").get<std::int64_t>());
    std::int64_t waited = 0;
    for (const std::string& line : lives.summaries)
        waited += std::stoll(line.substr(line.find("waited ") + 7));
    std::int64_t in_cells = 0;
    std::istringstream csv(read_text(workshop.result("a.cells.csv")));
    std::string line;
    std::getline(csv, line);
    const auto column =
        std::count(line.begin(), line.begin() + std::ptrdiff_t(line.find("stall_cycles")), ',');
    while (std::getline(csv, line)) {
        std::istringstream fields(line);
        std::string field;
        for (std::ptrdiff_t i = 0; i <= column; ++i) std::getline(fields, field, ',');
        in_cells += std::stoll(field);
    }
    EXPECT_GT(waited, 0);
    EXPECT_EQ(waited, in_cells) << "the cells' own count";
}

TEST(Watch, PostponedRaysAreToldAndLaunchedAgain) {
    const Workshop workshop;
    const Words words = {"--cells", "16x16", "--ray-store", "5"};
    const Lives lives =
        watch(workshop, "facing_mirrors.nff", joined(words, {"--watch-pixel", "0..15,0..15"}));
    expect_every_ray_to_end(lives);
    const auto count = [&](const std::string& what) {
        return std::count_if(lives.events.begin(), lives.events.end(),
                             [&](const Event& e) { return starts(e.what, what); });
    };
    const Json report = Json::parse(read_text(workshop.result("a.json")));
    const std::int64_t postponed = report.at("deadlock").at("postponed");
    EXPECT_GT(postponed, 0) << "the case shows nothing";
    EXPECT_EQ(count("no slot: destroyed"), postponed);
    EXPECT_EQ(count("notice is home: postponed"), postponed);
    EXPECT_EQ(count("launched again"), postponed);
}

TEST(Watch, ARayIsWatchedWithItsDescendantsAlone) {
    const Workshop workshop;
    const Lives pixel = watch(workshop, "facing_mirrors.nff", joined(mirrors, {"--watch-pixel", "7,9"}));
    std::string child;
    for (const Event& event : pixel.events) {
        if (starts(event.what, "launched: reflected")) child = event.ray;
        if (!child.empty()) break;
    }
    ASSERT_FALSE(child.empty());
    const Lives alone =
        watch(workshop, "facing_mirrors.nff", joined(mirrors, {"--watch-ray", child, "--watch-ray", "3/77"}));
    std::set<std::string> rays;
    for (const Event& event : alone.events) rays.insert(event.ray);
    EXPECT_EQ(alone.events.front().ray, child);
    EXPECT_GE(rays.size(), 2u);
    EXPECT_EQ(rays.count("151/0"), 0u) << "its parent";
    std::vector<std::string> expected;
    std::vector<std::string> told;
    const auto line = [](const Event& e) { return std::to_string(e.cycle) + " " + e.ray + " " + e.what; };
    for (const Event& event : pixel.events) {
        if (rays.count(event.ray) > 0) expected.push_back(line(event));
    }
    for (const Event& event : alone.events) told.push_back(line(event));
    EXPECT_EQ(told, expected);
    EXPECT_EQ(alone.summaries.back(), "ray 3/77 was never launched");
}

TEST(Watch, ARayOfAStuckRunIsNotHome) {
    const Workshop workshop;
    const Lives lives = watch(
        workshop, "facing_mirrors.nff",
        {"--buffer", "1", "--networks", "shared", "--cells", "32x32", "--watch-pixel", "0..31,0..31"}, 3);
    EXPECT_TRUE(std::any_of(lives.summaries.begin(), lives.summaries.end(),
                            [](const std::string& line) { return contains(line, "(not home)"); }));
}

TEST(Watch, RefusesWhatIsNotThereOrHasNoTime) {
    const Workshop workshop;
    const std::vector<std::pair<Words, std::string>> wrong = {
        {{"--watch-pixel", "16,0"}, "no pixel (16, 0)"},
        {{"--watch-pixel", "3..16,0"}, "no pixel (16, 0)"},
        {{"--watch-pixel", "3"}, "expected X,Y"},
        {{"--watch-ray", "256/0"}, "no pixel 256"},
        {{"--watch-ray", "17"}, "expected PIXEL/BRANCH"},
        {{"--watch-ray", "17/4294967296"}, "expected PIXEL/BRANCH"},
        {{"--watch-ray", "-1/0"}, "expected PIXEL/BRANCH"},
        {{"--watch-ray", "17/0", "--engine", "untimed"}, "expected --engine timed"},
        {{"--watch-pixel", "1,1", "--stage", "load"}, "expected --stage trace"}};
    for (const auto& [words, message] : wrong) {
        const Finished finished = workshop.render(own_scene("facing_mirrors.nff"), joined(mirrors, words));
        EXPECT_EQ(finished.exit_code, 1) << message;
        EXPECT_TRUE(contains(finished.err, message)) << finished.err;
        EXPECT_EQ(finished.out, "");
        EXPECT_TRUE(workshop.results().empty());
    }
}

}  // namespace
}  // namespace raycell::system_test
