// Several primary rays a pixel: one picture from both engines, whatever is under way at once.
#include "elaboration.hpp"
#include "model/geometry/sampling.hpp"
#include "model/picture/compare.hpp"

namespace raycell {
namespace {

PictureSettings sampled(int samples) {
    PictureSettings settings;
    settings.width = 8;
    settings.height = 6;
    settings.samples = samples;
    return settings;
}

/// Runs the machine with some numbers of own rays; all must give the untimed picture. Returns that.
Picture expect_one_picture(const PictureSettings& settings, const char* scene) {
    const auto placed = place_own_scene(scene, settings);
    const Picture untimed = UntimedMachine(placed->scene, settings, placed->exterior.get()).render();
    std::vector<std::unique_ptr<Machine>> machines;
    for (const int own_rays : {1, 3, 8}) {
        MachineSettings machine;
        machine.own_rays = own_rays;
        machine.wire_check = settings.numbers.arithmetic == Numbers::fixed;
        machines.push_back(std::make_unique<Machine>(("own_" + std::to_string(own_rays)).c_str(),
                                                     placed->scene, settings, machine,
                                                     placed->exterior.get()));
    }
    for (const auto& machine : machines) {
        const RunResult result = machine->run();
        EXPECT_EQ(name_of(result.verdict), std::string("completed"));
        EXPECT_EQ(image_hash(result.picture), image_hash(untimed));
        EXPECT_EQ(result.counters.pixels_done, untimed.pixels.size());
        std::uint64_t sent = 0;
        for (std::size_t i = 0; i < untimed.pixels.size(); ++i) {
            EXPECT_EQ(result.picture.pixels[i].samples, untimed.pixels[i].samples) << i;
            sent += untimed.pixels[i].samples;
        }
        EXPECT_EQ(result.counters.rays.primary, sent);
        EXPECT_GT(machine->longest_tree().cycles, 0u);
        EXPECT_EQ(machine->environment().meters.counters.pixels_done, untimed.pixels.size() + 16)
            << "the pixels traced once more are complete again, with all their samples";
    }
    return untimed;
}

TEST(TimedSamples, GiveTheUntimedPicture) {
    expect_first_elaboration();
    PictureSettings settings = sampled(6);
    settings.filter = PixelFilter::tent;
    expect_one_picture(settings, "cornell");
}

TEST(TimedSamples, OfBlocksThatStopWhereTheFirstFourAgreeGiveTheUntimedPicture) {
    expect_first_elaboration();
    PictureSettings settings = sampled(9);
    settings.pixels_wide = 16;
    settings.pixels_high = 6;
    settings.sample_until = 0.03;
    const Picture picture = expect_one_picture(settings, "still_life");
    int stopped = 0, went_on = 0;
    for (const Pixel& pixel : picture.pixels) {
        ASSERT_TRUE(pixel.samples == 4 || pixel.samples == 9);
        ++(pixel.samples == 4 ? stopped : went_on);
    }
    std::cout << stopped << " pixels stopped, " << went_on << " went on\n";
    EXPECT_GT(stopped, 5);
    EXPECT_GT(went_on, 5);
}

TEST(TimedSamples, InExactArithmeticAreMetByTheTruthAtTheSamePlaces) {
    expect_first_elaboration();
    PictureSettings settings = sampled(5);
    settings.numbers.arithmetic = Numbers::exact;
    settings.normal_offset = 0;
    const Picture picture = expect_one_picture(settings, "facing_mirrors");
    const auto placed = place_own_scene("facing_mirrors", settings);
    TruthSettings tree{settings.max_depth, settings.min_weight, false, TruthOf::polygons,
                       placed->truth.get()};
    tree.samples = tree.first_of = 5;
    const Picture truth = TruthRenderer(placed->scene, tree).render();
    EXPECT_GT(compare(picture, truth).psnr_db, 150);
    EXPECT_EQ(compare(picture, truth).wrong_hit_percent, 0);
}

TEST(Samples, OfThePixelsCentreAreThePictureWithoutSamples) {
    PictureSettings settings = sampled(1);
    settings.filter = PixelFilter::tent;
    settings.sample_until = 0;
    const auto placed = place_own_scene("cornell", settings);
    const auto hash = [&](const PictureSettings& s) {
        return image_hash(UntimedMachine(placed->scene, s, placed->exterior.get()).render());
    };
    EXPECT_EQ(hash(settings), hash(PictureSettings(sampled(1))));
}

TEST(Samples, ComeNearerToTheConvergedTruthTheMoreThereAre) {
    double before = 0;
    for (const int samples : {1, 4, 16}) {
        PictureSettings settings = sampled(samples);
        settings.width = settings.height = 24;
        const auto placed = place_own_scene("still_life", settings);
        PictureSettings many = settings;
        many.samples = 16;
        const Picture converged = TruthRenderer(placed->scene, truth_settings(many, 256)).render();
        const double db =
            compare(UntimedMachine(placed->scene, settings, placed->exterior.get()).render(), converged)
                .psnr_db;
        std::cout << samples << " samples: " << db << " dB\n";
        EXPECT_GT(db, before + 3);
        before = db;
    }
}

TEST(Samples, OfATentAreMetByTheTruthOfATentAndNotOfABox) {
    PictureSettings settings = sampled(16);
    settings.width = settings.height = 24;
    settings.filter = PixelFilter::tent;
    const auto placed = place_own_scene("still_life", settings);
    const Picture picture = UntimedMachine(placed->scene, settings, placed->exterior.get()).render();
    const auto psnr = [&](PixelFilter filter) {
        PictureSettings other = settings;
        other.filter = filter;
        const double db =
            compare(picture, TruthRenderer(placed->scene, truth_settings(other, 256)).render()).psnr_db;
        std::cout << (filter == PixelFilter::tent ? "tent" : "box") << ": " << db << " dB\n";
        return db;
    };
    EXPECT_GT(psnr(PixelFilter::tent), psnr(PixelFilter::box) + 3);
}

TEST(Samples, OfALoadedSceneAreAddedUpToo) {
    expect_first_elaboration();
    PictureSettings settings = sampled(4);
    settings.stage = RunStage::load;
    const auto placed = place_own_scene("still_life", settings);
    Machine machine("load", placed->scene, settings, {}, nullptr);
    const Picture picture = machine.run().picture;
    EXPECT_EQ(image_hash(picture), image_hash(UntimedMachine(placed->scene, settings, nullptr).render()));
    EXPECT_EQ(picture.pixels.front().samples, 4u);
}

}  // namespace
}  // namespace raycell
