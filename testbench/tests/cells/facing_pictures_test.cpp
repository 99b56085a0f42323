// The timed machine, too, shows what faces the viewer, at every word length.
#include "../facing_quad.hpp"
#include "elaboration.hpp"

namespace raycell {
namespace {

class FacingPicture : public ::testing::TestWithParam<int> {};

TEST_P(FacingPicture, IsTheSameTimedAndUntimedAndShowsTheQuad) {
    expect_first_elaboration();
    const int word_bits = GetParam();
    property::Random random(std::uint64_t(1000 + word_bits));
    const facing::Quad quad(random);
    PictureSettings settings;
    settings.width = 21;
    settings.height = 17;
    settings.exterior = ExteriorMode::none;
    settings.hit = HitTest(word_bits % 5);
    settings.numbers.word_bits = word_bits;
    const Frame frame = place_frame(quad.scene, settings);
    const CellScene scene = place_scene(quad.scene, frame, settings);
    const Picture golden = UntimedMachine(scene, settings, nullptr).render();
    Machine timed("machine", scene, settings, MachineSettings(), nullptr);
    const RunResult result = timed.run();
    EXPECT_EQ(name_of(result.verdict), std::string("completed"));
    EXPECT_EQ(image_hash(result.picture), image_hash(golden));
    int seen = 0;
    for (int y = 0; y < settings.height; ++y) {
        for (int x = 0; x < settings.width; ++x) {
            const double depth = facing::depth_inside(quad, frame, x, y);
            if (std::abs(depth) < 2) continue;
            seen += depth > 0;
            EXPECT_EQ(result.picture.at(x, y).polygon == no_polygon, depth < 0) << x << ", " << y;
        }
    }
    EXPECT_GT(seen, 0);
}

INSTANTIATE_TEST_SUITE_P(WordBits, FacingPicture, ::testing::Range(8, 33));

}  // namespace
}  // namespace raycell
