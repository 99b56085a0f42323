// Polygons and closed surfaces for property tests, in cell coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "../property.hpp"
#include "../truth/hand_made.hpp"

namespace raycell::shapes {

using hand_made::pi;
using property::Random;

/// A frame of axes turned at random: unit vectors at right angles to each other.
struct Axes {
    dvec3 u{1, 0, 0};
    dvec3 v{0, 1, 0};
    dvec3 w{0, 0, 1};
    dvec3 operator()(const dvec3& p) const { return p.x * u + p.y * v + p.z * w; }
};
inline Axes turned(Random& random) {
    Axes axes;
    axes.w = hand_made::random_direction(random.engine());
    axes.u = glm::normalize(glm::cross(axes.w, hand_made::random_direction(random.engine())));
    axes.v = glm::cross(axes.w, axes.u);
    return axes;
}
/// Axes of one of six kinds, 0 to 5. The plane (u, v) faces the viewer (0), is seen edge-on (1 to 3) or
/// nearly edge-on (4), or is turned at random (5).
inline Axes attitude(Random& random, int kind) {
    const double turn = random.uniform(0, 2 * pi);
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    switch (kind) {
        case 0:
            return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};  // faces the viewer
        case 1:
            return {{0, c, s}, {0, -s, c}, {1, 0, 0}};  // wall across x
        case 2:
            return {{c, 0, s}, {s, 0, -c}, {0, 1, 0}};  // floor
        case 3:
            return {{c, s, 0}, {0, 0, 1}, {s, -c, 0}};  // upright, edge-on, any direction
        case 4: {                                       // nearly edge-on
            const dvec3 u{c, s, 0};
            const dvec3 v = glm::normalize(dvec3(-s * 1e-4, c * 1e-4, 1));
            return {u, v, glm::cross(u, v)};
        }
        default:
            return turned(random);
    }
}

/// A simple, concave outline in the plane, star-shaped round the origin: radii jump from vertex to vertex.
inline std::vector<dvec2> star(Random& random, int corners, double size) {
    std::vector<dvec2> outline;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * pi * (i + random.uniform(0.05, 0.95)) / corners;
        outline.push_back(size * random.uniform(0.2, 1) * dvec2(std::cos(angle), std::sin(angle)));
    }
    return outline;
}
/// A comb: concave, with many parallel teeth. All corners lie on a grid, so that they line up in rows.
inline std::vector<dvec2> comb(int teeth, double size) {
    std::vector<dvec2> outline = {{-size, -size}, {size, -size}};
    const double step = 2 * size / (2 * teeth - 1);
    for (int i = teeth - 1; i >= 0; --i) {
        const double left = -size + 2 * i * step;
        outline.push_back({left + step, size});
        outline.push_back({left, size});
        if (i > 0) {
            outline.push_back({left, 0});
            outline.push_back({left - step, 0});
        }
    }
    return outline;
}
inline std::vector<dvec3> lift(const std::vector<dvec2>& outline, const Axes& axes, const dvec3& centre) {
    std::vector<dvec3> lifted;
    for (const dvec2& p : outline) lifted.push_back(centre + p.x * axes.u + p.y * axes.v);
    return lifted;
}

/// Even-odd rule: whether a point lies inside an outline, and how far the nearest edge is.
struct Place {
    bool inside = false;
    double distance = 1e300;
};
inline Place place_of(const std::vector<dvec2>& outline, const dvec2& p) {
    Place place;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const dvec2& a = outline[i];
        const dvec2& b = outline[(i + 1) % outline.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)) {
            place.inside = !place.inside;
        }
        const dvec2 along = b - a;
        const double squared = glm::dot(along, along);
        const double t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0;
        place.distance = std::min(place.distance, glm::length(p - a - t * along));
    }
    return place;
}
inline std::vector<dvec2> projected(const std::vector<dvec3>& outline, int drop) {
    std::vector<dvec2> flat;
    for (const dvec3& p : outline) flat.push_back(project(p, drop));
    return flat;
}
inline double area_of(const std::vector<dvec3>& outline) { return 0.5 * glm::length(newell(outline)); }

/// A closed surface: its scene, and random points that certainly lie inside it.
struct Closed {
    CellScene scene;
    std::function<dvec3(Random&)> inside;
    /// Whether it can be reached from every side: none of its vertices lies on the faces of the cube.
    bool has_outside() const {
        const Box cube = scene.frame.cube();
        for (const Polygon& polygon : scene.polygons) {
            for (const dvec3& p : polygon.vertices) {
                for (int axis = 0; axis < 3; ++axis) {
                    if (p[axis] < cube.low[axis] + 1e-3 || p[axis] > cube.high[axis] - 1e-3) return false;
                }
            }
        }
        return true;
    }
};

inline CellScene empty_cube(int width, int height, double depth, int levels) {
    CellScene scene = hand_made::cube(width, height, depth);
    scene.frame.depth_levels = levels;
    scene.objects.push_back(hand_made::matt(0.8));
    return scene;
}

/// Settings to load a scene in its own frame, without an exterior.
inline PictureSettings settings_for(const CellScene& scene, HitTest rung, Numbers arithmetic) {
    PictureSettings settings;
    settings.width = scene.frame.width;
    settings.height = scene.frame.height;
    settings.depth_levels = scene.frame.depth_levels;
    settings.hit = rung;
    settings.exterior = ExteriorMode::none;
    settings.numbers.arithmetic = arithmetic;
    return settings;
}
constexpr HitTest every_rung[] = {HitTest::depth, HitTest::interval, HitTest::plane, HitTest::mask,
                                  HitTest::edge};
constexpr Numbers both_arithmetics[] = {Numbers::fixed, Numbers::exact};

/// Adds the six faces of centre ± axes * `half`. Their fronts face outwards, or inwards if `inward`.
inline void add_block(CellScene& scene, const dvec3& centre, const Axes& axes, const dvec3& half,
                      bool inward = false) {
    std::array<dvec3, 8> corner;
    for (int i = 0; i < 8; ++i) {
        corner[std::size_t(i)] = centre + axes(half * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : faces) {
        std::vector<dvec3> outline;
        for (const int i : face) outline.push_back(corner[std::size_t(i)]);
        if (inward) std::reverse(outline.begin(), outline.end());
        hand_made::add_polygon(scene, 0, outline);
    }
}

/// A block: turned at random, or (`aligned`) with all faces exactly on borders of cells and levels.
inline Closed block(Random& random, bool aligned) {
    Closed closed;
    closed.scene = empty_cube(24, 20, 32, aligned ? 32 : 257);
    Axes axes;
    dvec3 centre;
    dvec3 half;
    if (aligned) {
        const dvec3 low{random.whole(0, 9), random.whole(0, 8), random.whole(1, 12)};
        const dvec3 high = low + dvec3(random.whole(1, 14), random.whole(1, 11), random.whole(1, 19));
        centre = 0.5 * (low + high);
        half = 0.5 * (high - low);
    } else {
        axes = turned(random);
        centre = {random.uniform(9, 15), random.uniform(8, 12), random.uniform(12, 20)};
        half = {random.uniform(0.3, 4.5), random.uniform(0.3, 4.5), random.uniform(0.3, 4.5)};
    }
    add_block(closed.scene, centre, axes, half);
    closed.inside = [=](Random& r) {
        return centre +
               axes(half * dvec3(r.uniform(-0.98, 0.98), r.uniform(-0.98, 0.98), r.uniform(-0.98, 0.98)));
    };
    return closed;
}

/// A ball of facets that share their vertices bit for bit.
inline Closed ball(Random& random) {
    Closed closed;
    closed.scene = empty_cube(22, 24, 26, random.whole(20, 1024));
    const dvec3 centre{random.uniform(9, 13), random.uniform(9, 15), random.uniform(10, 16)};
    const double radius = random.uniform(1, 8);
    hand_made::add_ball(closed.scene, 0, centre, random.whole(5, 24), random.whole(4, 16),
                        [=](const dvec3&) { return radius; });
    closed.inside = [=](Random& r) {
        return centre + 0.35 * radius * r.uniform(0, 1) * hand_made::random_direction(r.engine());
    };
    return closed;
}

/// A wedge: a long prism over a triangle, as thin as 1/300 of its length.
inline Closed wedge(Random& random) {
    Closed closed;
    closed.scene = empty_cube(24, 24, 24, random.whole(24, 2000));
    const Axes axes = random.chance(0.3) ? attitude(random, random.whole(0, 4)) : turned(random);
    const dvec3 centre{random.uniform(11, 13), random.uniform(11, 13), random.uniform(11, 13)};
    const double thin = std::pow(10, random.uniform(-1.7, 0.5));
    const dvec3 ends[3] = {{-6, 0, 0}, {6, thin, 0}, {6, -thin, 0}};
    std::vector<dvec3> front;
    std::vector<dvec3> back;
    for (const dvec3& p : ends) {
        front.push_back(centre + axes(p - dvec3(0, 0, 3)));
        back.push_back(centre + axes(p + dvec3(0, 0, 3)));
    }
    CellScene& scene = closed.scene;
    hand_made::add_polygon(scene, 0, front);
    hand_made::add_polygon(scene, 0, {back[2], back[1], back[0]});
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        hand_made::add_polygon(scene, 0, {front[j], front[i], back[i], back[j]});
    }
    closed.inside = [=](Random& r) {
        double a = r.uniform(0, 1);
        double b = r.uniform(0, 1);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        a = 0.02 + 0.94 * a, b = 0.02 + 0.94 * b;
        const dvec3 p = ends[0] + a * (ends[1] - ends[0]) + b * (ends[2] - ends[0]);
        return centre + axes({p.x, p.y, r.uniform(-2.9, 2.9)});
    };
    return closed;
}

/// A room with one block in it. Its walls are parallel to the axes, as in the Cornell box; rays start inside.
inline Closed room(Random& random) {
    Closed closed;
    closed.scene = empty_cube(20, 20, 40, random.whole(40, 1024));
    const dvec3 low{random.uniform(0.1, 2), random.uniform(0.1, 2), random.uniform(0.1, 2)};
    const dvec3 high{random.uniform(17, 19.9), random.uniform(17, 19.9), random.uniform(30, 39.9)};
    add_block(closed.scene, 0.5 * (low + high), {}, 0.5 * (high - low), true);
    add_block(closed.scene, {8, 12, 25}, turned(random), {1.5, 3, 1.5});
    closed.inside = [=](Random& r) {
        const dvec3 share{r.uniform(0.01, 0.99), r.uniform(0.01, 0.99), r.uniform(0.01, 0.99)};
        return low + share * (high - low);
    };
    return closed;
}

/// A mirror ball and a glass block before a wall, with two sources, seen by a viewer at infinity.
inline CellScene still_life(Random& random) {
    CellScene scene =
        empty_cube(random.whole(1, 20), random.whole(1, 20), random.uniform(8, 20), random.whole(8, 512));
    scene.background = {0.1, 0.2, 0.3};
    const std::uint32_t mirror = hand_made::add_object(scene, hand_made::mirror(0.9));
    const std::uint32_t glass = hand_made::add_object(scene, hand_made::glass(0.8, 1.4));
    const dvec3 size = scene.frame.cube().high;
    hand_made::add_rectangle(scene, 0, {0, 0, size.z * 0.95}, {size.x, 0, 0}, {0, size.y, 0});
    hand_made::add_ball(scene, mirror, size * dvec3(0.3, 0.6, 0.5), 9, 6,
                        [&](const dvec3&) { return 0.2 * size.x; });
    const std::size_t first = scene.polygons.size();
    add_block(scene, size * dvec3(0.7, 0.4, 0.5), turned(random), size * dvec3(0.12, 0.12, 0.1));
    for (std::size_t i = first; i < scene.polygons.size(); ++i) scene.polygons[i].object = glass;
    scene.sources.push_back({size * dvec3(0.2, 0.1, 0.05), dvec3(0.7)});
    scene.sources.push_back({size * dvec3(0.9, -0.2, 0.3), dvec3(0.4, 0.5, 0.6)});
    return scene;
}

/// A random direction. The slope dz/dx is log-uniform from 1/1000 to 1000 and sometimes 0; some directions
/// are axial, and many lie in a plane of the axes.
inline dvec3 sloped_direction(Random& random) {
    if (random.chance(0.05)) return {0, 0, random.chance(0.5) ? 1 : -1};
    const double turn = random.uniform(0, 2 * pi);
    double x = std::cos(turn);
    double y = std::sin(turn);
    if (random.chance(0.1)) x = random.chance(0.5) ? 1 : -1, y = 0;
    if (random.chance(0.1)) y = random.chance(0.5) ? 1 : -1, x = 0;
    double z = std::pow(10, random.uniform(-3, 3)) * (random.chance(0.5) ? 1 : -1);
    if (random.chance(0.1)) z = 0;
    return glm::normalize(dvec3(x, y, z));
}

/// Stars of any attitude in a cube of 3x3 cells, `count` of them less those that lie outside.
inline CellScene random_polygons(Random& random, int count) {
    CellScene scene = empty_cube(3, 3, 12, random.whole(1, 300));
    for (int i = 0; i < count; ++i) {
        const Axes axes = attitude(random, random.whole(0, 5));
        const dvec3 centre =
            scene.frame.cube().high * dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
        auto outline = lift(star(random, random.whole(3, 12), random.uniform(0.5, 4)), axes, centre);
        outline = clip_to_box(outline, scene.frame.cube());
        if (outline.empty() || area_of(outline) < 1e-6) continue;
        hand_made::add_polygon(scene, 0, outline);
    }
    return scene;
}

}  // namespace raycell::shapes
