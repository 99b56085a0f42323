#include "testbench/stability/bench.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace raycell::stability {

dvec3 Random::direction() {
    std::normal_distribution<double> normal;
    dvec3 way(0);
    while (!(glm::length(way) > 1e-6)) way = {normal(engine_), normal(engine_), normal(engine_)};
    return glm::normalize(way);
}

NumberSettings exact_numbers() {
    NumberSettings numbers;
    numbers.arithmetic = Numbers::exact;
    return numbers;
}

NumberSettings fixed_numbers(int word_bits) {
    NumberSettings numbers;
    numbers.arithmetic = Numbers::fixed;
    numbers.word_bits = word_bits;
    return numbers;
}

std::vector<NumberSettings> exact_and(const std::vector<int>& word_bits) {
    std::vector<NumberSettings> all = {exact_numbers()};
    for (const int bits : word_bits) all.push_back(fixed_numbers(bits));
    return all;
}

std::string name_of(const NumberSettings& numbers) {
    return numbers.arithmetic == Numbers::exact ? "exact" : "fixed " + std::to_string(numbers.word_bits);
}

std::string name_of(HitTest rung) {
    switch (rung) {
        case HitTest::depth:
            return "depth";
        case HitTest::interval:
            return "interval";
        case HitTest::plane:
            return "plane";
        case HitTest::mask:
            return "mask";
        case HitTest::edge:
            break;
    }
    return "edge";
}

double angle_between(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

CellScene empty_scene(int width, int height, double depth, int levels) {
    CellScene scene;
    scene.frame.width = width;
    scene.frame.height = height;
    scene.frame.depth = depth;
    scene.frame.depth_levels = levels;
    scene.frame.viewer_at_infinity = true;
    Material matt;
    matt.colour = dvec3(1);
    scene.objects.push_back(matt);
    return scene;
}

std::uint32_t add_object(CellScene& scene, const Material& material) {
    scene.objects.push_back(material);
    return std::uint32_t(scene.objects.size() - 1);
}

void add_polygon(CellScene& scene, std::uint32_t object, std::vector<dvec3> vertices) {
    scene.polygons.push_back(make_polygon(std::uint32_t(scene.polygons.size()), object, std::move(vertices)));
}

void add_cross_section(CellScene& scene, std::uint32_t object, const dvec3& point, const dvec3& normal) {
    const dvec3 aside = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = glm::normalize(glm::cross(normal, aside));
    const dvec3 v = glm::cross(glm::normalize(normal), u);
    const Box cube = scene.frame.cube();
    const double far = 2 * glm::length(cube.high);
    std::vector<dvec3> outline = {point - far * u - far * v, point + far * u - far * v,
                                  point + far * u + far * v, point - far * u + far * v};
    add_polygon(scene, object, clip_to_box(std::move(outline), cube));
}

void add_ball(CellScene& scene, std::uint32_t object, const dvec3& centre, double radius, int slices,
              int stacks) {
    const auto way = [&](int stack, int slice) {
        if (stack == 0) return dvec3(0, -1, 0);
        if (stack == stacks) return dvec3(0, 1, 0);
        const double polar = pi * stack / stacks;
        const double turn = 2 * pi * (slice % slices) / slices;
        return dvec3(std::sin(polar) * std::cos(turn), -std::cos(polar), std::sin(polar) * std::sin(turn));
    };
    const auto triangle = [&](const dvec3& a, const dvec3& b, const dvec3& c) {
        scene.polygons.push_back(
            make_triangle(std::uint32_t(scene.polygons.size()), object,
                          {centre + radius * a, centre + radius * b, centre + radius * c}, {a, b, c}));
    };
    for (int i = 0; i < stacks; ++i) {
        for (int j = 0; j < slices; ++j) {
            if (i + 1 < stacks) triangle(way(i, j), way(i + 1, j), way(i + 1, j + 1));
            if (i > 0) triangle(way(i, j), way(i + 1, j + 1), way(i, j + 1));
        }
    }
}

PictureSettings settings_for(const CellScene& scene, const NumberSettings& numbers, HitTest rung) {
    PictureSettings settings;
    settings.width = scene.frame.width;
    settings.height = scene.frame.height;
    settings.depth_levels = scene.frame.depth_levels;
    settings.viewer = scene.frame.viewer_at_infinity ? ViewerMode::infinity : ViewerMode::scene;
    settings.hit = rung;
    settings.exterior = ExteriorMode::none;
    settings.numbers = numbers;
    return settings;
}

Placed start_ray(const Loaded& loaded, const dvec3& origin, const dvec3& direction) {
    const Frame& frame = loaded.scene.frame;
    const Arithmetic& arithmetic = loaded.arithmetic();
    const Formats& formats = arithmetic.formats();
    Placed placed;
    placed.x = std::clamp(int(std::floor(origin.x)), 0, frame.width - 1);
    placed.y = std::clamp(int(std::floor(origin.y)), 0, frame.height - 1);
    placed.ray.position = {arithmetic.hold(formats.unit, origin.x - placed.x),
                           arithmetic.hold(formats.unit, origin.y - placed.y),
                           arithmetic.hold(formats.depth, origin.z)};
    placed.ray.fresh = false;
    set_direction(placed.ray, arithmetic.normalise(direction), arithmetic);
    return placed;
}

std::optional<Landing> walk(const Loaded& loaded, Placed placed) {
    const Frame& frame = loaded.scene.frame;
    Ray& ray = placed.ray;
    double travelled = 0;
    for (int hops = 0; hops <= 2 * (frame.width + frame.height) + 4; ++hops) {
        const CellStore& store = loaded.cell(placed.x, placed.y);
        const Visit visit = visit_cell(store, ray, loaded.context());
        if (visit.event == Visit::Event::hit) {
            const dvec3 corner{double(placed.x), double(placed.y), 0};
            return Landing{ray,
                           visit.hit,
                           store.voxels[visit.hit.voxel].polygon,
                           placed.x,
                           placed.y,
                           travelled + visit.hit.t,
                           corner + point_at(ray, visit.hit.t, loaded.arithmetic())};
        }
        if (visit.event != Visit::Event::forward) return std::nullopt;
        travelled += visit.crossing.t;
        placed.x += step_x(visit.crossing.side);
        placed.y += step_y(visit.crossing.side);
        if (placed.x < 0 || placed.y < 0 || placed.x >= frame.width || placed.y >= frame.height) {
            return std::nullopt;
        }
        cross(ray, visit.crossing, loaded.arithmetic());
    }
    throw std::logic_error("a ray never leaves the array");
}

}  // namespace raycell::stability
