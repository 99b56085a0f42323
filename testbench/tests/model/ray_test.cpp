// The walk from cell to cell, and the fields of the messages on the links.
#include "model/tracing/ray.hpp"

#include <set>

#include "model/machine/message.hpp"
#include "shapes.hpp"
#include "walker.hpp"

namespace raycell {
namespace {

using property::Random;

const Arithmetic& exact = exact_arithmetic();

struct Step {
    int x;
    int y;
};
std::vector<Step> cells_of(Ray ray, int x, int y, int hops) {
    std::vector<Step> cells{{x, y}};
    for (int i = 0; i < hops; ++i) {
        const Crossing crossing = next_crossing(ray, exact);
        x += step_x(crossing.side);
        y += step_y(crossing.side);
        cross(ray, crossing, exact);
        cells.push_back({x, y});
    }
    return cells;
}

TEST(Walk, VisitsEveryCellThatTheRayIsInAndNoOther) {
    for (const std::uint64_t seed : property::seeds(1, 400)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 origin{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 10)};
        const dvec3 direction = shapes::sloped_direction(random);
        Ray ray;
        ray.position = origin;
        set_direction(ray, direction, exact);
        if (direction.x == 0 && direction.y == 0) continue;
        const auto visited = cells_of(ray, 0, 0, 60);
        // Brute force: the cells between consecutive crossings of all grid lines.
        std::vector<double> cuts{0};
        for (int line = -70; line <= 70; ++line) {
            if (direction.x != 0) cuts.push_back((line - origin.x) / direction.x);
            if (direction.y != 0) cuts.push_back((line - origin.y) / direction.y);
        }
        std::sort(cuts.begin(), cuts.end());
        std::vector<Step> expected;
        for (std::size_t i = 0; i + 1 < cuts.size() && expected.size() < visited.size(); ++i) {
            if (cuts[i] < 0 || cuts[i + 1] - cuts[i] < 1e-9) continue;
            const dvec3 p = origin + 0.5 * (cuts[i] + cuts[i + 1]) * direction;
            expected.push_back({int(std::floor(p.x)), int(std::floor(p.y))});
        }
        std::set<std::pair<int, int>> in_walk;
        for (const Step& step : visited) in_walk.insert({step.x, step.y});
        for (std::size_t i = 0; i < expected.size() / 2; ++i) {
            EXPECT_TRUE(in_walk.count({expected[i].x, expected[i].y}))
                << expected[i].x << ", " << expected[i].y;
        }
        // The walk may only add a cell where the ray passes a corner: one step away from the brute force.
        std::size_t next = 0;
        for (std::size_t i = 0; i < visited.size() && next < expected.size(); ++i) {
            if (visited[i].x == expected[next].x && visited[i].y == expected[next].y) {
                ++next;
            } else {
                ASSERT_GT(i, 0u);
                EXPECT_EQ(
                    std::abs(visited[i].x - visited[i - 1].x) + std::abs(visited[i].y - visited[i - 1].y), 1);
            }
        }
        EXPECT_GE(next + 3, expected.size());
    }
}

TEST(Walk, PositionPlusCellIsOriginPlusDistanceAfterAThousandHops) {
    for (const std::uint64_t seed : property::seeds(1000, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 origin{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 10)};
        const dvec3 direction = shapes::sloped_direction(random);
        Ray ray;
        ray.position = origin;
        ray.reach = 1e9;
        set_direction(ray, direction, exact);
        if (direction.x == 0 && direction.y == 0) continue;
        int x = 0;
        int y = 0;
        double t = 0;
        for (int hop = 0; hop < 1000; ++hop) {
            const Crossing crossing = next_crossing(ray, exact);
            ASSERT_GE(crossing.t, 0);
            x += step_x(crossing.side);
            y += step_y(crossing.side);
            t += crossing.t;
            cross(ray, crossing, exact);
            ASSERT_GE(ray.position.x, 0);
            ASSERT_LE(ray.position.x, 1);
            ASSERT_GE(ray.position.y, 0);
            ASSERT_LE(ray.position.y, 1);
            ASSERT_FALSE(ray.fresh);
        }
        const dvec3 expected = origin + t * direction;
        EXPECT_NEAR(x + ray.position.x, expected.x, 1e-9);
        EXPECT_NEAR(y + ray.position.y, expected.y, 1e-9);
        EXPECT_NEAR(ray.position.z, expected.z, 1e-9 * std::max(1.0, std::abs(expected.z)));
        EXPECT_NEAR(1e9 - ray.reach, t, 1e-4);
    }
}

TEST(Walk, AnAxialRayNeverCrosses) {
    Ray ray;
    ray.position = {0.5, 0.5, 3};
    for (const dvec3 direction : {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(1e-13, -1e-13, 1)}) {
        set_direction(ray, direction, exact);
        EXPECT_EQ(next_crossing(ray, exact).t, std::numeric_limits<double>::infinity());
        EXPECT_EQ(border_crossing(ray, exact).side, Side::east);
        const dvec3 before = ray.position;
        cross(ray, border_crossing(ray, exact), exact);
        EXPECT_EQ(ray.position, before);
        EXPECT_EQ(ray.direction.x, 0);
    }
}

TEST(Walk, ThroughCornersItTakesXFirstAndLosesNoGround) {
    for (const double sx : {1.0, -1.0}) {
        for (const double sy : {1.0, -1.0}) {
            Ray ray;
            ray.position = {0.5, 0.5, 0};
            set_direction(ray, glm::normalize(dvec3(sx, sy, 0.5)), exact);
            const auto cells = cells_of(ray, 0, 0, 20);
            for (int i = 0; i <= 20; ++i) {
                EXPECT_EQ(cells[std::size_t(i)].x, int(sx) * ((i + 1) / 2));
                EXPECT_EQ(cells[std::size_t(i)].y, int(sy) * (i / 2));
            }
        }
    }
}

TEST(Messages, TakeTheWholeCyclesThatTheirBitsNeed) {
    EXPECT_EQ(link_cycles(1, 20), 1);
    EXPECT_EQ(link_cycles(20, 20), 1);
    EXPECT_EQ(link_cycles(21, 20), 2);
    EXPECT_EQ(link_cycles(219, 20), 11);
    EXPECT_EQ(link_cycles(219, 1), 219);
    EXPECT_EQ(link_cycles(219, 1000), 1);
}

TEST(Messages, HaveTheBitsOfTheirFields) {
    PictureSettings picture;
    MachineSettings machine;
    picture.width = 128;
    picture.height = 64;
    machine.ray_store = 8;
    const ArrayExtent extent{128, 64, 256, 0.25};
    const Formats formats(20, Rounding::nearest, extent);
    const MessageBits bits = message_bits(picture, machine, formats);
    const int address = 7 + 6 + 3 + 1 + 6;      // home, slot, child
    const int place = 20 + 20 + (8 + 20);       // z has 8 bits more, for depths to 256
    const int way = 3 * 20 + 2 * (20 + 6);      // direction; reciprocals with exponents
    const int weight = 20;                      // a shadow ray has its reach instead
    const int word = 36;                        // of loading
    const int plane = 3 * word + 2 + 1 + word;  // slopes and offset, axis and sign; slack
    const int edges = 4 * 3 * word + 3;         // up to four, and how many
    const int normals = 3 * 3 * word;
    EXPECT_EQ(bits.ray, 3 + place + way + weight + 20 + 6 + address + 3);
    EXPECT_EQ(bits.shadow_ray, bits.ray - 6) << "without its generation";
    EXPECT_EQ(bits.verdict, 3 + address);
    EXPECT_EQ(bits.intensity, 3 + 3 * 20 + address);
    EXPECT_EQ(bits.longest_span(), 3 + 20 + 2 * 7 + plane + normals + edges);
    EXPECT_EQ(bits.longest_trapeze(), 3 + 2 * 6 + 2 * 7 + edges);
    EXPECT_EQ(bits.surface, 3 + 20 + 6 + plane + normals);
    EXPECT_EQ(bits.polygon, 3 + 20 + plane + normals + 16) << "and how many vertices follow";
    EXPECT_EQ(bits.vertex, 3 * word);
    EXPECT_EQ(bits.features, 3 + 6 * 12 + 12 + 16 + 1);
    const int levels = 16 + 16 + 6;  // how many, and how high
    EXPECT_EQ(bits.viewer, 3 + 3 * 32 + 6 + 1 + 6 + 3 * 20 + levels + 7);
    EXPECT_EQ(bits.setup(2) - bits.setup(0), 2 * (3 * 32 + 6 + 3 * 20));
    // Each grows with the word length. A ray holds three words of place, three of direction, two of
    // reciprocals and one of weight.
    const MessageBits wider = message_bits(picture, machine, Formats(24, Rounding::nearest, extent));
    EXPECT_EQ(wider.ray - bits.ray, 9 * 4);
    EXPECT_EQ(wider.verdict, bits.verdict);
    EXPECT_EQ(wider.longest_span() - bits.longest_span(), (4 + 9 + 12) * 4);
    const int slopes = 2 * 20 + 2 + 1;
    // Rung `depth` needs neither offset nor edges in a span; with one normal a voxel it is the paper's span.
    picture.hit = HitTest::depth;
    EXPECT_EQ(message_bits(picture, machine, formats).longest_span(),
              3 + 20 + 2 * 7 + 2 * word + slopes + normals);
    picture.normals = Normals::voxel;
    EXPECT_EQ(message_bits(picture, machine, formats).longest_span(), 3 + 20 + 2 * 7 + 8 * word + slopes);
    picture.hit = HitTest::edge;
    picture.normals = Normals::linear;
    // Verdicts on voxels name one of 1024 voxels instead of a slot.
    picture.shadows = Shadows::memo;
    EXPECT_EQ(message_bits(picture, machine, formats).verdict, bits.verdict + 10 - 4);
    // Gouraud: a span also carries an intensity and its increment, three words each.
    picture.display = Display::gouraud;
    EXPECT_EQ(message_bits(picture, machine, formats).longest_span(), bits.longest_span() + 6 * word);
}

TEST(Messages, AnAnswerGoesWhereItsRayCameFrom) {
    Ray ray;
    ray.id = 77;
    ray.slot = 5;
    ray.home_x = 12;
    ray.home_y = 34;
    ray.child = 1;
    ray.kind = RayKind::refracted;
    const Answer answer = answer_to(ray, Answer::Kind::postponed);
    EXPECT_EQ(answer.id, 77u);
    EXPECT_EQ(answer.slot, 5u);
    EXPECT_EQ(answer.home_x, 12);
    EXPECT_EQ(answer.home_y, 34);
    EXPECT_EQ(answer.child, 1);
    EXPECT_EQ(answer.ray_kind, RayKind::refracted);
    EXPECT_EQ(answer.kind, Answer::Kind::postponed);
}

/// The ray classes that can occur on a link in this direction, found by sending random rays over it.
std::set<int> classes_seen(Networks networks, Side side) {
    const BufferClasses classes = buffer_classes(networks);
    std::set<int> seen;
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        Ray ray;
        ray.position = {random.uniform(0, 1), random.uniform(0, 1), 1};
        set_direction(ray, shapes::sloped_direction(random), exact);
        const bool axial = ray.inverse_x == 0 && ray.inverse_y == 0;
        const Crossing crossing = axial ? border_crossing(ray, exact) : next_crossing(ray, exact);
        if (crossing.side == side) seen.insert(classes.ray(ray));
    }
    return seen;
}

TEST(BufferClasses, ALinkHasABufferForJustTheRaysThatCrossIt) {
    for (const Networks networks : {Networks::shared, Networks::split, Networks::half, Networks::quadrant}) {
        const BufferClasses classes = buffer_classes(networks);
        for (const Side side : {Side::east, Side::south, Side::west, Side::north}) {
            const bool horizontal = side == Side::east || side == Side::west;
            const auto seen = classes_seen(networks, side);
            const std::size_t expected = networks == Networks::half       ? (horizontal ? 1 : 2)
                                         : networks == Networks::quadrant ? 2
                                                                          : 1;
            EXPECT_EQ(seen.size(), expected);
            for (int index = 0; index < classes.count; ++index) {
                const bool answers = index == classes.answer && networks != Networks::shared;
                EXPECT_EQ(classes.used(index, horizontal, side), answers || seen.count(index) == 1)
                    << "networks " << int(networks) << ", class " << index << ", side " << int(side);
            }
        }
    }
}

TEST(BufferClasses, ARayWithoutXGoesWithThePositiveHalf) {
    Ray ray;
    set_direction(ray, {0, -1, 0}, exact);
    EXPECT_EQ(buffer_classes(Networks::half).ray(ray), 0);
    EXPECT_EQ(buffer_classes(Networks::quadrant).ray(ray), 2);
    set_direction(ray, {-1e-13, 1, 0}, exact);  // too small to cross a cell: does not count as western
    EXPECT_EQ(buffer_classes(Networks::half).ray(ray), 0);
}

}  // namespace
}  // namespace raycell
