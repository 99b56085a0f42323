// The part of a polygon that a cell finds from a plane and edges, beside the polygon itself cut to the cell.
#include "model/loading/part.hpp"

#include "model/loading/loading.hpp"
#include "model/loading/loading_words.hpp"
#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

constexpr double depth = 24;
const ArrayExtent extent{8, 8, depth, 0.25};

/// A triangle that is no needle, anywhere in the cube, in the arithmetic's words.
std::optional<Polygon> any_triangle(Random& random, const Arithmetic& arithmetic) {
    const auto corner = [&] {
        return dvec3(random.uniform(0, 8), random.uniform(0, 8), random.uniform(0, depth));
    };
    const std::vector<dvec3> corners = {corner(), corner(), corner()};
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 a = corners[(i + 1) % 3] - corners[i];
        const dvec3 b = corners[(i + 2) % 3] - corners[i];
        if (glm::length(glm::cross(a, b)) < 0.1 * glm::length(a) * glm::length(b)) return std::nullopt;
    }
    Polygon polygon = make_polygon(0, 0, corners);
    if (!clip_to_cube(polygon, {{0, 0, 0}, {8, 8, depth}}, arithmetic)) return std::nullopt;
    return polygon;
}

void expect_part_of(const Trapeze& trapeze, int row, const Arithmetic& arithmetic, int& parts) {
    auto span = cut_span(trapeze, row, depth, HitTest::edge, arithmetic);
    if (!span) return;
    const double room = arithmetic.exact() ? 1e-6 : 2 * arithmetic.formats().unit.step();
    for (;; advance(*span, arithmetic)) {
        std::vector<dvec3> truth(trapeze.corners.begin(), trapeze.corners.begin() + trapeze.corner_count);
        truth = clip_to_box(truth, {dvec3(span->x, row, 0), dvec3(span->x + 1, row + 1, depth)});
        const Box column{-span->slack, dvec3(1, 1, depth) + span->slack};
        const Part part =
            part_in({span->plane, span->drop, span->edges.data(), span->edge_count}, column, arithmetic);
        if (!truth.empty() && shapes::area_of(truth) > 1e-9) {
            ASSERT_FALSE(part.empty());
            ++parts;
            double area = 0;
            dvec3 low(1e300);
            dvec3 high(-1e300);
            for (dvec3& p : truth) {
                p -= dvec3(span->x, row, 0);
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            const auto flat = shapes::projected(truth, span->drop);
            for (std::size_t i = 0; i < flat.size(); ++i) {
                const dvec2& a = flat[i];
                const dvec2& b = flat[(i + 1) % flat.size()];
                area += 0.5 * (a.x * b.y - a.y * b.x);
            }
            // Never smaller than the polygon. How much larger in a corner hangs on the corner's angle; the
            // area tells.
            const double bit = arithmetic.exact() ? 1e-9 : 8 * arithmetic.formats().loading.step();
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(part.low[axis] - span->slack[axis], low[axis] + bit);
                EXPECT_GE(part.high[axis] + span->slack[axis], high[axis] - bit);
            }
            EXPECT_NEAR(part.area, std::abs(area), room * 4 * (1 + depth));
            EXPECT_LE(part.corners, 10);
            const dvec2 middle = project(part.middle, span->drop);
            for (int i = 0; i < span->edge_count; ++i)
                EXPECT_GE(span->edges[std::size_t(i)].at(middle), -room);
            EXPECT_NEAR(glm::dot(span->plane.n, part.middle), span->plane.c, bit);
        }
        if (testing::Test::HasFailure() || span->x == span->last) return;
    }
}

TEST(Parts, AreThePolygonCutToTheCellAtEveryWordLength) {
    int parts = 0;
    for (const std::uint64_t seed : property::seeds(1, 1500)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        NumberSettings numbers;
        numbers.arithmetic = random.chance(0.2) ? Numbers::exact : Numbers::fixed;
        numbers.word_bits = random.whole(12, 32);
        numbers.rounding = random.chance(0.5) ? Rounding::nearest : Rounding::truncate;
        const Arithmetic arithmetic(numbers, extent);
        const auto polygon = any_triangle(random, arithmetic);
        if (!polygon) continue;
        for (const Trapeze& trapeze : precompute(*polygon, arithmetic, 8, 8)) {
            for (int row = 0; row < 8; ++row) expect_part_of(trapeze, row, arithmetic, parts);
        }
        if (testing::Test::HasFailure()) return;
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(parts, 5000);
    }
}

TEST(LoadingWords, CutASideWhereTheExactQuotientCutOffSays) {
    for (const std::uint64_t seed : property::seeds(1, 4000)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        NumberSettings numbers;
        numbers.word_bits = random.whole(8, 32);
        const Arithmetic arithmetic(numbers, extent);
        const LoadingWords words(arithmetic);
        const int bits = arithmetic.formats().loading.bits() - 1;
        const auto any = [&] {
            return std::int64_t(random.uniform(0, 1) * std::ldexp(1.0, random.whole(1, bits)));
        };
        const std::int64_t from = any() - any();
        const std::int64_t to = any() - any();
        const std::int64_t inside = any() + 1;
        const std::int64_t outside = -any() - 1;
        const __int128 quotient = (__int128(inside) << unsigned(bits)) / (inside - outside);
        const __int128 product = (to - from) * quotient;
        const __int128 one = __int128(1) << unsigned(bits);
        const __int128 cut = product >= 0 ? product / one : -((-product + one - 1) / one);
        ASSERT_EQ(words.between(from, to, inside, outside), from + std::int64_t(cut));
    }
}

}  // namespace
}  // namespace raycell
