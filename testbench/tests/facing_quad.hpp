// A scene in one plane that faces the viewer, exactly or almost: it must not lie on a face of the cube and
// get lost there.
#pragma once

#include <algorithm>

#include "model/geometry/placement.hpp"
#include "property.hpp"

namespace raycell::facing {

/// A convex quad round the middle of the view, tilted by up to 1e-2, seen from a random viewpoint.
struct Quad {
    Scene scene;
    std::vector<dvec3> corners;  ///< world

    explicit Quad(property::Random& random) {
        View view;
        const dvec3 ways[] = {{0, 0, 1}, {1, 0, 0}, {0.3, -0.7, 0.2}};
        const dvec3 forward = glm::normalize(ways[random.whole(0, 2)]);
        const double distance = std::pow(10.0, random.uniform(-2, 3));
        view.at = dvec3(random.uniform(-5, 5), random.uniform(-5, 5), 0);
        view.from = view.at - distance * forward;
        view.up = {0.1, 1, 0.05};
        view.angle = random.uniform(10, 90);
        view.hither = random.chance(0.5) ? 0 : 0.1 * distance;
        const dvec3 right = glm::normalize(glm::cross(forward, view.up));
        const dvec3 down = glm::cross(forward, right);
        const double half = distance * std::tan(glm::radians(view.angle) / 2);
        const double tilts[] = {0, 0, 1e-6, 1e-4, 1e-2};
        const double tilt_x = tilts[random.whole(0, 4)] * random.uniform(-1, 1);
        const double tilt_y = tilts[random.whole(0, 4)] * random.uniform(-1, 1);
        const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (const auto& sign : signs) {
            const double x = sign[0] * half * random.uniform(0.4, 0.9);
            const double y = sign[1] * half * random.uniform(0.4, 0.9);
            corners.push_back(view.at + x * right + y * down + (tilt_x * x + tilt_y * y) * forward);
        }
        scene.view = view;
        scene.background = dvec3(0.25);
        scene.materials.push_back(Material());
        scene.primitives.push_back({0, PolygonPrimitive{{corners[0], corners[1], corners[2]}, {}}});
        scene.primitives.push_back({0, PolygonPrimitive{{corners[0], corners[2], corners[3]}, {}}});
    }
};

/// Distance of the pixel's ray from the quad's outline, in cells on the screen; negative outside.
inline double depth_inside(const Quad& quad, const Frame& frame, int x, int y) {
    const dvec2 pixel(x + 0.5, y + 0.5);
    double inside = 1e300;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto screen = [&](std::size_t corner) {
            const dvec3 p = frame.to_cells(quad.corners[corner % 4]);
            return frame.viewer_at_infinity
                       ? dvec2(p)
                       : dvec2(frame.eye) - frame.eye.z / (p.z - frame.eye.z) * dvec2(p - frame.eye);
        };
        const dvec2 a = screen(i);
        const dvec2 side = screen(i + 1) - a;
        const dvec2 to = pixel - a;
        inside = std::min(inside, (side.x * to.y - side.y * to.x) / glm::length(side));
    }
    return inside;
}

}  // namespace raycell::facing
