// scripts/study report: a run as one self-contained page.
#include "program.hpp"

namespace raycell::system_test {
namespace {

const std::string script = (fs::path(RAYCELL_SOURCE_DIR) / "scripts" / "study").string();

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
    return count;
}

void expect_self_contained(const std::string& page) {
    EXPECT_FALSE(contains(page, "http:")) << "nothing from outside";
    EXPECT_FALSE(contains(page, "https:")) << "nothing from outside";
    EXPECT_FALSE(contains(page, "<link")) << "no style sheet from outside";
    EXPECT_EQ(count_of(page, "<script"), 2u) << "its data and its script";
    EXPECT_EQ(count_of(page, "src="), count_of(page, "src=\"data:image/png;base64,"));
    EXPECT_TRUE(contains(page, "prefers-color-scheme: dark"));
    EXPECT_EQ(count_of(page, "<section"), count_of(page, "</section>"));
    EXPECT_EQ(count_of(page, "<figure"), count_of(page, "</figure>"));
    EXPECT_EQ(count_of(page, "<svg"), count_of(page, "</svg>"));
}

std::string page_of(const Workshop& workshop, const Words& more = {}) {
    const Finished finished = workshop.run_program(script, joined({"report", "results/a.json"}, more));
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    return read_text(workshop.result("a.html"));
}

TEST(ReportPage, ShowsACompletedRun) {
    const Workshop workshop;
    workshop.report(own_scene("still_life.nff"), {"--cells", "24x16", "--shadows", "precast"});
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    EXPECT_TRUE(contains(page, "class=\"verdict completed\">completed<"));
    for (const std::string part :
         {"still_life.nff", "24 × 16 cells", "rays on their way", "ray buffers, mean", "slots, mean",
          "hops of rays and answers", "voxels", "Waiting by cause", "output_full", "precast", "Configuration",
          "max-depth", "trace</text>"}) {
        EXPECT_TRUE(contains(page, part)) << part;
    }
    EXPECT_GE(count_of(page, "class=\"map\""), 15u);
    EXPECT_FALSE(contains(page, "What is stuck"));
}

TEST(ReportPage, HasTheRaysOfSeveralSamples) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "4x4", "--samples", "3", "--rays"});
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    EXPECT_TRUE(contains(page, "id=\"rays\"")) << "the names of samples' rays are read, or page_of() fails";
}

TEST(ReportPage, ShowsWhatIsStuckInADeadlock) {
    const Workshop workshop;
    const Json report = workshop.report(own_scene("facing_mirrors.nff"),
                                        {"--buffer", "1", "--networks", "shared", "--cells", "32x32"}, 3);
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    EXPECT_TRUE(contains(page, "class=\"verdict deadlock\">deadlock<"));
    EXPECT_TRUE(contains(page, "What is stuck"));
    EXPECT_TRUE(contains(page, "<code>--networks half</code> it is certain to end")) << "reason and cure";
    EXPECT_GT(count_of(page, "class=\"stuck\""), 3u) << "cells are marked";
    for (const auto& line : report.at("deadlock").at("report")) {
        // The page escapes quotation marks.
        const std::string text = line;
        ASSERT_TRUE(contains(page, text.substr(0, text.find('\'')))) << line;
    }
}

TEST(ReportPage, DrawsAKnotsRing) {
    const Workshop workshop;
    Json report = workshop.report(own_scene("facing_mirrors.nff"),
                                  {"--buffer", "1", "--networks", "shared", "--cells", "32x32"}, 3);
    Json knot = {
        {"formed", 1234}, {"cells", Json::array()}, {"nodes", Json::array()}, {"edges", Json::array()}};
    const int ring[4][2] = {{4, 5}, {5, 5}, {5, 6}, {4, 6}};
    for (int i = 0; i < 4; ++i) {
        knot["cells"].push_back({ring[i][0], ring[i][1]});
        knot["nodes"].push_back({{"x", ring[i][0]}, {"y", ring[i][1]}, {"what", "input <west>"}});
        knot["edges"].push_back({i, (i + 1) % 4});
    }
    report["deadlock"]["knot"] = knot;
    workshop.write("results/a.json", report.dump());
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    EXPECT_TRUE(
        contains(page,
                 "The knot: 4 of 1024 cells, 4 waits between them, an arrow from who waits to what it waits "
                 "for; it stands since cycle 1234"));
    EXPECT_EQ(count_of(page, "class=\"edge\""), 9u)
        << "in the array and, larger, beside it; one in the legend";
}

TEST(ReportPage, ShowsTheTruthAndTheRecordings) {
    const Workshop workshop;
    workshop.report(own_scene("still_life.nff"), {"--cells", "16x16", "--truth", "--film", "20", "--rays"});
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    for (const std::string part : {"Against the truth", "their difference", "PSNR", "SSIM", "FLIP",
                                   "Over time", "The rays of a pixel"}) {
        EXPECT_TRUE(contains(page, part)) << part;
    }
}

TEST(ReportPage, RefusesTheRecordingOfAnotherRun) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8", "--film", "20"});
    workshop.report(own_scene("cornell.nff"), {"--cells", "9x8"}, 0, "b");
    fs::rename(workshop.result("a.film.json"), workshop.result("b.film.json"));
    const Finished finished = workshop.run_program(script, {"report", "results/b.json"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
    EXPECT_TRUE(contains(finished.err, "b.film.json: not this run's recording (8 x 8 blocks"))
        << finished.err;
}

TEST(ReportPage, ShowsTwoRunsBesideEachOther) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "12x12"});
    workshop.report(own_scene("cornell.nff"), {"--cells", "12x12", "--buffer", "3"}, 0, "b");
    workshop.report(own_scene("cornell.nff"), {"--cells", "12x13"}, 0, "c");
    const Finished finished = workshop.run_program(script, {"report", "results/a.json", "results/b.json"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const std::string page = read_text(workshop.result("a.and.b.html"));
    expect_self_contained(page);
    for (const std::string part :
         {"<td>--buffer</td><td>2</td><td>3</td>", "second less first", "What differs", "line second"}) {
        EXPECT_TRUE(contains(page, part)) << part;
    }
    const Finished other = workshop.run_program(script, {"report", "results/a.json", "results/c.json"});
    EXPECT_EQ(other.exit_code, 1);
    EXPECT_TRUE(contains(other.err, "12 x 13 cells; expected 12 x 12")) << other.err;
}

TEST(ReportPage, OfTwoRunsSaysWhatIsStuckInTheOneThatLocks) {
    const Workshop workshop;
    const Words mirrors = {"--cells", "32x32"};
    workshop.report(own_scene("facing_mirrors.nff"),
                    joined(mirrors, {"--buffer", "1", "--networks", "split"}), 3);
    workshop.report(own_scene("facing_mirrors.nff"), mirrors, 0, "b");
    const Finished finished = workshop.run_program(script, {"report", "results/a.json", "results/b.json"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const std::string page = read_text(workshop.result("a.and.b.html"));
    EXPECT_TRUE(contains(page, "What is stuck in the first"));
    EXPECT_FALSE(contains(page, "What is stuck in the second"));
    EXPECT_TRUE(contains(page, "<code>--networks half</code>"));
}

TEST(ReportPage, DoesWithWhatAnUntimedRunKnows) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8", "--engine", "untimed"});
    const std::string page = page_of(workshop);
    expect_self_contained(page);
    EXPECT_EQ(count_of(page, "class=\"map\""), 2u);
    EXPECT_FALSE(contains(page, "Activity over time"));
}

TEST(ReportPage, DoesWithoutPictureAndCells) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8"});
    fs::remove(workshop.result("a.png"));
    fs::remove(workshop.result("a.cells.csv"));
    const std::string page = page_of(workshop);
    EXPECT_TRUE(contains(page, "without a picture"));
    EXPECT_TRUE(contains(page, "maps are missing"));
}

TEST(ReportPage, EveryVerdictAndStageHasAPage) {
    const Workshop workshop;
    const std::vector<std::pair<Words, int>> runs = {
        {{"--max-cycles", "100"}, 4}, {{"--stage", "load"}, 0}, {{"--voxel-capacity", "1"}, 4}};
    for (const auto& [words, exit_code] : runs) {
        const Json report =
            workshop.report(own_scene("still_life.nff"), joined({"--cells", "16x1"}, words), exit_code);
        const std::string page = page_of(workshop);
        expect_self_contained(page);
        EXPECT_TRUE(contains(page, "\">" + report.at("verdict").get<std::string>() + "<"));
    }
}

TEST(ReportPage, NamesAreNoMarkup) {
    const Workshop workshop;
    const fs::path scene = workshop.write("<b>&.nff", read_text(own_scene("cornell.nff")));
    workshop.report(scene, {"--cells", "4x4"});
    const std::string page = page_of(workshop);
    EXPECT_FALSE(contains(page, "<b>&.nff"));
    EXPECT_TRUE(contains(page, "&lt;b&gt;&amp;.nff"));
}

TEST(ReportPage, TheSameRunGivesTheSamePage) {
    const Workshop workshop;
    workshop.report(own_scene("cornell.nff"), {"--cells", "8x8"});
    const std::string first = page_of(workshop);
    const Finished finished = workshop.run_program(script, {"report", "results/a.json", "-o", "other.html"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(read_text(workshop.path() / "other.html") == first);
}

TEST(ReportPage, RefusesWhatIsNoRunInOneLine) {
    const Workshop workshop;
    workshop.write("broken.json", "{\"verdict\": ");
    workshop.write("other.json", "{\"psnr_db\": 35.5}");
    workshop.write("list.json", "[1, 2]");
    workshop.write(
        "part.json",
        "{\"verdict\": \"completed\", \"cycles\": {}, \"hops\": {}, \"rays\": {}, \"deadlock\": {}, "
        "\"config\": {\"cells\": \"4x4\"}}");
    workshop.report(own_scene("cornell.nff"), {"--cells", "4x4"});
    workshop.write("results/a.cells.csv", "x,y,voxels,edges\n0,0,1,1\n");
    for (const std::string file :
         {"missing.json", "broken.json", "other.json", "list.json", "part.json", "results/a.json"}) {
        const Finished finished = workshop.run_program(script, {"report", file, "-o", "page.html"});
        EXPECT_EQ(finished.exit_code, 1) << file;
        EXPECT_EQ(finished.error_lines(), 1u) << finished.err;
        EXPECT_TRUE(contains(finished.err, file == "results/a.json" ? "a.cells.csv" : file)) << finished.err;
        EXPECT_FALSE(fs::exists(workshop.path() / "page.html")) << file;
    }
    EXPECT_EQ(workshop.run_program(script, {"report"}).exit_code, 1);
}

}  // namespace
}  // namespace raycell::system_test
