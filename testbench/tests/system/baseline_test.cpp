// Small reference pictures, compared within a tolerance, show unintended changes.
#include "program.hpp"

namespace raycell::system_test {
namespace {

struct Baseline {
    const char* name;
    const char* scene;
    Words words;
};
void PrintTo(const Baseline& baseline, std::ostream* out) { *out << baseline.name; }

class Picture : public ::testing::TestWithParam<Baseline> {};

TEST_P(Picture, LooksAsItsBaselineDoes) {
    const Baseline& baseline = GetParam();
    const fs::path kept =
        fs::path(RAYCELL_SOURCE_DIR) / "testbench" / "baselines" / (baseline.name + std::string(".png"));
    const Workshop workshop;
    const Words words = joined({"--cells", "64x64"}, baseline.words);
    workshop.report(own_scene(baseline.scene), words);
    const Finished finished =
        workshop.run({"compare", workshop.result("a.png").string(), kept.string(), "--psnr", "45"});
    std::string renew = "raycell render scenes/" + std::string(baseline.scene) + " -o /tmp/new";
    for (const std::string& word : words) renew += " " + word;
    EXPECT_EQ(finished.exit_code, 0)
        << finished.out << finished.err
        << "If the change is meant, look at the new picture and renew the baseline:\n"
        << "  " << renew << " && cp /tmp/new.png testbench/baselines/" << baseline.name << ".png";
}

INSTANTIATE_TEST_SUITE_P(
    Of, Picture,
    ::testing::Values(
        Baseline{"still_life", "still_life.nff", {"--arithmetic", "exact"}},
        Baseline{"cornell", "cornell.nff", {"--arithmetic", "exact"}},
        Baseline{"facing_mirrors", "facing_mirrors.nff", {"--arithmetic", "exact"}},
        Baseline{"still_life_loaded", "still_life.nff", {"--stage", "load", "--arithmetic", "exact"}},
        Baseline{"still_life_20_bits", "still_life.nff", {"--word-bits", "20"}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace raycell::system_test
