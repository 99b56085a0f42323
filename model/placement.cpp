#include "model/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/shading.hpp"
#include "model/tessellate.hpp"

namespace raycell {

dvec3 Frame::direction_to_cells(const dvec3& world) const {
    return {glm::dot(world, right), glm::dot(world, down), glm::dot(world, forward)};
}

dvec3 Frame::to_cells(const dvec3& world) const { return direction_to_cells(world - corner) / cell_width; }

Frame::PrimaryRay Frame::primary_ray(double x, double y) const {
    const dvec3 origin{x, y, 0};
    if (viewer_at_infinity) return {origin, {0, 0, 1}};
    return {origin, glm::normalize(origin - eye)};
}

namespace {

struct Extent {
    double near = std::numeric_limits<double>::infinity();
    double far = -std::numeric_limits<double>::infinity();
};

/// Depth range, in world units along the view axis, of what the field of view takes in.
Extent visible_extent(const Scene& scene, const Frame& axes, const PictureSettings& settings, double tan_x,
                      double tan_y, double half_x, double half_y, double hither) {
    Extent extent;
    for (const Primitive& primitive : scene.primitives) {
        // A coarse tessellation is enough here; what it may miss of a curved object is added to its range.
        double chord = 0;
        if (const auto* s = std::get_if<SpherePrimitive>(&primitive.shape)) chord = 0.01 * s->radius;
        if (const auto* c = std::get_if<ConePrimitive>(&primitive.shape)) {
            chord = 0.01 * std::max(c->base_radius, c->apex_radius);
        }
        for (const Polygon& polygon : tessellate(primitive, 0, axes, chord)) {
            std::vector<dvec3> part = polygon.vertices;
            if (settings.viewer == ViewerMode::infinity) {
                part = clip_to_box(part, {{-half_x, -half_y, -1e300}, {half_x, half_y, 1e300}});
            } else {
                part = clip_half_space(part, 2, hither, 1);
                // A little wider than the field of view, so that curved objects at its rim are seen whole.
                const dvec3 sides[] = {{1, 0, tan_x}, {-1, 0, tan_x}, {0, 1, tan_y}, {0, -1, tan_y}};
                for (const dvec3& side : sides) part = clip_plane(part, side, -2 * chord);
            }
            for (const dvec3& p : part) {
                extent.near = std::min(extent.near, p.z - 1.5 * chord);
                extent.far = std::max(extent.far, p.z + 1.5 * chord);
            }
        }
    }
    return extent;
}

}  // namespace

Frame place_frame(const Scene& scene, const PictureSettings& settings) {
    if (!scene.view) throw std::invalid_argument("the scene has no view");
    const View& view = *scene.view;
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.depth_levels = settings.depth_levels;
    frame.forward = glm::normalize(view.at - view.from);
    frame.right = glm::normalize(glm::cross(frame.forward, view.up));
    frame.down = glm::cross(frame.forward, frame.right);
    frame.viewer_at_infinity = settings.viewer == ViewerMode::infinity;

    // NFF's angle runs from the centre of the first to the centre of the last pixel row.
    const double intervals = std::max(settings.height - 1, 1);
    const double tan_half = std::tan(glm::radians(view.angle) / 2);
    const double tan_cell = 2 * tan_half / intervals;  // a cell's width over its distance
    const double to_target = glm::length(view.at - view.from);

    Frame axes = frame;  // view coordinates in world units, the eye at the origin
    axes.corner = view.from;
    axes.cell_width = 1;
    const double hither = std::max(view.hither, 1e-6 * to_target);
    const double half_x = settings.width * tan_cell / 2;
    const double half_y = settings.height * tan_cell / 2;
    Extent extent =
        visible_extent(scene, axes, settings, half_x, half_y, half_x * to_target, half_y * to_target, hither);
    if (!(extent.near <= extent.far)) extent = {to_target, to_target};  // nothing to see: background
    if (!frame.viewer_at_infinity) extent.near = std::max(extent.near, hither);
    extent.far = std::max(extent.far, extent.near);

    // A hair of room at both ends: a plane that faces the viewer must not lie on the cube's own face.
    const double range = extent.far - extent.near;
    const double slack = 1e-3 * range + 1e-6 * std::max(std::abs(extent.near), std::abs(extent.far));
    double near = extent.near - slack;
    if (!frame.viewer_at_infinity) near = std::max(near, 0.999 * extent.near);
    const double far = extent.far + slack;

    const double distance = frame.viewer_at_infinity ? to_target : near;
    frame.cell_width = tan_cell * distance;
    frame.depth = std::max((far - near) / frame.cell_width, 1.0);
    frame.corner = view.from + near * frame.forward -
                   0.5 * frame.cell_width *
                       (double(settings.width) * frame.right + double(settings.height) * frame.down);
    frame.eye = {0.5 * settings.width, 0.5 * settings.height, -near / frame.cell_width};
    return frame;
}

CellScene place_scene(const Scene& scene, const Frame& frame, const PictureSettings& settings) {
    if (scene.sources.size() > max_sources) {
        throw std::invalid_argument("the scene has " + std::to_string(scene.sources.size()) +
                                    " light sources; at most " + std::to_string(max_sources) +
                                    " are allowed");
    }
    CellScene placed;
    placed.frame = frame;
    placed.background = scene.background;
    placed.objects = scene.materials;
    const double share = 1 / std::sqrt(double(std::max<std::size_t>(scene.sources.size(), 1)));
    for (const LightSource& source : scene.sources) {
        placed.sources.push_back({frame.to_cells(source.position), source.colour.value_or(dvec3(share))});
    }
    for (const Primitive& primitive : scene.primitives) {
        auto polygons = tessellate(primitive, std::uint32_t(placed.polygons.size()), frame,
                                   settings.chord_error, &placed.warnings);
        std::move(polygons.begin(), polygons.end(), std::back_inserter(placed.polygons));
    }
    const Box cube = frame.cube();
    constexpr double hair = 1e-6;  // cells: what touches a face does not lie beyond it
    bool any_inside = false;
    for (const Polygon& polygon : placed.polygons) {
        any_inside = any_inside || !clip_to_box(polygon.vertices, cube).empty();
        for (const dvec3& p : polygon.vertices) {
            for (int axis = 0; axis < 3; ++axis) {
                if (p[axis] < cube.low[axis] - hair) placed.beyond[std::size_t(2 * axis)] = true;
                if (p[axis] > cube.high[axis] + hair) placed.beyond[std::size_t(2 * axis + 1)] = true;
            }
        }
    }
    if (!any_inside && !placed.polygons.empty()) {
        placed.warnings.push_back("nothing of the scene lies in the cube that the viewer sees");
    }
    return placed;
}

}  // namespace raycell
