// Hand-made scenes in cell coordinates, for tests.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "model/geometry/placement.hpp"

namespace raycell::hand_made {

constexpr double pi = 3.14159265358979323846;

/// An empty cube with the viewer at infinity: the ray of pixel (x, y) starts at the screen and goes along z.
inline CellScene cube(int width, int height, double depth) {
    CellScene scene;
    scene.frame.width = width;
    scene.frame.height = height;
    scene.frame.depth = depth;
    scene.frame.viewer_at_infinity = true;
    return scene;
}

/// A material seen as `colour` from everywhere if there are no sources (the ambient term is 0.1·Kd·C).
inline Material glowing(const dvec3& colour) {
    Material material;
    material.colour = 10.0 * colour;
    material.diffuse = 1;
    return material;
}
inline Material matt(double diffuse) {
    Material material;
    material.colour = dvec3(1);
    material.diffuse = diffuse;
    return material;
}
/// A pure mirror; its highlight is too narrow to be seen.
inline Material mirror(double share) {
    Material material;
    material.diffuse = 0;
    material.specular = share;
    material.shine = 1e9;
    return material;
}
inline Material glass(double share, double ior) {
    Material material;
    material.diffuse = 0;
    material.transmit = share;
    material.ior = ior;
    return material;
}

inline std::uint32_t add_object(CellScene& scene, const Material& material) {
    scene.objects.push_back(material);
    return std::uint32_t(scene.objects.size() - 1);
}

inline void add_polygon(CellScene& scene, std::uint32_t object, std::vector<dvec3> vertices) {
    scene.polygons.push_back(make_polygon(std::uint32_t(scene.polygons.size()), object, std::move(vertices)));
}

/// Adds a rectangle corner + a·u + b·v; its front is on the side of u × v.
inline void add_rectangle(CellScene& scene, std::uint32_t object, const dvec3& corner, const dvec3& u,
                          const dvec3& v) {
    add_polygon(scene, object, {corner, corner + u, corner + u + v, corner + v});
}

/// Adds a closed surface round `centre`, radius(direction) cells away, on a grid of slices and stacks.
/// Neighbouring triangles share their vertices bit for bit; vertex normals point away from the centre.
inline void add_ball(CellScene& scene, std::uint32_t object, const dvec3& centre, int slices, int stacks,
                     const std::function<double(const dvec3&)>& radius) {
    std::vector<std::vector<dvec3>> points;
    std::vector<std::vector<dvec3>> normals;
    for (int i = 0; i <= stacks; ++i) {
        points.emplace_back();
        normals.emplace_back();
        for (int j = 0; j < slices; ++j) {
            const double polar = pi * i / stacks;
            const double turn = 2 * pi * j / slices;
            dvec3 way{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)};
            if (i == 0) way = {0, 0, 1};
            if (i == stacks) way = {0, 0, -1};
            points[i].push_back(centre + radius(way) * way);
            normals[i].push_back(way);
        }
    }
    const auto triangle = [&](int i0, int j0, int i1, int j1, int i2, int j2) {
        scene.polygons.push_back(make_triangle(std::uint32_t(scene.polygons.size()), object,
                                               {points[i0][j0], points[i1][j1], points[i2][j2]},
                                               {normals[i0][j0], normals[i1][j1], normals[i2][j2]}));
    };
    for (int i = 0; i < stacks; ++i) {
        for (int j = 0; j < slices; ++j) {
            const int next = (j + 1) % slices;
            if (i + 1 < stacks) triangle(i, i == 0 ? 0 : j, i + 1, j, i + 1, next);
            if (i > 0) triangle(i, j, i + 1, i + 1 == stacks ? 0 : next, i, next);
        }
    }
}

inline dvec3 random_direction(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    dvec3 way(0);
    while (!(glm::length(way) > 1e-6)) way = {normal(random), normal(random), normal(random)};
    return glm::normalize(way);
}

inline dvec3 random_point(std::mt19937_64& random, double low, double high) {
    std::uniform_real_distribution<double> uniform(low, high);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
}

/// Where on [low, high] a yes/no answer changes, by bisection. The answers at the two ends must differ.
inline double edge_between(double low, double high, const std::function<bool(double)>& answer) {
    const bool at_low = answer(low);
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (answer(middle) == at_low ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace raycell::hand_made
