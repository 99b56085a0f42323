// Errors on the command line and in configuration files: exit code 1, one clear message, no file.
#include <algorithm>

#include "program.hpp"

namespace raycell::system_test {
namespace {

/// Expects one message; the hint at --help may follow it.
void expect_refused(const Workshop& workshop, const Finished& finished, const std::string& part) {
    EXPECT_EQ(finished.exit_code, 1) << finished.err;
    EXPECT_EQ(finished.signal, 0);
    EXPECT_EQ(finished.out, "");
    std::string message = finished.err;
    const std::string hint = "Run with --help for more information.\n";
    const std::size_t at = message.find(hint);
    if (at != std::string::npos) message.erase(at);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << finished.err;
    EXPECT_TRUE(contains(message, part)) << "no '" << part << "' in: " << finished.err;
    EXPECT_EQ(workshop.results(), std::vector<std::string>());
}

struct Wrong {
    Words words;
    std::string part;  ///< of the message
};

void expect_each_refused(const std::vector<Wrong>& wrongs) {
    const Workshop workshop;
    for (const Wrong& wrong : wrongs) {
        std::string line;
        for (const std::string& word : wrong.words) line += " '" + word + "'";
        SCOPED_TRACE("raycell render SCENE" + line);
        expect_refused(workshop,
                       workshop.render(own_scene("cornell.nff"), joined({"--cells", "4x4"}, wrong.words)),
                       wrong.part);
    }
}

void expect_values_refused(const std::string& option, const Words& values) {
    std::vector<Wrong> wrongs;
    for (const std::string& value : values) wrongs.push_back({{"--" + option, value}, "--" + option + ": "});
    expect_each_refused(wrongs);
}

const Words no_numbers = {"", "abc", "nan", "inf", "-inf", "1,5", "5x"};

TEST(Usage, UnknownOptionsAreNamed) {
    expect_each_refused({{{"--nonsense"}, "--nonsense"},
                         {{"--nonsense=3"}, "--nonsense"},
                         {{"-z"}, "-z"},
                         {{"--cel", "4x4"}, "--cel"},
                         {{"--Hit", "edge"}, "--Hit"},
                         {{"second.nff"}, "second.nff"}});
}

TEST(Usage, AnUnknownCommandIsNamed) {
    const Workshop workshop;
    expect_refused(workshop, workshop.run({"rendr", own_scene("cornell.nff").string()}), "rendr");
}

TEST(Usage, NoCommandIsAnErrorThatNamesWhatIsMissing) {
    const Workshop workshop;
    expect_refused(workshop, workshop.run({}), "subcommand");
}

TEST(Usage, SizesOutOfRangeAreRefused) {
    expect_values_refused(
        "cells", {"0x0",  "5000x5000", "4097x1", "1x4097", "0x8",           "8x0",         "-1",  "-8x8",
                  "8x-8", "8x",        "x8",     "8",      "8x8x8",         "8.5x8",       "8X8", "8 x 8",
                  "nan",  "nanxnan",   "inf",    "",       "99999999999x1", "4294967297x1"});
}

TEST(Usage, WholeNumbersOutOfRangeAreRefused) {
    const std::vector<std::pair<std::string, Words>> options = {
        {"depth", {"0", "-1", "65537"}},
        {"max-depth", {"-1", "63"}},
        {"word-bits", {"7", "33", "-20"}},
        {"source-samples", {"0", "-1", "65"}},
        {"samples", {"0", "-1", "65"}},
        {"truth-samples", {"0", "-1", "65537"}},
        {"ray-store", {"0", "-1", "1025"}},
        {"buffer", {"0", "-1", "1025"}},
        {"link-bits", {"0", "-1", "4097"}},
        {"reciprocal-table", {"1", "2", "8192"}},
        {"root-table", {"-64", "3", "4097"}},
        {"power-table", {"1", "5000"}},
        {"max-cycles", {"-1", "4611686018427387905"}},
        {"voxel-capacity", {"-1", "1000001"}},
        {"exterior-processors", {"0", "-1", "1000001"}},
        {"exterior-latency", {"0", "-1", "1000000001"}},
        {"seed", {"-1", "9223372036854775808"}}};
    for (const auto& [option, values] : options) {
        expect_values_refused(option, values);
        expect_values_refused(option, {"1.5", "1e3", "99999999999999999999", "4294967297.0"});
    }
    expect_values_refused("depth", no_numbers);
    expect_values_refused("seed", no_numbers);
}

TEST(Usage, RealNumbersOutOfRangeAreRefused) {
    const std::vector<std::pair<std::string, Words>> options = {
        {"chord-error", {"0", "-0.1", "1001", "1e-4"}},
        {"tessellate-for", {"-1", "100.1"}},
        {"sample-until", {"-1.1", "8.1"}},
        {"min-weight", {"-0.1", "1.1", "-1e-9"}},
        {"clock-mhz", {"0", "-20", "1e6", "1e-4"}},
        {"normal-offset", {"-1.1", "1.5"}}};
    for (const auto& [option, values] : options) {
        expect_values_refused(option, values);
        expect_values_refused(option, no_numbers);
        expect_values_refused(option, {"1e999", "-1e999"});
    }
}

TEST(Usage, WordsThatNoChoiceOffersAreRefused) {
    const Words options = {"viewer",  "stage",    "display",    "engine",   "hit",        "normals",
                           "shadows", "exterior", "arithmetic", "rounding", "reciprocal", "root",
                           "power",   "networks", "recovery",   "slots"};
    for (const std::string& option : options) expect_values_refused(option, {"foo", "", "EDGE", "0", "nan"});
    expect_values_refused("hit", {"edg", "edges", "edge ", "edge|mask"});
    expect_values_refused("arithmetic", {"float", "double"});
}

TEST(Usage, TablesWhoseSizeIsNoPowerOfTwoAreRefused) {
    for (const std::string table : {"reciprocal", "root", "power"}) {
        for (const std::string size : {"5", "6", "63", "100", "4095"}) {
            expect_each_refused({{{"--" + table + "-table", size},
                                  "--" + table + "-table: expected 0 or a power of two from 4 to 4096"}});
        }
    }
}

TEST(Usage, CostsThatAreNoneAreRefused) {
    expect_values_refused(
        "cost", {"walk_step", "walk_step=", "walk_step=-1", "walk_step=0", "walk_step=nan", "walk_step=1.5",
                 "walk_step=99999999999", "walk_step=3x", "foo=1", "=1", "", "="});
}

TEST(Usage, AnOptionWithoutItsValueIsRefused) {
    for (const std::string option : {"--hit", "--depth", "--cells", "--config", "--cost"}) {
        expect_each_refused({{{option}, option}});
    }
}

TEST(Usage, NumbersWithLeadingZerosAreDecimal) {
    // Nobody who writes 010 means eight.
    const Workshop workshop;
    const Finished finished = workshop.render(own_scene("cornell.nff"), {"--cells", "4x4", "--depth", "010"});
    if (finished.exit_code == 1) return;
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_EQ(Json::parse(read_text(workshop.result("a.json"))).at("config").at("depth"), 10);
}

TEST(Usage, FilesThatAreNotThereAreNamed) {
    const Workshop workshop;
    expect_refused(workshop, workshop.render("none.nff", {}), "none.nff");
    expect_refused(workshop, workshop.render(".", {}), "directory");
    expect_refused(workshop, workshop.render("", {}), "no scene given");
    expect_refused(workshop, workshop.run({"render", "-o", "results/a"}), "no scene given");
    expect_refused(workshop, workshop.run({"truth", "none.nff", "-o", "results/a"}), "none.nff");
    expect_refused(workshop, workshop.run({"compare", "none.exr", "none.exr"}), "none.exr");
    expect_refused(workshop, workshop.run({"compare", "none.exr"}), "truth");
    expect_each_refused({{{"--view", "none.nff"}, "none.nff"}, {{"--config", "none.toml"}, "none.toml"}});
}

TEST(Usage, OutputWhereNoneCanBeIsRefusedBeforeAnyWork) {
    const Workshop workshop;
    for (const std::string prefix : {"results/", "", "stdout.txt/a", "stdout.txt/b/a"}) {
        SCOPED_TRACE("-o '" + prefix + "'");
        for (const std::string command : {"render", "truth"}) {
            // The scene does not exist, but is not even looked for.
            expect_refused(workshop, workshop.run({command, "none.nff", "-o", prefix}), "--output " + prefix);
        }
    }
}

TEST(Usage, FoldersForResultsAreMadeAndKeptOnlyWithResultsInThem) {
    const Workshop workshop;
    const Words words = {"--cells", "4x4", "--quiet", "-o", "results/new/folders/a"};
    const Finished refused = workshop.run(joined({"render", "none.nff"}, words));
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(workshop.results().empty()) << "no empty folder either";
    const Finished done = workshop.run(joined({"render", own_scene("cornell.nff").string()}, words));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_TRUE(fs::exists(workshop.result("new/folders/a.json")));
}

TEST(Usage, APictureNamedAsOutputMeansItsPrefix) {
    const Workshop workshop;
    const Finished finished = workshop.run(
        {"render", own_scene("cornell.nff").string(), "--cells", "4x4", "--quiet", "-o", "results/a.png"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(fs::exists(workshop.result("a.png")));
    EXPECT_FALSE(fs::exists(workshop.result("a.png.png")));
}

TEST(Usage, AMisspeltOptionIsToldWhatItMayHaveMeant) {
    const Workshop workshop;
    for (const auto& [wrong, right] :
         std::vector<std::pair<std::string, std::string>>{{"--ray-stor", "--ray-store?"},
                                                          {"--netwroks", "--networks?"},
                                                          {"--word_bits", "--word-bits?"}}) {
        const Finished finished = workshop.run({"render", "none.nff", wrong, "8"});
        EXPECT_EQ(finished.exit_code, 1);
        EXPECT_TRUE(contains(finished.err, "did you mean " + right)) << finished.err;
    }
    EXPECT_FALSE(contains(workshop.run({"render", "none.nff", "--qqqqqq", "8"}).err, "did you mean"));
}

TEST(Usage, EveryProgramSaysWhatItWasBuiltFrom) {
    const Workshop workshop;
    const fs::path folder = fs::path(RAYCELL_PROGRAM).parent_path();
    for (const char* program :
         {"raycell", "deadlock_tb", "cell_tb", "loading_tb", "operators_tb", "stability_tb"}) {
        SCOPED_TRACE(program);
        const Finished finished = workshop.run_program((folder / program).string(), {"--version"});
        EXPECT_EQ(finished.exit_code, 0);
        for (const char* part : {"0.2.0, ", "GCC ", "SystemC 2."})
            EXPECT_TRUE(contains(finished.out, part)) << finished.out;
    }
}

TEST(Usage, CompletionIsAScriptThatBashAccepts) {
    const Workshop workshop;
    const Finished finished = workshop.run({"completion"});
    EXPECT_EQ(finished.exit_code, 0);
    workshop.write("completion.bash", finished.out);
    const Finished completed = workshop.run_program(
        "/bin/bash",
        {"-c",
         "source completion.bash; COMP_WORDS=(raycell render --networks ''); COMP_CWORD=3; _raycell; "
         "echo ${COMPREPLY[@]}; COMP_WORDS=(raycell sw); COMP_CWORD=1; _raycell; echo ${COMPREPLY[@]}"});
    EXPECT_EQ(completed.out, "half quadrant split shared\nsweep\n") << completed.err;
}

TEST(Usage, HelpEndsWellAndNamesUnits) {
    const Workshop workshop;
    const std::vector<std::pair<Words, Words>> helps = {
        {{"--help"}, {"render", "truth", "compare"}},
        {{"render", "--help"},
         {"cells", "cycles", "bits", "MHz", "slots", "messages", "levels", "voxels", "generations", "WxH"}},
        {{"truth", "--help"}, {"cells", "WxH", "generations"}},
        {{"compare", "--help"}, {"dB", "percent"}}};
    for (const auto& [words, parts] : helps) {
        const Finished finished = workshop.run(words);
        EXPECT_EQ(finished.exit_code, 0);
        EXPECT_EQ(finished.err, "");
        for (const std::string& part : parts) EXPECT_TRUE(contains(finished.out, part)) << part;
    }
}

// ---- configuration files

void expect_configuration_refused(const std::string& text, const Words& parts) {
    const Workshop workshop;
    workshop.write("run.toml", text);
    SCOPED_TRACE(text.substr(0, 60));
    const Finished finished =
        workshop.render(own_scene("cornell.nff"), {"--cells", "4x4", "--config", "run.toml"});
    for (const std::string& part : parts) expect_refused(workshop, finished, part);
}

TEST(Configuration, UnknownKeysAreNamedWithTheirFile) {
    for (const std::string key : {"nonsense", "max_depth", "Depth", "h", "o", "help", "config"}) {
        expect_configuration_refused(key + " = 1\n", {"run.toml", "'" + key + "'"});
    }
    expect_configuration_refused("[render]\ndepth = 5\n", {"run.toml:1", "'render'"});
    expect_configuration_refused("depth = 5\n[machine]\nbuffer = 2\n", {"run.toml:2", "'machine'"});
}

TEST(Configuration, WrongValuesAreNamedWithTheirFile) {
    // Without the file's name, users would look for --depth on the command line.
    expect_configuration_refused("depth = 0\n", {"depth: ", "run.toml"});
    expect_configuration_refused("hit = \"foo\"\n", {"hit: ", "run.toml"});
    expect_configuration_refused("cells = \"8x\"\n", {"cells: ", "run.toml"});
    expect_configuration_refused("min-weight = nan\n", {"min-weight: ", "run.toml"});
    expect_configuration_refused("truth = \"maybe\"\n", {"truth", "run.toml"});
    expect_configuration_refused("cost = [\"walk_step=1\", \"foo=2\"]\n", {"foo", "run.toml"});
}

TEST(Configuration, ValuesThatAreNotThereOrTooManyAreRefused) {
    expect_configuration_refused("depth = [1, 2]\n", {"depth"});
    expect_configuration_refused("hit = \"\"\n", {"hit"});
    expect_configuration_refused("depth\n", {"run.toml:1"});
    expect_configuration_refused("= 5\n", {"run.toml"});
    expect_configuration_refused("depth = 5 6\n", {"run.toml:1"});
}

TEST(Configuration, AFolderIsNoConfiguration) {
    const Workshop workshop;
    expect_refused(workshop, workshop.render(own_scene("cornell.nff"), {"--cells", "4x4", "--config", "."}),
                   ".: ");
}

TEST(Configuration, GarbageIsNeverPrintedRaw) {
    const Workshop workshop;
    for (const std::string& text : {std::string("\0\1\2\3 = 5\n", 9), std::string("\x1b[31mred\x1b[0m = 1\n"),
                                    std::string("\xff\xfe\x80 = 1\n"), std::string(3000, 'a') + " = 1\n"}) {
        workshop.write("run.toml", text);
        const Finished finished =
            workshop.render(own_scene("cornell.nff"), {"--cells", "4x4", "--config", "run.toml"});
        expect_refused(workshop, finished, "run.toml");
        EXPECT_LT(finished.err.size(), 400u);
        for (const char c : finished.err) {
            if (c != '\n' && (c < ' ' || c > '~')) {
                ADD_FAILURE() << "byte " << int(static_cast<unsigned char>(c)) << " in the message";
                break;
            }
        }
    }
}

}  // namespace
}  // namespace raycell::system_test
