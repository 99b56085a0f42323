// The program of the stability studies, and bounds on what it measures.
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>

#include "program.hpp"

namespace raycell::system_test {
namespace {

using Row = std::map<std::string, std::string>;

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

/// The program's output, error output and exit code.
struct StudyRun {
    int exit_code;
    std::string out;
    std::string err;
};
StudyRun run_stability(const Workshop& workshop, const std::string& arguments) {
    const fs::path out = workshop.path() / "out.txt";
    const fs::path err = workshop.path() / "err.txt";
    const std::string command = std::string("\"") + RAYCELL_STABILITY_TB + "\" " + arguments + " >\"" +
                                out.string() + "\" 2>\"" + err.string() + "\"";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

/// The rows of one quick study.
class Stability : public ::testing::Test {
  protected:
    std::vector<Row> study(const std::string& name) {
        const StudyRun run = run_stability(workshop, "--quick --study " + name + " --csv \"" +
                                                         (workshop.path() / "results").string() + "\"");
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_TRUE(contains(run.out, "Seed 1, quick")) << run.out.substr(0, 200);
        EXPECT_TRUE(contains(run.out, "\nBoundary: ")) << "what was found";
        EXPECT_TRUE(contains(run.out, "\nTreatment: ")) << "what is done about it";
        return rows_of(read_text(workshop.result(name + ".csv")));
    }

    static std::vector<Row> rows_of(const std::string& csv) {
        std::istringstream lines(csv);
        std::vector<std::string> names;
        std::vector<Row> rows;
        for (std::string line; std::getline(lines, line);) {
            const std::vector<std::string> values = fields(line);
            if (names.empty()) {
                names = values;
                continue;
            }
            EXPECT_EQ(values.size(), names.size()) << line;
            Row row;
            for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
            rows.push_back(row);
        }
        EXPECT_FALSE(rows.empty());
        return rows;
    }

    /// The fields of a CSV line; those that contain a comma are quoted.
    static std::vector<std::string> fields(const std::string& line) {
        std::vector<std::string> all(1);
        bool quoted = false;
        for (const char c : line) {
            if (c == '"') {
                quoted = !quoted;
            } else if (c == ',' && !quoted) {
                all.emplace_back();
            } else {
                all.back() += c;
            }
        }
        return all;
    }

    /// Calls `check` for each row with these values; at least one must exist.
    static void for_rows(const std::vector<Row>& rows, const Row& where,
                         const std::function<void(const Row&)>& check) {
        int found = 0;
        for (const Row& row : rows) {
            bool matches = true;
            for (const auto& [column, value] : where) matches = matches && row.at(column) == value;
            if (!matches) continue;
            ++found;
            std::string text;
            for (const auto& [column, value] : row) text += column + "=" + value + " ";
            SCOPED_TRACE(text);
            check(row);
        }
        EXPECT_GT(found, 0);
    }

    Workshop workshop;
};

TEST_F(Stability, NoRayLeaksThroughAPlaneFromIntervalUpInExactArithmeticAndHardlyAnyInWords) {
    const std::vector<Row> rows = study("slopes");
    for (const char* rung : {"interval", "plane", "mask", "edge"}) {
        const std::string column = std::string(rung) + "_leak_percent";
        for_rows(rows, {{"arithmetic", "exact"}}, [&](const Row& row) { EXPECT_EQ(number(row, column), 0); });
        for_rows(rows, {{"arithmetic", "fixed 20"}},
                 [&](const Row& row) { EXPECT_LE(number(row, column), 0.1); });
        for_rows(rows, {{"arithmetic", "fixed 12"}},
                 [&](const Row& row) { EXPECT_LE(number(row, column), 2); });
    }
    for_rows(rows, {{"slope", "2"}}, [](const Row& row) {
        EXPECT_GT(number(row, "depth_leak_percent"), 20) << "the paper's test: the study sees leaks";
    });
}

TEST_F(Stability, ARayDriftsByLastBitsOfItsWordOver1024Cells) {
    for_rows(study("dda_drift"), {}, [](const Row& row) {
        const double step = std::ldexp(1.0, -int(number(row, "fraction_bits")));
        const bool plain = row.at("method") == "plain DDA";
        EXPECT_LE(number(row, "largest_error_cells"), (plain ? 513 : 4096) * step);
        EXPECT_GT(number(row, "largest_error_cells"), 0);
    });
}

TEST_F(Stability, ASpanWithGuardBitsIsAtItsLastCellWhatIsCutThere) {
    const std::vector<Row> rows = study("span_drift");
    for_rows(rows, {{"method", "16 guard bits"}}, [](const Row& row) {
        EXPECT_EQ(number(row, "largest_depth_drift_cells"), 0);
        EXPECT_EQ(number(row, "largest_normal_drift_rad"), 0);
        EXPECT_LE(number(row, "largest_depth_error_cells"), std::ldexp(64, -int(number(row, "word_bits"))));
    });
    for_rows(rows, {{"method", "no guard bits"}, {"word_bits", "20"}},
             [](const Row& row) { EXPECT_GT(number(row, "largest_depth_error_cells"), 1); });
}

TEST_F(Stability, InterpolatedNormalsStayUnitAndAreNumbersEvenWhereTheyVanish) {
    const std::vector<Row> rows = study("normals");
    for_rows(rows, {}, [](const Row& row) { EXPECT_EQ(number(row, "not_numbers"), 0); });
    for_rows(rows, {{"arithmetic", "exact"}, {"where", "zero line"}}, [](const Row& row) {
        EXPECT_EQ(number(row, "fallback_percent"), 100) << "the plane's normal where the vertices' cancel";
    });
    for_rows(rows, {{"arithmetic", "fixed 20"}, {"root", "newton 64"}},
             [](const Row& row) { EXPECT_LE(number(row, "largest_length_error"), 2e-5); });
    for_rows(rows, {{"arithmetic", "fixed 20"}, {"root", "newton 64"}, {"opening_deg", "60"}},
             [](const Row& row) { EXPECT_LE(number(row, "largest_angle_error_rad"), 1e-4); });
}

TEST_F(Stability, AReflectedRayHardlyEverMeetsItsOwnMirrorAndStaysAboveItWhereTheWordCanTell) {
    const std::vector<Row> rows = study("grazing");
    for_rows(rows, {}, [](const Row& row) { EXPECT_LE(number(row, "hit_again_percent"), 1); });
    for_rows(rows, {{"arithmetic", "exact"}}, [](const Row& row) {
        EXPECT_EQ(number(row, "hit_again_percent"), 0);
        EXPECT_EQ(number(row, "below_percent"), 0);
        EXPECT_LE(number(row, "largest_angle_error_rad"), 1e-12);
    });
    for_rows(rows, {{"arithmetic", "fixed 20"}}, [](const Row& row) {
        EXPECT_LE(number(row, "largest_angle_error_rad"), 1e-4);
        EXPECT_EQ(number(row, "hit_again_percent"), 0);
        if (number(row, "grazing_rad") >= 1e-4) {
            EXPECT_EQ(number(row, "below_percent"), 0);
        }
    });
}

TEST_F(Stability, TotalReflectionIsToldRightUpToAWordsLastBitsFromTheCriticalAngle) {
    const std::vector<Row> rows = study("critical");
    const std::map<std::string, double> least = {
        {"exact", 1e-7}, {"fixed 32", 1e-7}, {"fixed 24", 1e-6}, {"fixed 20", 1e-4}, {"fixed 12", 0.01}};
    for (const auto& [arithmetic, off] : least) {
        for_rows(rows, {{"arithmetic", arithmetic}}, [limit = off](const Row& row) {
            if (number(row, "from_critical_rad") < limit * 0.99) return;
            EXPECT_EQ(number(row, "wrongly_total_percent"), 0);
            EXPECT_EQ(number(row, "wrongly_refracted_percent"), 0);
        });
    }
}

TEST_F(Stability, TheDefaultNormalOffsetIsAsGoodAsAnyOther) {
    const std::vector<Row> rows = study("offset");
    const std::map<std::string, double> most = {{"exact", 0}, {"fixed 20", 0.05}, {"fixed 12", 1}};
    for (const auto& [arithmetic, limit] : most) {
        for_rows(rows, {{"arithmetic", arithmetic}, {"is_default", "1"}}, [limit = limit](const Row& row) {
            EXPECT_LE(number(row, "wrongly_shadowed_percent") + number(row, "wrongly_lit_percent"), limit);
        });
    }
    for_rows(rows, {{"arithmetic", "exact"}, {"offset_cells", "0.1"}}, [](const Row& row) {
        EXPECT_GT(number(row, "wrongly_lit_percent"), 0) << "too large an offset: the study sees it";
    });
}

TEST_F(Stability, AtRungEdgeEveryFirstHitIsTheTruthsHoweverNearTheViewer) {
    const std::vector<Row> rows = study("near_viewer");
    for (const char* arithmetic : {"exact", "fixed 20"}) {
        for_rows(rows, {{"rung", "edge"}, {"arithmetic", arithmetic}}, [](const Row& row) {
            EXPECT_EQ(number(row, "wrong_first_hit_percent"), 0);
            EXPECT_GE(number(row, "psnr_db"), 60);
        });
    }
}

TEST_F(Stability, TwoPolygonsInOnePlaceShowTheLowerIdOnEveryRunAsInTheTruth) {
    const std::vector<Row> rows = study("coincident");
    for_rows(rows, {}, [](const Row& row) { EXPECT_EQ(number(row, "not_repeated"), 0); });
    for (const char* surfaces :
         {"one outline twice, facing", "one outline twice, tilted", "two outlines, facing"}) {
        for_rows(rows, {{"surfaces", surfaces}}, [](const Row& row) {
            EXPECT_EQ(number(row, "lower_id_percent"), 100);
            EXPECT_EQ(number(row, "as_truth_percent"), 100);
        });
    }
    for_rows(rows, {{"surfaces", "crossing"}, {"rung", "edge"}, {"arithmetic", "exact"}},
             [](const Row& row) { EXPECT_LE(number(row, "wrong_within_cells"), 1e-6); });
    for_rows(rows, {{"surfaces", "crossing"}, {"rung", "edge"}, {"arithmetic", "fixed 20"}},
             [](const Row& row) {
                 const double angle = number(row, "angle_deg") * 3.14159265 / 180;
                 EXPECT_LE(number(row, "wrong_within_cells"), 6e-5 / std::tan(angle / 2));
             });
}

TEST_F(Stability, ASmallTriangleIsStoredFromIntervalUpAndFoundWhereItIs) {
    const std::vector<Row> rows = study("small");
    for (const char* rung : {"interval", "plane", "mask", "edge"}) {
        for_rows(rows, {{"rung", rung}},
                 [](const Row& row) { EXPECT_EQ(number(row, "stored_percent"), 100); });
        for_rows(rows, {{"rung", rung}, {"arithmetic", "exact"}},
                 [](const Row& row) { EXPECT_EQ(number(row, "found_percent"), 100); });
    }
    for_rows(rows, {{"rung", "edge"}, {"arithmetic", "exact"}}, [](const Row& row) {
        EXPECT_EQ(number(row, "false_hit_percent"), 0);
        EXPECT_LE(number(row, "largest_place_error_cells"), 1e-9);
    });
    for_rows(rows, {{"rung", "edge"}, {"arithmetic", "fixed 20"}}, [](const Row& row) {
        EXPECT_LE(number(row, "largest_place_error_cells"), 5e-4);
        if (number(row, "size_cells") < 0.003) return;
        EXPECT_EQ(number(row, "found_percent"), 100);
        EXPECT_EQ(number(row, "false_hit_percent"), 0);
    });
}

TEST_F(Stability, FacingMirrorsLoseNoMoreThanLastBitsPerGeneration) {
    const std::vector<Row> rows = study("mirrors");
    for_rows(rows, {{"arithmetic", "exact"}}, [](const Row& row) {
        EXPECT_LE(number(row, "largest_position_error_cells"), 1e-7);
        EXPECT_LE(number(row, "largest_intensity_error"), 1e-7);
    });
    for_rows(rows, {{"arithmetic", "fixed 20"}}, [](const Row& row) {
        EXPECT_LE(number(row, "largest_position_error_cells"), 0.002 * (number(row, "generations") + 1));
        EXPECT_LE(number(row, "largest_intensity_error"), 0.001 * (number(row, "generations") + 1));
        EXPECT_GE(number(row, "scene_psnr_db"), 50);
    });
}

TEST_F(Stability, NothingWrapsRoundOrStopsBeingANumberAtTheEndsOfTheFormats) {
    const std::vector<Row> rows = study("saturation");
    std::map<std::string, double> before;
    bool saturates = false;
    for_rows(rows, {}, [&](const Row& row) {
        EXPECT_EQ(number(row, "not_numbers"), 0);
        EXPECT_EQ(number(row, "infinite"), 0);
        EXPECT_EQ(number(row, "negative"), 0);
        EXPECT_LE(number(row, "hops_per_ray"), 32) << "16 by 16 cells";
        saturates = saturates || number(row, "saturated_inputs") > 0;
        const std::string input = row.at("input");
        if (input != "source intensity" && input != "colour") return;
        double& last = before[input + row.at("arithmetic")];
        EXPECT_GE(number(row, "mean_intensity"), last - 0.02) << "more light can't make it darker";
        last = number(row, "mean_intensity");
    });
    EXPECT_TRUE(saturates) << "the inputs reach the ends";
    for_rows(rows, {{"arithmetic", "exact"}},
             [](const Row& row) { EXPECT_LE(number(row, "rms_error"), 1e-5); });
}

TEST_F(Stability, TheSameSeedGivesTheSameTablesAndAnotherSeedOthers) {
    const std::string words = "--quick --study dda_drift --seed ";
    const StudyRun first = run_stability(workshop, words + "7");
    EXPECT_TRUE(contains(first.out, "Seed 7, quick"));
    EXPECT_EQ(first.out, run_stability(workshop, words + "7").out);
    const std::string other = run_stability(workshop, words + "8").out;
    EXPECT_NE(first.out.substr(first.out.find('\n')), other.substr(other.find('\n')));
}

TEST_F(Stability, WhatItDoesNotKnowIsOneMessageAndExitCodeOne) {
    for (const char* words : {"--nonsense", "--study nonsense", "--study", "--seed -1", "--seed 1x",
                              "--csv no/such/folder", "extra"}) {
        SCOPED_TRACE(words);
        const StudyRun run = run_stability(workshop, words);
        EXPECT_EQ(run.exit_code, 1);
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    EXPECT_EQ(run_stability(workshop, "--help").exit_code, 0);
    const std::string list = run_stability(workshop, "--list").out;
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 14);
}

TEST_F(Stability, SpheresOfFacetsAreMetWithinTheirChordErrorAndLoseNoRay) {
    for (const Row& row : study("chord_error")) {
        SCOPED_TRACE(row.at("arithmetic") + ", radius " + row.at("radius_cells") + ", chord error " +
                     row.at("chord_error_cells"));
        const double chord_error = number(row, "chord_error_cells");
        if (row.at("arithmetic") == "exact") {
            EXPECT_LE(number(row, "largest_place_error_cells"), 0.5 * chord_error * (1 + 1e-6));
            EXPECT_EQ(number(row, "hits_beside_percent"), 0);
        }
        if (row.at("arithmetic") != "fixed 8") EXPECT_EQ(number(row, "rays_lost_percent"), 0);
    }
}

TEST_F(Stability, TheOrderOfLoadingChangesNoPixelWhereNoTwoSurfacesLieInOnePlace) {
    std::size_t twice = 0;
    for (const Row& row : study("loading_order")) {
        SCOPED_TRACE(row.at("surfaces") + ", " + row.at("rung") + ", " + row.at("arithmetic"));
        EXPECT_EQ(number(row, "other_cells_percent"), 0);
        if (row.at("surfaces") == "each twice") {
            twice += number(row, "other_pixels_percent") > 0;
        } else if (row.at("rung") == "edge" && row.at("arithmetic") == "exact") {
            EXPECT_EQ(number(row, "other_pixels_percent"), 0);
        }
    }
    EXPECT_GT(twice, 0u) << "else this tests nothing";
}

}  // namespace
}  // namespace raycell::system_test
