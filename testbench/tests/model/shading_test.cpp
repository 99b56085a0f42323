// Whitted's model: directions and sums, checked against formulas in another form.
#include "model/shading/shading.hpp"

#include "shapes.hpp"

namespace raycell {
namespace {

using property::Random;

TEST(Shading, NormalsTurnTowardsTheRayAndVanishingOnesFallBack) {
    for (const std::uint64_t seed : property::seeds(1, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 way = hand_made::random_direction(random.engine());
        const dvec3 normal = hand_made::random_direction(random.engine());
        const ShadePoint point = shade_point(dvec3(0), way, random.uniform(0.1, 5) * normal, normal);
        EXPECT_LE(glm::dot(point.normal, way), 0);
        EXPECT_NEAR(glm::length(point.normal), 1, 1e-12);
        EXPECT_EQ(point.entering, glm::dot(normal, way) < 0);
        EXPECT_LT(glm::length(point.normal - (point.entering ? normal : -normal)), 1e-12);
        const ShadePoint vanished = shade_point(dvec3(0), way, 1e-9 * normal, normal);
        EXPECT_LT(glm::length(vanished.normal - point.normal), 1e-12);
    }
}

TEST(Shading, MirrorsByTheLawOfReflection) {
    for (const std::uint64_t seed : property::seeds(500, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 way = hand_made::random_direction(random.engine());
        const dvec3 normal = hand_made::random_direction(random.engine());
        const ShadePoint point = shade_point(dvec3(0), way, normal, normal);
        const dvec3 out = reflect_direction(point);
        EXPECT_NEAR(glm::length(out), 1, 1e-12);
        EXPECT_NEAR(glm::dot(out, point.normal), -glm::dot(way, point.normal), 1e-12);
        EXPECT_LT(glm::length(glm::cross(out - way, point.normal)),
                  1e-12);  // only the component along the normal changes
    }
}

TEST(Shading, RefractsBySnellsLawBothWaysOrReflectsTotally) {
    int total = 0;
    for (const std::uint64_t seed : property::seeds(1000, 1000)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const dvec3 way = hand_made::random_direction(random.engine());
        const dvec3 normal = hand_made::random_direction(random.engine());
        const double ior = random.uniform(0.4, 2.5);
        const ShadePoint point = shade_point(dvec3(0), way, normal, normal);
        const double sine_in = glm::length(glm::cross(way, point.normal));
        const double sine_out = sine_in * (point.entering ? 1 / ior : ior);
        dvec3 out;
        const bool passes = refract_direction(point, ior, out);
        EXPECT_EQ(passes, sine_out <= 1);
        if (!passes) {
            ++total;
            continue;
        }
        EXPECT_NEAR(glm::length(out), 1, 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(out, point.normal)), sine_out, 1e-9);
        EXPECT_LE(glm::dot(out, point.normal), 1e-12);                       // on the other side
        EXPECT_NEAR(glm::dot(glm::cross(way, point.normal), out), 0, 1e-9);  // in the plane of incidence
        if (std::abs(sine_out) < 0.999) {                                    // the reverse path is the same
            const ShadePoint back = shade_point(dvec3(0), -out, normal, normal);
            dvec3 again;
            ASSERT_TRUE(refract_direction(back, ior, again));
            EXPECT_LT(glm::length(again + way), 1e-6);
        }
    }
    if (property::seeds(0, 2).size() > 1) {
        EXPECT_GT(total, 50);
    }
}

Material shiny() {
    Material material;
    material.colour = {0.2, 0.5, 1};
    material.diffuse = 0.7;
    material.specular = 0.4;
    material.shine = 13;
    return material;
}

TEST(Shading, AddsAmbientDiffuseAndHighlightOfEveryLitSource) {
    for (const std::uint64_t seed : property::seeds(3000, 300)) {
        SCOPED_TRACE(property::rerun(seed));
        Random random(seed);
        const Material m = shiny();
        const dvec3 way = hand_made::random_direction(random.engine());
        const dvec3 normal = hand_made::random_direction(random.engine());
        const ShadePoint point = shade_point(dvec3(1, 2, 3), way, normal, normal);
        std::vector<Source> sources;
        for (int i = 0; i < 5; ++i) {
            sources.push_back({hand_made::random_point(random.engine(), -9, 9),
                               hand_made::random_point(random.engine(), 0, 1)});
        }
        const std::uint64_t lit = std::uint64_t(random.whole(0, 31));
        dvec3 expected = 0.1 * m.diffuse * m.colour;
        for (std::size_t s = 0; s < sources.size(); ++s) {
            const dvec3 light = glm::normalize(sources[s].position - point.position);
            const double cosine = glm::dot(light, point.normal);
            if (!(lit >> s & 1) || cosine <= 0) continue;
            const double along = std::max(glm::dot(glm::reflect(way, point.normal), light), 0.0);
            expected += sources[s].intensity *
                        (m.diffuse * cosine * m.colour + dvec3(m.specular * std::pow(along, m.shine)));
        }
        const dvec3 got = local_intensity(point, m, sources.data(), sources.size(), lit);
        EXPECT_LT(glm::length(got - expected), 1e-9);
    }
}

TEST(Shading, ADirectionalSourceShinesEverywhereTheSameWay) {
    Source sun;
    sun.kind = SourceKind::directional;
    sun.axis = glm::normalize(dvec3(1, 2, -3));
    for (const dvec3 place : {dvec3(0), dvec3(100, -5, 7)}) {
        const ShadePoint point = shade_point(place, {0, 0, 1}, {0, 0, -1}, {0, 0, -1});
        const SourceView view = view_source(point, sun);
        EXPECT_EQ(view.direction, sun.axis);
        EXPECT_EQ(view.distance, std::numeric_limits<double>::infinity());
        EXPECT_DOUBLE_EQ(view.cosine, 3 / std::sqrt(14.0));
        EXPECT_TRUE(view.faces());
    }
}

TEST(Shading, ASpotFallsOffWithAPowerOfTheCosineAndEndsAtItsConesEdge) {
    Material m = shiny();
    const ShadePoint point = shade_point(dvec3(0), {0, 0, 1}, {0, 0, -1}, {0, 0, -1});
    for (double degrees = 0; degrees < 90; degrees += 5) {
        const double radians = degrees * 3.14159265358979 / 180;
        Source spot{{0, 0, -5}, dvec3(1)};
        const dvec3 as_point = local_intensity(point, m, &spot, 1, 1) - 0.1 * m.diffuse * m.colour;
        spot.kind = SourceKind::spot;
        spot.axis = {std::sin(radians), 0, -std::cos(radians)};
        spot.cut_off = std::cos(32 * 3.14159265358979 / 180);
        spot.falloff = 3;
        const SourceView view = view_source(point, spot);
        EXPECT_EQ(view.faces(), degrees < 32) << degrees;
        const double share = degrees < 32 ? std::pow(std::cos(radians), 3) : 0;
        EXPECT_NEAR(view.emission, share, 1e-12);
        const dvec3 got = local_intensity(point, m, &spot, 1, 1) - 0.1 * m.diffuse * m.colour;
        EXPECT_LT(glm::length(got - share * as_point), 1e-12) << degrees;
    }
}

TEST(Shading, BothSidesOfASurfaceLookTheSame) {
    const Material m = shiny();
    const Source source{{0, 0, -5}, dvec3(1)};
    const dvec3 way = glm::normalize(dvec3(0.3, 0.1, 1));
    const ShadePoint front = shade_point(dvec3(0), way, {0, 0, -1}, {0, 0, -1});
    const ShadePoint back = shade_point(dvec3(0), way, {0, 0, 1}, {0, 0, 1});
    EXPECT_EQ(local_intensity(front, m, &source, 1, 1), local_intensity(back, m, &source, 1, 1));
    // A source behind the surface does not light it.
    const ShadePoint other = shade_point(dvec3(0), -way, {0, 0, 1}, {0, 0, 1});
    EXPECT_EQ(local_intensity(other, m, &source, 1, 1), 0.1 * m.diffuse * m.colour);
}

TEST(Shading, ASourceOnTheSurfaceItselfLightsNothing) {
    const Source source{{1, 1, 1}, dvec3(1)};
    const ShadePoint point = shade_point({1, 1, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1});
    const SourceView view = view_source(point, source);
    EXPECT_FALSE(view.faces());
    EXPECT_EQ(local_intensity(point, shiny(), &source, 1, 1), 0.1 * shiny().diffuse * shiny().colour);
}

TEST(Shading, CombinesWithTheSharesOfMirrorAndTransmission) {
    Material m = shiny();
    m.transmit = 0.3;
    const dvec3 local(0.1), mirrored(0.5), through(0.25);
    EXPECT_LT(
        glm::length(combine_intensity(local, m, mirrored, through) - dvec3(0.1 + 0.4 * 0.5 + 0.3 * 0.25)),
        1e-15);
    m.mirror = false;  // an OBJ material with a highlight only
    EXPECT_LT(glm::length(combine_intensity(local, m, mirrored, through) - dvec3(0.1 + 0.3 * 0.25)), 1e-15);
}

TEST(Shading, ARayThatIsJustBentAlongTheSurfaceIsNotReflectedTotally) {
    ShadePoint point;
    point.direction = {1, 0, 0};
    point.normal = {0, 0, -1};
    dvec3 bent(0);
    EXPECT_TRUE(refract_direction(point, 1, bent));
    EXPECT_EQ(bent, dvec3(1, 0, 0));
    EXPECT_EQ(transmit_direction(point, 1), dvec3(1, 0, 0));
}

/// Straight through a thin medium, in the shortest words: 64 saturates, and what is left of the bent way is
/// 0.
TEST(Shading, ARayOfWhichShortWordsLeaveNothingIsReflected) {
    NumberSettings numbers;
    numbers.word_bits = 8;
    const Arithmetic arithmetic(numbers, {128, 128, 200, 0.2});
    ShadePoint point;
    point.direction = {0.984375, 0, 0};
    point.normal = {-1, 0, 0};
    point.entering = true;
    dvec3 bent(0);
    EXPECT_FALSE(refract_direction(point, 0.046875, bent, arithmetic));
    EXPECT_EQ(transmit_direction(point, 0.046875, arithmetic), reflect_direction(point, arithmetic));
}

TEST(Costs, OfSchlicksPowerHoldAReciprocalByItsOwnMethod) {
    const CostTable costs;
    for (const Iteration method : {Iteration::newton, Iteration::table, Iteration::rounded}) {
        OperatorSettings operators;
        operators.power = PowerMethod::schlick;
        operators.reciprocal = method;
        EXPECT_EQ(costs.power(operators), costs.power_schlick + costs.reciprocal(operators));
    }
}

}  // namespace
}  // namespace raycell
