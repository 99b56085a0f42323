#include "scenes/default_view.hpp"

#include <cmath>
#include <limits>
#include <variant>

namespace raycell {

namespace {

struct Bounds {
    dvec3 low{std::numeric_limits<double>::infinity()};
    dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const dvec3& centre, double radius) {
        low = glm::min(low, centre - dvec3(radius));
        high = glm::max(high, centre + dvec3(radius));
    }
    void add(const PolygonPrimitive& polygon) {
        for (const dvec3& v : polygon.vertices) add(v, 0);
    }
    void add(const SpherePrimitive& sphere) { add(sphere.centre, sphere.radius); }
    void add(const ConePrimitive& cone) {
        add(cone.base, cone.base_radius);
        add(cone.apex, cone.apex_radius);
    }
};

}  // namespace

void add_default_view(Scene& scene, Diagnostics& diagnostics) {
    Bounds bounds;
    for (const Primitive& primitive : scene.primitives) {
        std::visit([&](const auto& shape) { bounds.add(shape); }, primitive.shape);
    }
    if (scene.primitives.empty()) bounds.add(dvec3(0), 1);
    const dvec3 centre = (bounds.low + bounds.high) * 0.5;
    double radius = glm::length(bounds.high - bounds.low) * 0.5;
    if (!(radius > 0)) radius = 1;

    View view;
    // Slightly from the side and from above, to look into a box with an open front and to show depth.
    const dvec3 towards_viewer = glm::normalize(dvec3(0.15, 0.1, 1));
    view.from = centre + towards_viewer * (radius / std::sin(glm::radians(view.angle / 2)));
    view.at = centre;
    scene.view = view;
    const bool dark = scene.sources.empty();
    if (dark) scene.sources.push_back({view.from, std::nullopt});
    diagnostics.note(scene.name,
                     std::string("no view given: the bounding box is framed from the side of +z") +
                         (dark ? ", with one light at the viewer" : ""));
}

void take_view(Scene& scene, const Scene& view_scene) {
    scene.background = view_scene.background;
    if (view_scene.view) scene.view = view_scene.view;
    if (!view_scene.sources.empty()) scene.sources = view_scene.sources;
}

}  // namespace raycell
