// The graph of which buffer waits for which, over rays that walk as in the model, in the model's buffer
// classes. Without a ring in this graph, pure forwarding can't lock (cells/deadlock/deadlock.md, step 1).
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "../property.hpp"
#include "model/machine/message.hpp"

namespace raycell {
namespace {

/// A buffer: x and y of its cell, the direction in which it is entered, and its class.
using Buffer = std::tuple<int, int, Side, int>;
using Waits = std::map<Buffer, std::set<Buffer>>;

constexpr int width = 4;
constexpr int height = 3;

bool inside(int x, int y) { return x >= 0 && x < width && y >= 0 && y < height; }

/// Walks a random ray from its first cell to the border and adds its waits. From a random hop on, the ray may
/// count as outside the cube.
void walk(Waits& waits, const BufferClasses& classes, const Arithmetic& arithmetic,
          property::Random& random) {
    Ray ray;
    ray.position = {random.uniform(0, 1), random.uniform(0, 1), 0};
    dvec3 way{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (random.chance(0.2)) way.x = 0;
    if (random.chance(0.2)) way.y = 0;
    if (random.chance(0.1)) way.x *= 1e-9;
    if (way == dvec3(0)) way.z = 1;
    const dvec3 unit = glm::normalize(way);
    set_direction(ray, arithmetic.exact() ? unit : arithmetic.normalise(way), arithmetic);
    int x = random.whole(0, width - 1);
    int y = random.whole(0, height - 1);
    const int outside_from = random.whole(0, 5);
    std::optional<Buffer> stands;
    for (int hop = 0; inside(x, y); ++hop) {
        ASSERT_LT(hop, width + height) << "a ray crosses each column and each row once";
        const bool axial = ray.inverse_x == 0 && ray.inverse_y == 0;
        ray.outside = axial || hop >= outside_from;
        const Crossing crossing =
            ray.outside ? border_crossing(ray, arithmetic) : next_crossing(ray, arithmetic);
        const bool horizontal = crossing.side == Side::east || crossing.side == Side::west;
        const int index = classes.ray(ray);
        ASSERT_TRUE(classes.used(index, horizontal, crossing.side)) << "a link without a buffer for this ray";
        cross(ray, crossing, arithmetic);
        x += step_x(crossing.side);
        y += step_y(crossing.side);
        const Buffer next{x, y, crossing.side, index};  // over the border: a buffer of the exterior
        if (stands) waits[*stands].insert(next);
        stands = next;
    }
}

/// Removes buffers that wait for nothing until none is left, or only rings and what waits for them.
bool has_ring(Waits waits) {
    for (bool removed = true; removed;) {
        removed = false;
        for (auto at = waits.begin(); at != waits.end();) {
            const bool ends = std::none_of(at->second.begin(), at->second.end(),
                                           [&](const Buffer& to) { return waits.count(to) > 0; });
            removed = removed || ends;
            at = ends ? waits.erase(at) : std::next(at);
        }
    }
    return !waits.empty();
}

Waits of_rays(Networks networks) {
    const BufferClasses classes = buffer_classes(networks);
    NumberSettings words;
    words.word_bits = 12;
    const Arithmetic fixed(words, {width, height, 8, 1});
    Waits waits;
    for (const std::uint64_t seed : property::seeds(1, 20)) {
        SCOPED_TRACE(property::rerun(seed));
        property::Random random(seed);
        for (int i = 0; i < 500; ++i) walk(waits, classes, i % 2 ? fixed : exact_arithmetic(), random);
    }
    return waits;
}

TEST(BufferOrder, OfForwardedRaysHasNoRingWithHalvesAndQuadrants) {
    for (const Networks networks : {Networks::half, Networks::quadrant}) {
        const Waits waits = of_rays(networks);
        EXPECT_FALSE(has_ring(waits)) << int(networks);
        if (!std::getenv("RAYCELL_TEST_SEED")) {
            EXPECT_GT(waits.size(), 40u) << "most buffers were passed";
        }
    }
}

TEST(BufferOrder, OfForwardedRaysHasARingWhereTheyShareOneBuffer) {
    for (const Networks networks : {Networks::shared, Networks::split}) {
        EXPECT_TRUE(has_ring(of_rays(networks))) << int(networks);
    }
}

TEST(BufferOrder, OfAnswersThatGoAlongXAndThenAlongYHasNoRing) {
    Waits waits;
    // From every cell, and from outside over the border, to every cell.
    for (int from_x = -1; from_x <= width; ++from_x) {
        for (int from_y = -1; from_y <= height; ++from_y) {
            const bool corner = (from_x < 0 || from_x == width) && (from_y < 0 || from_y == height);
            if (corner) continue;
            for (int home = 0; home < width * height; ++home) {
                int x = from_x;
                int y = from_y;
                std::optional<Buffer> stands;
                while (x != home % width || y != home / width) {
                    Side side = x != home % width ? (home % width > x ? Side::east : Side::west)
                                                  : (home / width > y ? Side::south : Side::north);
                    if (y < 0) side = Side::south;  // into the array first
                    if (y >= height) side = Side::north;
                    x += step_x(side);
                    y += step_y(side);
                    const Buffer next{x, y, side, 0};
                    // Cell and side distinguish a border link's buffer from that of a link between cells.
                    if (stands) waits[*stands].insert(next);
                    stands = next;
                }
            }
        }
    }
    EXPECT_FALSE(has_ring(waits));
}

}  // namespace
}  // namespace raycell
