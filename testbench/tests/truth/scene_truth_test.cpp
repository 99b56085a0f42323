// The truth against a second tracer, written anew in the scene's own coordinates. They share nothing but the
// scene as it was read: no frame, no cells, no tree of boxes, no shading.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "model/picture/compare.hpp"
#include "model/truth/truth.hpp"
#include "scenes/nff_reader.hpp"

namespace raycell {
namespace {

struct Surface {
    dvec3 middle{0, 0, 0};  ///< of a sphere round the surface
    double reach = 0;       ///< its radius
    /// Distances along a ray (origin, direction). If it begins on the surface, that is not one of them.
    std::function<std::vector<double>(const dvec3&, const dvec3&, bool begins_here)> meet;
    std::function<dvec3(const dvec3&)> normal;  ///< on the front, at a point of the surface
    std::uint32_t material = 0;                 ///< index into Scene::materials
};

/// Roots of a·t² + 2·b·t + c. `zero`: 0 is one of them, and not asked for.
std::vector<double> roots(double a, double b, double c, bool zero) {
    if (zero) return {-2 * b / a};
    const double squared = b * b - a * c;
    if (!(squared >= 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(squared), b));
    return {q / a, c / q};
}

std::vector<Surface> surfaces_of(const SpherePrimitive& s, double) {
    const auto meet = [s](const dvec3& from, const dvec3& way, bool begins_here) {
        // From the ray's point nearest to the centre numbers are small and exact.
        const double ahead = begins_here ? 0 : glm::dot(s.centre - from, way);
        const dvec3 off = from + ahead * way - s.centre;
        auto found = roots(1, glm::dot(off, way), glm::dot(off, off) - s.radius * s.radius, begins_here);
        for (double& t : found) t += ahead;
        return found;
    };
    const auto normal = [s](const dvec3& at) { return (at - s.centre) / (s.inward ? -s.radius : s.radius); };
    return {{s.centre, s.radius, meet, normal}};
}

std::vector<Surface> surfaces_of(const ConePrimitive& s, double) {
    const dvec3 middle = 0.5 * (s.base + s.apex);
    const double height = glm::length(s.apex - s.base);
    const dvec3 axis = (s.apex - s.base) / height;
    const double growth = (s.apex_radius - s.base_radius) / height;
    const auto meet = [=](const dvec3& from, const dvec3& way, bool begins_here) {
        const double ahead = begins_here ? 0 : glm::dot(middle - from, way);
        const dvec3 off = from + ahead * way - s.base;
        const double level = glm::dot(off, axis);
        const double climb = glm::dot(way, axis);
        const dvec3 off_axis = off - level * axis;
        const dvec3 across = way - climb * axis;
        const double radius = s.base_radius + growth * level;
        const double widens = growth * climb;
        const double a = glm::dot(across, across) - widens * widens;
        const double b = glm::dot(off_axis, across) - widens * radius;
        std::vector<double> found;
        for (const double t : roots(a, b, glm::dot(off_axis, off_axis) - radius * radius, begins_here))
            if (level + t * climb >= 0 && level + t * climb <= height) found.push_back(t + ahead);
        return found;
    };
    const auto normal = [=](const dvec3& at) {
        const dvec3 off_axis = at - s.base - glm::dot(at - s.base, axis) * axis;
        return glm::normalize(glm::normalize(off_axis) - growth * axis) * (s.inward ? -1.0 : 1.0);
    };
    return {{middle, std::hypot(0.5 * height, std::max(s.base_radius, s.apex_radius)), meet, normal}};
}

/// Twice an outline's area, along its normal.
dvec3 area_of(const std::vector<dvec3>& outline) {
    dvec3 sum(0);
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        sum += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return sum;
}

/// Flat, or a triangle with a normal per corner. A ray that passes it by no more than `hair` meets it.
Surface facet(const PolygonPrimitive& s, double hair) {
    const std::vector<dvec3>& p = s.vertices;
    const dvec3 plane = glm::normalize(area_of(p));
    const dvec3 middle = std::accumulate(p.begin(), p.end(), dvec3(0)) / double(p.size());
    double reach = hair;
    for (const dvec3& corner : p) reach = std::max(reach, hair + glm::length(corner - middle));
    const auto meet = [=](const dvec3& from, const dvec3& way, bool begins_here) -> std::vector<double> {
        const double t = glm::dot(plane, middle - from) / glm::dot(plane, way);
        if (begins_here || !(std::abs(t) < 1e30)) return {};
        double turn = 0;  // of the way to the outline's corners: once round for a point inside
        for (std::size_t i = 0; i < s.vertices.size(); ++i) {
            const dvec3 a = s.vertices[i] - (from + t * way);
            const dvec3 b = s.vertices[(i + 1) % s.vertices.size()] - (from + t * way);
            const double share = std::clamp(glm::dot(a, a - b) / glm::dot(a - b, a - b), 0.0, 1.0);
            if (glm::length(glm::mix(a, b, share)) <= hair) return {t};
            turn += std::atan2(glm::dot(plane, glm::cross(a, b)), glm::dot(a, b));
        }
        return turn > 3 ? std::vector<double>{t} : std::vector<double>{};
    };
    const auto normal = [=](const dvec3& at) {
        if (s.normals.empty()) return plane;
        const auto share = [&](std::size_t i, std::size_t j) {
            return glm::dot(plane, glm::cross(s.vertices[i] - at, s.vertices[j] - at));
        };
        return glm::normalize(share(1, 2) * s.normals[0] + share(2, 0) * s.normals[1] +
                              share(0, 1) * s.normals[2]);
    };
    return {middle, reach, meet, normal};
}

/// With normals: cuts off the first corner that can be cut, again and again, as the project's tessellation
/// does. Over other triangles the normals would be others.
std::vector<Surface> surfaces_of(const PolygonPrimitive& shape, double hair) {
    if (shape.normals.empty()) return {facet(shape, hair)};
    const std::vector<dvec3>& p = shape.vertices;
    const dvec3 front = area_of(p);
    const auto left = [&](std::size_t a, std::size_t b, std::size_t c) {
        return glm::dot(front, glm::cross(p[b] - p[a], p[c] - p[a]));
    };
    std::vector<std::size_t> rest(p.size());
    std::iota(rest.begin(), rest.end(), std::size_t(0));
    std::vector<Surface> triangles;
    for (std::size_t k = 0; k < rest.size(); ++k) {
        const std::size_t a = rest[(k + rest.size() - 1) % rest.size()];
        const std::size_t b = rest[k];
        const std::size_t c = rest[(k + 1) % rest.size()];
        const bool blocked = std::any_of(rest.begin(), rest.end(), [&](std::size_t i) {
            return i != a && i != b && i != c && left(a, b, i) >= 0 && left(b, c, i) >= 0 &&
                   left(c, a, i) >= 0;
        });
        if (blocked || !(left(a, b, c) > 0)) continue;
        const auto& n = shape.normals;
        triangles.push_back(facet({{p[a], p[b], p[c]}, {n[a], n[b], n[c]}}, hair));
        rest.erase(rest.begin() + std::ptrdiff_t(k));
        k = std::size_t(-1);
    }
    return triangles;
}

/// Whitted's tracer, which tries every surface for every ray.
class WorldTracer {
  public:
    WorldTracer(const Scene& scene, int side) : scene_(scene), side_(side) {
        step_ = 2 * std::tan(glm::radians(scene.view->angle) / 2) / (side - 1);
        cell_ = step_ * glm::length(scene.view->at - scene.view->from);
        for (const Primitive& primitive : scene.primitives) {
            const auto all = [&](const auto& shape) { return surfaces_of(shape, 1e-7 * cell_); };
            for (Surface& surface : std::visit(all, primitive.shape)) {
                surface.material = primitive.material;
                surfaces_.push_back(surface);
            }
        }
    }

    Picture render() const {
        const View& view = *scene_.view;
        const dvec3 forward = glm::normalize(view.at - view.from);
        const dvec3 right = glm::normalize(glm::cross(forward, view.up));
        const dvec3 up = glm::cross(right, forward);
        Picture picture(side_, side_);
        for (int y = 0; y < side_; ++y) {
            for (int x = 0; x < side_; ++x) {
                const dvec2 off = step_ * (dvec2(x, y) - 0.5 * (side_ - 1));
                const dvec3 way = glm::normalize(forward + off.x * right - off.y * up);
                picture.at(x, y).colour = trace(view.from, way, nothing, 0, 1);
            }
        }
        return picture;
    }

  private:
    static constexpr std::size_t nothing = std::size_t(-1);
    struct Hit {
        double t;
        std::size_t surface;
    };

    /// Of the surfaces met at the same distance, the first in the file.
    Hit first_hit(const dvec3& from, const dvec3& way, std::size_t leaves) const {
        Hit first{std::numeric_limits<double>::infinity(), nothing};
        const double least = leaves == nothing ? 0 : 1e-7 * cell_;
        for (std::size_t i = 0; i < surfaces_.size(); ++i) {
            const dvec3 off = surfaces_[i].middle - from;
            const dvec3 aside = off - glm::dot(off, way) * way;
            if (glm::length(aside) > 1.000001 * surfaces_[i].reach) continue;
            for (const double t : surfaces_[i].meet(from, way, i == leaves))
                if (t > least && t < first.t - 1e-6 * cell_) first = {t, i};
        }
        return first;
    }

    dvec3 trace(const dvec3& from, const dvec3& way, std::size_t leaves, int generation,
                double weight) const {
        const Hit hit = first_hit(from, way, leaves);
        if (hit.surface == nothing) return scene_.background;
        const dvec3 at = from + hit.t * way;
        const Material& m = scene_.materials[surfaces_[hit.surface].material];
        const dvec3 front = surfaces_[hit.surface].normal(at);
        const bool enters = glm::dot(front, way) < 0;
        const dvec3 normal = enters ? front : -front;
        const double cosine = -glm::dot(normal, way);
        const dvec3 mirrored = glm::normalize(way + 2 * cosine * normal);
        dvec3 sum = 0.1 * m.diffuse * m.colour;
        for (const LightSource& source : scene_.sources) {
            const double distance = glm::length(source.position - at);
            const dvec3 to_source = (source.position - at) / distance;
            const double facing = glm::dot(normal, to_source);
            if (!(facing > 0) || first_hit(at, to_source, hit.surface).t <= distance - 1e-7 * cell_) continue;
            const double along = glm::dot(mirrored, to_source);
            const double highlight = along > 0 ? m.specular * std::pow(along, m.shine) : 0;
            sum += source.colour.value_or(dvec3(1 / std::sqrt(double(scene_.sources.size())))) *
                   (m.diffuse * facing * m.colour + highlight);
        }
        const auto add_ray = [&](double share, const dvec3& onward) {
            if (share > 0 && generation < 4 && weight * share >= 1.0 / 256)
                sum += share * trace(at, onward, hit.surface, generation + 1, weight * share);
        };
        if (m.mirror) add_ray(m.specular, mirrored);
        const dvec3 bent = (enters ? 1 / m.ior : m.ior) * (way + cosine * normal);
        const double rest = 1 - glm::dot(bent, bent);
        add_ray(m.transmit, rest < 0 ? mirrored : glm::normalize(bent - std::sqrt(rest) * normal));
        return sum;
    }

    const Scene& scene_;
    int side_;
    double step_;  ///< between pixels at distance 1
    double cell_;  ///< between pixels at the point looked at: about a cell's width
    std::vector<Surface> surfaces_;
};

Accuracy truth_against_tracer(const Scene& scene, TruthOf of) {
    PictureSettings settings;
    settings.width = settings.height = 40;
    const CellScene placed = place_scene(scene, place_frame(scene, settings), settings);
    const Picture truth = TruthRenderer(placed, {4, 1.0 / 256, false, of}).render();
    return compare(truth, WorldTracer(scene, settings.width).render());
}

std::filesystem::path path_of(const std::string& name) {
    const std::filesystem::path root(RAYCELL_SOURCE_DIR);
    const auto own = root / "scenes" / (name + ".nff");
    return std::filesystem::exists(own) ? own : root / ".." / "shared" / "scenes" / "spd" / (name + ".nff");
}

class SceneTruth : public ::testing::TestWithParam<std::string> {};

TEST_P(SceneTruth, IsWhatATracerInWorldCoordinatesSees) {
    if (!std::filesystem::exists(path_of(GetParam()))) GTEST_SKIP() << path_of(GetParam()) << " is missing";
    Diagnostics diagnostics;
    const Scene scene = read_nff(path_of(GetParam()), diagnostics);
    const Accuracy accuracy = truth_against_tracer(scene, TruthOf::scene);
    EXPECT_GE(accuracy.psnr_db, 100) << "a channel is off by " << accuracy.max_error;
}

INSTANTIATE_TEST_SUITE_P(Whole, SceneTruth,
                         ::testing::Values("still_life", "cornell", "facing_mirrors", "balls-s1", "balls-s2",
                                           "gears-s1", "lattice-s2", "mount-s4", "rings-s1", "teapot-s4",
                                           "tetra-s4", "tree-s3"),
                         [](const auto& about) {
                             std::string name = about.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(SceneTruthOfPolygons, IsFarFromTheTracer) {
    if (!std::filesystem::exists(path_of("balls-s1"))) GTEST_SKIP() << path_of("balls-s1") << " is missing";
    Diagnostics diagnostics;
    const Scene scene = read_nff(path_of("balls-s1"), diagnostics);
    const double psnr = truth_against_tracer(scene, TruthOf::polygons).psnr_db;
    EXPECT_GT(psnr, 30);
    EXPECT_LT(psnr, 50);
}

/// What no scene file has: glass and mirrors that are cones, surfaces turned inwards, a concave patch.
TEST(SceneTruthOfOneOfEach, IsWhatATracerInWorldCoordinatesSees) {
    Diagnostics diagnostics;
    const Scene scene = read_nff_text(
        "b .2 .3 .5 v from 1 -9 4 at 0 0 1 up 0 0 1 angle 40 hither 1 resolution 9 9 l 5 -6 9 l -6 -3 5 1 .5 "
        "0 "
        "f .8 .7 .6 .9 .1 20 0 1 p 5 -5 -4 0 5 -4 0 5 5 0 1 1 0 -5 5 0 "
        "f .9 .9 1 .1 .3 60 .8 1.5 c -2 0 0 1 -2 0 2 .4 c 0 -2 .5 .5 1.5 -2 .9 .5 s -.5 1 3 .7 s 2 -1 1 -.8 "
        "f .3 .9 .4 .3 .6 9 0 1 c 2 1 0 1.2 2 1 3 0 c -1 2 2 -.8 -2 3 3 -.3 c 3 -2 1 1 3 -1 2 1 "
        "f 1 .5 .2 .6 .2 5 .3 .7 pp 4 -3 -3 1 -.5 -.5 1 -1 -3 1 .5 -.5 1 -2.4 -2.3 1 0 0 1 -3 -1 1 -.5 .5 1 ",
        "one of each", diagnostics);
    const Accuracy accuracy = truth_against_tracer(scene, TruthOf::scene);
    EXPECT_GE(accuracy.psnr_db, 100) << "a channel is off by " << accuracy.max_error;
}

/// The exterior is handed the rest of a ray: it begins where the ray left the cube, not on what it left.
TEST(RestOfARay, MeetsTheFarSideOfTheSphereThatItIsInAndNotTheSideThatItLeft) {
    CellScene scene;
    scene.frame.width = scene.frame.height = 16;
    scene.frame.depth = 16;
    scene.objects.resize(1);
    CurvedSurface ball;
    ball.base = {8, 8, 16};
    ball.base_radius = 6;
    ball.polygons = 1;
    scene.curved.push_back(ball);
    const TruthRenderer truth(scene);
    const dvec3 border{8, 8, 20};  // the ray came in at 10 and goes out at 22
    const auto far = truth.intersect(border, {0, 0, 1}, 0, 100, -10);
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->t, 2, 1e-9);
    EXPECT_TRUE(truth.occluded(border, {0, 0, 1}, 0, 100, -10));
    EXPECT_FALSE(truth.intersect({8, 8, 21.9}, {0, 0, 1}, 0, 100, 0.05))
        << "it left a facet inside of the ball";
    EXPECT_FALSE(truth.intersect({8, 8, 30}, {0, 0, 1}, 0, 100, -8));
}

/// Polygons inside the cube and the scene outside: the truth of a machine with an exterior.
TEST(TruthBeyondTheCube, MeetsPolygonsInsideAndTheSceneOutside) {
    Diagnostics diagnostics;
    const Scene scene = read_nff_text(
        "b .2 .3 .5 v from 0 -9 0 at 0 0 0 up 0 0 1 angle 12 hither 1 resolution 9 9 l 5 -6 9 "
        "f .9 .9 1 .1 .8 60 0 1 s 0 0 0 .7 f .2 .9 .3 .8 0 9 0 1 s 2 -12 2 2 s 1 -3 -4 1.5 ",
        "a mirror and what it shows", diagnostics);
    PictureSettings settings;
    settings.width = settings.height = 48;
    settings.chord_error = 0.2;
    const CellScene placed = place_scene(scene, place_frame(scene, settings), settings);
    const TruthRenderer itself(placed);
    const TruthRenderer polygons(placed, {4, 1.0 / 256, false, TruthOf::polygons});
    const TruthRenderer both(placed, {4, 1.0 / 256, false, TruthOf::polygons, &itself});
    const Picture exact = itself.render();
    const Picture seen = both.render();
    const double mixed = compare(seen, exact).psnr_db;
    EXPECT_LT(mixed, 100) << "the mirror is made of polygons";
    EXPECT_LT(compare(seen, polygons.render()).psnr_db, 100) << "what it shows is not";
    const TruthRenderer twice(placed, {4, 1.0 / 256, false, TruthOf::scene, &itself});
    EXPECT_GE(compare(twice.render(), exact).psnr_db, 150) << "the border alone changes nothing";
}

}  // namespace
}  // namespace raycell
