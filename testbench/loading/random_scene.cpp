#include "testbench/loading/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/machine/stall.hpp"

namespace raycell::loading {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Random numbers by SplitMix64's finaliser: the same with every standard library.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : seed_(seed) {}
    double uniform(double low, double high) {
        const double share = (double(mix_bits(seed_, count_++) >> 11) + 0.5) * 0x1p-53;
        return low + share * (high - low);
    }

  private:
    std::uint64_t seed_;
    std::uint64_t count_ = 0;
};

double draw_size(const RandomPolygons& r, Draws& draws) {
    if (r.sizes == Sizes::uniform) return draws.uniform(r.least_size, r.most_size);
    return std::exp(draws.uniform(std::log(r.least_size), std::log(r.most_size)));
}

dvec3 draw_normal(const RandomPolygons& r, Draws& draws) {
    const double turn = draws.uniform(0, 2 * pi);
    double cosine = 0;
    switch (r.slopes) {
        case Slopes::isotropic:
            cosine = draws.uniform(-1, 1);
            break;
        case Slopes::angle:
            cosine = std::cos(draws.uniform(0, std::atan(r.most_slope)));
            break;
        case Slopes::slope:
            cosine = 1 / std::hypot(1, draws.uniform(0, r.most_slope));
            break;
    }
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

/// A convex polygon with an area: its corners lie on a circle, one in the first three quarters of each of
/// `sides` equal arcs.
Polygon draw_polygon(const RandomPolygons& r, const Box& cube, std::uint32_t id, std::uint32_t object,
                     Draws& draws) {
    const double radius = draw_size(r, draws) / 2;
    const dvec3 normal = draw_normal(r, draws);
    dvec3 centre;
    for (int axis = 0; axis < 3; ++axis) centre[axis] = draws.uniform(cube.low[axis], cube.high[axis]);
    const dvec3 off = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(normal, off));
    const dvec3 v = glm::cross(normal, u);
    std::vector<dvec3> corners;
    for (int i = 0; i < r.sides; ++i) {
        const double turn = 2 * pi * (i + draws.uniform(0, 0.75)) / r.sides;
        corners.push_back(centre + radius * (std::cos(turn) * u + std::sin(turn) * v));
    }
    if (r.sides > 3) return make_polygon(id, object, std::move(corners));
    std::array<dvec3, 3> normals;
    for (dvec3& n : normals) {
        dvec3 tilt;
        for (int axis = 0; axis < 3; ++axis) tilt[axis] = draws.uniform(-0.3, 0.3);
        n = glm::normalize(normal + tilt);
    }
    return make_triangle(id, object, {corners[0], corners[1], corners[2]}, normals);
}

}  // namespace

CellScene random_scene(const RandomPolygons& r, const PictureSettings& picture) {
    if (r.least_size > r.most_size) {
        throw std::invalid_argument("--least-size is above --most-size; expected it to be at most that");
    }
    CellScene scene;
    scene.frame = array_frame(picture);
    scene.frame.depth = r.depth;
    scene.frame.viewer_at_infinity = true;
    scene.sources.push_back({{0.5 * picture.width, 0, -r.depth}, dvec3(1)});
    Draws draws(r.seed);
    const int objects = std::min(r.objects, r.count);
    for (int i = 0; i < objects; ++i) {
        Material material;
        for (int channel = 0; channel < 3; ++channel) material.colour[channel] = draws.uniform(0, 1);
        scene.objects.push_back(material);
    }
    for (int i = 0; i < r.count; ++i) {
        const auto object = std::uint32_t(std::int64_t(i) * objects / r.count);
        scene.polygons.push_back(draw_polygon(r, scene.frame.cube(), std::uint32_t(i), object, draws));
    }
    return scene;
}

}  // namespace raycell::loading
