// Synthetic traffic: draws depend on the tree alone and have the probabilities that were set.
#include "model/tracing/traffic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../property.hpp"
#include "model/machine/feed_bits.hpp"
#include "model/machine/storage_bits.hpp"
#include "model/machine/untimed.hpp"

namespace raycell {
namespace {

/// An array with traffic in it, built as both machines build it.
struct Loaded {
    Loaded(const TrafficSettings& asked, int width, int height, int generations)
        : settings(asked),
          traffic(asked),
          picture(traffic_picture(width, height, generations)),
          scene(traffic_scene(picture, asked)),
          context(scene, picture, &traffic) {}
    CellStore store(int x, int y) const {
        CellStore one;
        SyntheticTraffic::furnish(one, scene.frame, x, y);
        return one;
    }
    TrafficSettings settings;
    SyntheticTraffic traffic;
    PictureSettings picture;
    CellScene scene;
    Context context;
};

TrafficSettings drawn_settings(property::Random& random) {
    TrafficSettings settings;
    settings.hit_probability = random.uniform(0.02, 0.6);
    settings.reflected = random.chance(0.2) ? 1 : random.uniform(0, 1);
    settings.refracted = random.chance(0.5) ? 0 : random.uniform(0, 0.7);
    settings.sources = random.chance(0.5) ? 0 : random.whole(1, 3);
    settings.directions = Directions(random.whole(0, 3));
    settings.turn_back = random.uniform(0, 1);
    settings.seed = std::uint64_t(random.whole(0, 1 << 30));
    return settings;
}

TEST(Traffic, IsTheSameWhicheverCellIsAskedFirst) {
    for (const std::uint64_t seed : property::seeds(1, 20)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        const Loaded array(drawn_settings(random), 9, 7, 3);
        std::vector<std::pair<int, int>> order;
        for (int y = 0; y < 7; ++y) {
            for (int x = 0; x < 9; ++x) order.emplace_back(x, y);
        }
        const auto visits = [&] {
            std::vector<Visit> all(order.size());
            for (const auto& [x, y] : order) {
                Ray ray = primary_ray(array.context, 4, 3);
                ray.fresh = false;
                all[std::size_t(y * 9 + x)] = visit_cell(array.store(x, y), ray, array.context);
            }
            return all;
        };
        const std::vector<Visit> before = visits();
        std::shuffle(order.begin(), order.end(), random.engine());
        const std::vector<Visit> after = visits();
        for (std::size_t i = 0; i < before.size(); ++i) {
            ASSERT_EQ(before[i].event, after[i].event) << "cell " << i;
            ASSERT_EQ(before[i].hit.t, after[i].hit.t) << "cell " << i;
        }
    }
}

TEST(Traffic, HitsAsOftenAsWasAskedFor) {
    for (const double probability : {0.0, 0.05, 0.3, 1.0}) {
        TrafficSettings settings;
        settings.hit_probability = probability;
        settings.directions = Directions::isotropic;
        const Loaded array(settings, 64, 64, 3);
        int hits = 0;
        int visits = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                Ray ray = primary_ray(array.context, x, y);
                ASSERT_EQ(visit_cell(array.store(x, y), ray, array.context).event, Visit::Event::forward)
                    << "a ray is not tested where it starts";
                ray.fresh = false;
                for (int cell = 0; cell < 10; ++cell, ++visits) {
                    hits += visit_cell(array.store(cell, y), ray, array.context).event == Visit::Event::hit;
                }
            }
        }
        const double deviation = std::sqrt(visits * probability * (1 - probability));
        EXPECT_NEAR(hits, visits * probability, 4 * deviation) << "probability " << probability;
    }
}

TEST(Traffic, BranchesAsOftenAsWasAskedForAndNotBelowTheLastGeneration) {
    TrafficSettings settings;
    settings.reflected = 0.8;
    settings.refracted = 0.25;
    const Loaded array(settings, 64, 64, 2);
    int reflects = 0;
    int refracts = 0;
    int both = 0;
    const int hits = 64 * 64;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            Ray ray = primary_ray(array.context, x, y);
            const CellStore store = array.store(x, y);
            const HitSetup setup = set_up_hit(array.context, store, ray, CellHit{}, x, y);
            reflects += setup.reflects;
            refracts += setup.refracts;
            both += setup.reflects && setup.refracts;
            ray.generation = 2;
            const HitSetup last = set_up_hit(array.context, store, ray, CellHit{}, x, y);
            ASSERT_FALSE(last.reflects || last.refracts);
        }
    }
    const auto deviation = [](double share) { return 4 * std::sqrt(hits * share * (1 - share)); };
    EXPECT_NEAR(reflects, hits * 0.8, deviation(0.8));
    EXPECT_NEAR(refracts, hits * 0.25, deviation(0.25));
    EXPECT_NEAR(both, hits * 0.2, deviation(0.2)) << "drawn apart";
}

TEST(Traffic, GoesWhereItsDistributionSays) {
    for (const Directions directions : {Directions::isotropic, Directions::axial, Directions::diagonal}) {
        TrafficSettings settings;
        settings.directions = directions;
        const Loaded array(settings, 64, 64, 2);
        int octants[8] = {};
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const dvec3 d = primary_ray(array.context, x, y).direction;
                ASSERT_NEAR(glm::length(d), 1, 1e-12);
                ASSERT_EQ(d.z, 0) << "it would leave through the front or the back";
                const double turns = std::atan2(d.y, d.x) / (2 * std::acos(-1.0)) + 1;
                ++octants[int(std::lround(turns * 8)) % 8];
                const double off = std::abs(turns * 8 - std::lround(turns * 8));
                if (directions != Directions::isotropic) {
                    ASSERT_LT(off, 1e-9);
                }
            }
        }
        const double expected = 4096.0 / (directions == Directions::isotropic ? 8 : 4);
        for (int octant = 0; octant < 8; ++octant) {
            const bool axial = octant % 2 == 0;
            const bool none =
                (directions == Directions::axial && !axial) || (directions == Directions::diagonal && axial);
            EXPECT_NEAR(octants[octant], none ? 0 : expected, none ? 0 : 4 * std::sqrt(expected))
                << "octant " << octant << " of distribution " << int(directions);
        }
    }
}

TEST(Traffic, TurnsBackAsOftenAsWasAskedForAndThenHitsTheCellThatTheParentCameFrom) {
    TrafficSettings settings;
    settings.directions = Directions::back;
    settings.turn_back = 0.3;
    settings.hit_probability = 0.1;
    const Loaded array(settings, 48, 48, 3);
    const Arithmetic& arithmetic = array.context.arithmetic;
    int children = 0;
    int turned = 0;
    for (int home_y = 0; home_y < 48; ++home_y) {
        for (int home_x = 0; home_x < 48; ++home_x) {
            Ray ray = primary_ray(array.context, home_x, home_y);
            const auto walk = [&](int& x, int& y) {
                for (;;) {
                    const Visit visit = visit_cell(array.store(x, y), ray, array.context);
                    if (visit.event == Visit::Event::hit) return std::optional<CellHit>(visit.hit);
                    x += step_x(visit.crossing.side);
                    y += step_y(visit.crossing.side);
                    if (x < 0 || y < 0 || x >= 48 || y >= 48) return std::optional<CellHit>();
                    cross(ray, visit.crossing, arithmetic);
                }
            };
            int x = home_x;
            int y = home_y;
            const auto hit = walk(x, y);
            if (!hit) continue;
            const CellStore store = array.store(x, y);
            const HitSetup setup = set_up_hit(array.context, store, ray, *hit, x, y);
            const dvec3 parent = ray.direction;
            ray = reflected_ray(array.context, store, ray, *hit, setup, x, y);
            ++children;
            if (ray.leaves == no_polygon) continue;
            ++turned;
            EXPECT_EQ(ray.direction, -parent);
            ASSERT_TRUE(walk(x, y)) << "it missed its aim";
            EXPECT_EQ(x, home_x);
            EXPECT_EQ(y, home_y);
        }
    }
    ASSERT_GT(children, 1000);
    EXPECT_NEAR(turned, children * 0.3, 4 * std::sqrt(children * 0.3 * 0.7));
}

TEST(Traffic, NamesChildrenUnlikeTheirParentsAndEachOther) {
    TrafficSettings settings;
    settings.refracted = 1;
    settings.sources = 2;
    const Loaded array(settings, 32, 32, 3);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const Ray parent = primary_ray(array.context, x, y);
            const CellStore store = array.store(x, y);
            const HitSetup setup = set_up_hit(array.context, store, parent, CellHit{}, x, y);
            std::vector<std::uint64_t> ids = {parent.id};
            ids.push_back(reflected_ray(array.context, store, parent, CellHit{}, setup, x, y).id);
            ids.push_back(refracted_ray(array.context, store, parent, CellHit{}, setup, x, y).id);
            ids.push_back(shadow_ray(array.context, store, parent, CellHit{}, setup, 0, x, y).id);
            ids.push_back(shadow_ray(array.context, store, parent, CellHit{}, setup, 1, x, y).id);
            for (const std::uint64_t id : ids)
                EXPECT_EQ(pixel_of(id), pixel_of(ids[0])) << "the pixel's number";
            std::sort(ids.begin(), ids.end());
            EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
        }
    }
}

TEST(Traffic, OfTheUntimedMachineIsCountedAsItWasAskedFor) {
    TrafficSettings settings;
    settings.hit_probability = 1;  // every ray hits in the next cell, unless it leaves
    settings.sources = 2;
    settings.refracted = 1;
    settings.directions = Directions::isotropic;
    const Loaded array(settings, 20, 20, 2);
    UntimedMachine machine(array.scene, array.picture, nullptr, &array.traffic);
    machine.render();
    const RayCounts& rays = machine.rays();
    EXPECT_EQ(rays.primary, 400u);
    EXPECT_EQ(rays.reflected, rays.refracted) << "both at every hit above the last generation";
    const std::uint64_t hits_with_children = rays.reflected;
    EXPECT_GT(hits_with_children, 300u);
    EXPECT_LE(hits_with_children, 400u + 2 * 400u);
    EXPECT_EQ(rays.shadow % 2, 0u);
    EXPECT_GT(rays.shadow, 2 * hits_with_children);
    EXPECT_EQ(rays.exterior, 0u);
    EXPECT_GT(rays.lost, 0u);
}

TEST(Traffic, OfAnotherSeedIsAnotherPictureAndOfTheSameTheSame) {
    TrafficSettings settings;
    const auto picture_of = [](const TrafficSettings& s) {
        const Loaded array(s, 16, 16, 3);
        return image_hash(UntimedMachine(array.scene, array.picture, nullptr, &array.traffic).render());
    };
    const auto first = picture_of(settings);
    EXPECT_EQ(picture_of(settings), first);
    settings.seed = 2;
    EXPECT_NE(picture_of(settings), first);
}

TEST(Traffic, RefusesSharesThatAreNone) {
    for (double TrafficSettings::*share : {&TrafficSettings::hit_probability, &TrafficSettings::reflected,
                                           &TrafficSettings::refracted, &TrafficSettings::turn_back}) {
        for (const double value : {-0.1, 1.1, std::nan("")}) {
            TrafficSettings settings;
            settings.*share = value;
            EXPECT_THROW(SyntheticTraffic{settings}, std::invalid_argument);
        }
    }
    TrafficSettings settings;
    settings.sources = 65;
    EXPECT_THROW(SyntheticTraffic{settings}, std::invalid_argument);
}

TEST(Traffic, RefusesSettingsThatItHasNothingFor) {
    const Loaded array(TrafficSettings{}, 4, 4, 2);
    PictureSettings words = array.picture;
    words.numbers.arithmetic = Numbers::fixed;
    EXPECT_THROW(Context(array.scene, words, &array.traffic), std::invalid_argument);
    PictureSettings precast = array.picture;
    precast.shadows = Shadows::precast;
    EXPECT_THROW(Context(array.scene, precast, &array.traffic), std::invalid_argument);
    PictureSettings exterior = array.picture;
    exterior.exterior = ExteriorMode::host;
    EXPECT_THROW(Context(array.scene, exterior, &array.traffic), std::invalid_argument);
}

// ---- storage

struct Sized {
    PictureSettings picture;
    MachineSettings machine;
    Formats formats{20, Rounding::nearest, ArrayExtent{128, 128, 256, 0.25}};
};

TEST(StorageBits, OfBuffersFollowTheNetworks) {
    Sized sized;
    const MessageBits messages = message_bits(sized.picture, sized.machine, sized.formats);
    const auto bits = [&](Networks networks, int depth) {
        sized.machine.networks = networks;
        sized.machine.buffer_depth = depth;
        return storage_bits(sized.picture, sized.machine, sized.formats, 1);
    };
    // Ray buffers: one per link; with `half`, two on vertical links; with `quadrant`, two on every link.
    EXPECT_EQ(bits(Networks::shared, 1).ray_buffers, 4 * messages.ray);
    EXPECT_EQ(bits(Networks::shared, 1).answer_buffers, 0);
    EXPECT_EQ(bits(Networks::split, 1).ray_buffers, 4 * messages.ray);
    EXPECT_EQ(bits(Networks::half, 1).ray_buffers, 6 * messages.ray);
    EXPECT_EQ(bits(Networks::quadrant, 1).ray_buffers, 8 * messages.ray);
    for (const Networks networks : {Networks::split, Networks::half, Networks::quadrant}) {
        EXPECT_EQ(bits(networks, 1).answer_buffers, 4 * messages.intensity);
        EXPECT_EQ(bits(networks, 3).buffers(), 3 * bits(networks, 1).buffers());
    }
}

TEST(FeedBits, AreThoseOfLanesAndRows) {
    Sized sized;  // 128x128 cells, buffers of 1, links of 20 bits
    sized.machine.buffer_depth = 1;
    sized.machine.feed_lanes = 2;
    sized.machine.feed_bits = 100;
    const int polygon = 3 + 20 + 147 + 324 + 16 + 4 * 108;  // id, plane and slack, normals, count, corners
    const int trapeze = 501;                                // a surface; a trapeze has 466
    const FeedBits bits = feed_bits(sized.picture, sized.machine, sized.formats);
    EXPECT_EQ(bits.buffers, 2 * 4 * (polygon + trapeze) + 126 * trapeze + 128 * 943);
    EXPECT_EQ(bits.registers, 2 * (2 * polygon + trapeze) + 128 * (501 + trapeze + 943));
    EXPECT_EQ(bits.wires, (2 * 2 + 126) * 100 + 128 * 20);
    EXPECT_EQ(bits.total(), bits.buffers + bits.registers);
}

TEST(FeedBits, OfMoreLanesThanRowsAreThoseOfALaneForEachRow) {
    Sized sized;
    sized.picture.width = sized.picture.height = 8;
    const auto bits = [&](int lanes) {
        sized.machine.feed_lanes = lanes;
        return feed_bits(sized.picture, sized.machine, sized.formats);
    };
    EXPECT_EQ(bits(4096).total(), bits(8).total());
    EXPECT_EQ(bits(4096).wires, 8 * 2 * sized.machine.feed_bits + 8 * 20);
    EXPECT_GT(bits(8).total(), bits(7).total());
}

TEST(StorageBits, OfASlotAreThoseOfTheTable) {
    const Sized
        sized;  // docs/reference/cell.md: 128x128 cells, M = 8, 20-bit words, a cube up to 256 cells deep
    const SlotBits bits = slot_bits(sized.picture, sized.machine, sized.formats, 1);
    EXPECT_EQ(bits.control, 3 + 3 + 10);
    EXPECT_EQ(bits.ray, 24 + 2 + 6 + 20 + 60);
    EXPECT_EQ(bits.hit, 68 + 60 + 1);
    EXPECT_EQ(bits.children, 2 * (60 + 2 + 60 + 3 + 14));
    EXPECT_EQ(bits.sources, 3);
    EXPECT_EQ(bits.out, 256 + 48 + 17);
}

TEST(StorageBits, OfRegistersAreThoseOfTheTable) {
    Sized sized;  // as above, half networks, buffers of 2, links of 20 bits, two units of a kind
    const RegisterBits bits = register_bits(sized.picture, sized.machine, sized.formats, 1);
    EXPECT_EQ(bits.own_ray, 256 + 2 + 17);
    EXPECT_EQ(bits.decisions, 7 * 48);
    EXPECT_EQ(bits.ages, (6 + 4 + 2) * 17);
    EXPECT_EQ(bits.credits, 10 * 2 + 8 * 4);
    EXPECT_EQ(bits.outputs, 4 * 256);
    EXPECT_EQ(bits.traversal, 2 * (40 + 31 + 56 + 28 + 8 + 68 + 40));
    EXPECT_EQ(bits.shading, 12 + 4 * 60 + 20 + 40 + 112 + 129 + 10 + 87);
    EXPECT_EQ(bits.loading, 2 * ((943 - 3) + (104 - 3)));
    EXPECT_EQ(bits.latches, 217 + 162);
}

TEST(StorageBits, OfRegistersFollowTheMachine) {
    Sized sized;
    const auto bits = [&] { return register_bits(sized.picture, sized.machine, sized.formats, 1); };
    const RegisterBits plain = bits();
    sized.machine.buffer_depth = 4;  // a credit counter per output and class grows from 2 to 3 bits
    EXPECT_EQ(bits().credits, plain.credits + 10);
    sized.machine = {};
    sized.machine.networks = Networks::quadrant;  // eight ray inputs, not six
    EXPECT_EQ(bits().decisions - plain.decisions, 2 * 48);
    EXPECT_EQ(bits().ages - plain.ages, 2 * 17);
    sized.machine = {};
    sized.machine.start_within = 1 << 14;  // fits the back-off's register
    EXPECT_EQ(bits().own_ray, plain.own_ray);
    sized.machine.start_within = 1 << 20;
    EXPECT_EQ(bits().own_ray, plain.own_ray + 6);
    sized.machine = {};
    sized.machine.recovery = Recovery::none;  // nothing is sent again
    EXPECT_EQ(bits().own_ray, plain.own_ray - 17);
    sized.machine = {};
    sized.machine.link_bits = 256;  // a message takes one cycle: one bit says that the wires are busy
    EXPECT_EQ(bits().credits, plain.credits - 8 * 3);
    sized.machine = {};
    sized.picture.shadows = Shadows::precast;  // the own ray's registers then also hold its source and voxel
    EXPECT_GT(bits().own_ray, plain.own_ray);
}

TEST(StorageBits, OfABlockOfPixelsAreItsIntensitiesItsOwnRaysAndCounters) {
    Sized sized;
    const auto bits = [&] { return register_bits(sized.picture, sized.machine, sized.formats, 1); };
    const RegisterBits plain = bits();
    EXPECT_EQ(plain.pixels, 0);
    sized.machine.own_rays = 4;
    EXPECT_EQ(bits().total(), plain.total()) << "a cell has no more own rays than pixels";
    sized.picture.pixels_wide = 8 * sized.picture.width;
    sized.picture.pixels_high = 4 * sized.picture.height;
    // Per own ray 2 bits, attempts and back-off, a pixel of 32; the ray in the making; 33 values of a counter
    // of pixels, whose turn it is.
    const MessageBits messages = message_bits(sized.picture, sized.machine, sized.formats);
    EXPECT_EQ(messages.ray, 256) << "M + 4 values need the same 4 bits";
    EXPECT_EQ(bits().own_ray, 256 + 4 * (2 + 17 + 5) + 256 + 6 + 2);
    EXPECT_EQ(bits().pixels, 32 * 3 * 20);
    EXPECT_EQ(bits().total() - plain.total(), bits().own_ray - plain.own_ray + bits().pixels);
    sized.machine.own_rays = 9;
    EXPECT_EQ(message_bits(sized.picture, sized.machine, sized.formats).ray, 257) << "17 values need 5";
}

TEST(StorageBits, OfTheRayStoreGrowWithItsSlotsAndShrinkWithoutRecovery) {
    Sized sized;
    const auto store = [&](int slots) {
        sized.machine.ray_store = slots;
        return storage_bits(sized.picture, sized.machine, sized.formats, 2).ray_store;
    };
    const std::int64_t one = store(1);
    EXPECT_EQ(one, slot_bits(sized.picture, sized.machine, sized.formats, 2).total());
    std::int64_t before = 0;
    for (const int slots : {1, 2, 3, 8, 16, 100}) {
        EXPECT_GT(store(slots), before);
        before = store(slots);
    }
    sized.machine.recovery = Recovery::none;
    EXPECT_LT(store(100), before) << "nothing is sent again";
}

}  // namespace
}  // namespace raycell
