#include "model/geometry/placement.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/geometry/tessellate.hpp"
#include "model/geometry/visible_extent.hpp"
#include "model/numbers/field_widths.hpp"

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

/// Margin between the visible scene and the cube's front and back, in cells. A surface that faces the viewer
/// must not lie on a face of the cube, where words can't tell inside from outside. The margin also covers the
/// distance by which facets lie inside or outside of a curved surface. It is measured in pixels, so that the
/// cube does not depend on how many of them a cell has, but is never less than some last bits of a position.
double margin_of(const PictureSettings& settings, const Frame& frame) {
    const double margin = std::max(0.5, 2 * settings.chord_error) / frame.pixels_per_cell();
    const NumberSettings& numbers = settings.numbers;
    return numbers.arithmetic == Numbers::exact ? margin
                                                : std::max(margin, scale_by(1, 4 - numbers.word_bits));
}

/// The array's field of view, in the viewer's coordinates. `tan_x` and `tan_y` are half of its sides at
/// distance 1.
std::vector<HalfSpace> field_of_view(ViewerMode viewer, double tan_x, double tan_y, double hither,
                                     double to_target) {
    if (viewer == ViewerMode::infinity) {
        const double x = -tan_x * to_target;
        const double y = -tan_y * to_target;
        return {{{1, 0, 0}, x}, {{-1, 0, 0}, x}, {{0, 1, 0}, y}, {{0, -1, 0}, y}};
    }
    return {{{0, 0, 1}, hither},
            {{1, 0, tan_x}, 0},
            {{-1, 0, tan_x}, 0},
            {{0, 1, tan_y}, 0},
            {{0, -1, tan_y}, 0}};
}

}  // namespace

namespace {

/// The next larger height of a level that cells can be told: a mantissa of 16 bits.
double level_word(double level) {
    const double step = scale_by(1, exponent_of(level) + 1 - field::level_mantissa);
    return std::ceil(level / step) * step;
}

}  // namespace

Frame array_frame(const PictureSettings& settings) {
    const int wide = settings.pixels_wide;
    const int high = settings.pixels_high;
    if (wide < 0 || high < 0 || wide % settings.width != 0 || high % settings.height != 0) {
        const auto text = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
        throw std::invalid_argument(
            "--pixels " + text(wide, high) + ": expected a whole multiple of --cells " +
            text(settings.width, settings.height) + " each way; the two multiples may differ");
    }
    if (std::uint64_t(std::max(wide, 1)) * std::uint64_t(std::max(high, 1)) > most_pixels)
        throw std::invalid_argument("--pixels " + std::to_string(wide) + "x" + std::to_string(high) +
                                    ": expected at most " + std::to_string(most_pixels) + " pixels");
    Frame frame;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.block_width = settings.block_width();
    frame.block_height = settings.block_height();
    frame.depth_levels = settings.depth_levels;
    return frame;
}

Frame place_frame(const Scene& scene, const PictureSettings& settings) {
    if (!scene.view) throw std::invalid_argument("the scene has no view");
    const View& view = *scene.view;
    Frame frame = array_frame(settings);
    frame.forward = glm::normalize(view.at - view.from);
    frame.right = glm::normalize(glm::cross(frame.forward, view.up));
    frame.down = glm::cross(frame.forward, frame.right);
    frame.viewer_at_infinity = settings.viewer == ViewerMode::infinity;

    // NFF's angle runs from the centre of the first to the centre of the last pixel row.
    const double intervals = std::max(frame.picture_height() - 1, 1);
    const double tan_half = std::tan(glm::radians(view.angle) / 2);
    // A cell's width over its distance.
    const double tan_cell = 2 * tan_half / intervals * frame.block_height;
    const double to_target = glm::length(view.at - view.from);

    const double hither = std::max(view.hither, 1e-6 * to_target);
    const std::vector<HalfSpace> field = field_of_view(settings.viewer, settings.width * tan_cell / 2,
                                                       settings.height * tan_cell / 2, hither, to_target);
    const ViewAxes axes{view.from, frame.right, frame.down, frame.forward};
    Extent extent;
    for (const Primitive& primitive : scene.primitives) extent.add(visible_extent(primitive, axes, field));
    if (!(extent.near <= extent.far)) extent = {to_target, to_target};  // nothing to see: background

    const double margin = margin_of(settings, frame);
    double near = extent.near - margin * tan_cell * to_target;
    // A nearer screen has smaller cells, so the margin shrinks with the distance. Nothing nearer than
    // `hither` is seen: a scene that is cut off there passes through the screen.
    if (!frame.viewer_at_infinity) near = std::max(extent.near / (1 + margin * tan_cell), 0.999 * hither);
    const double distance = frame.viewer_at_infinity ? to_target : near;
    frame.cell_width = tan_cell * distance;
    const double far = extent.far + margin * frame.cell_width;
    frame.depth = settings.depth_levels *
                  level_word(std::max((far - near) / frame.cell_width, 1 / frame.pixels_per_cell()) /
                             settings.depth_levels);
    frame.corner = view.from + near * frame.forward -
                   0.5 * frame.cell_width *
                       (double(settings.width) * frame.right + double(settings.height) * frame.down);
    frame.eye = {0.5 * settings.width, 0.5 * settings.height, -near / frame.cell_width};
    return frame;
}

namespace {

/// A sphere or a cone in cell coordinates, without the ids of its polygons; nothing for a polygon.
std::optional<CurvedSurface> curved_surface(const Primitive& primitive, const Frame& frame) {
    CurvedSurface surface;
    surface.object = primitive.material;
    if (const auto* sphere = std::get_if<SpherePrimitive>(&primitive.shape)) {
        surface.base = frame.to_cells(sphere->centre);
        surface.base_radius = sphere->radius / frame.cell_width;
        surface.inward = sphere->inward;
        return surface;
    }
    const auto* cone = std::get_if<ConePrimitive>(&primitive.shape);
    if (!cone) return std::nullopt;
    surface.kind = CurvedSurface::Kind::cone;
    surface.base = frame.to_cells(cone->base);
    surface.apex = frame.to_cells(cone->apex);
    surface.base_radius = cone->base_radius / frame.cell_width;
    surface.apex_radius = cone->apex_radius / frame.cell_width;
    surface.inward = cone->inward;
    return surface;
}

/// `share`: the intensity of a source without a colour.
Source placed_source(const LightSource& source, const Frame& frame, double share) {
    Source placed{frame.to_cells(source.position), source.colour.value_or(dvec3(share))};
    placed.kind = source.kind;
    if (source.kind == SourceKind::point) return placed;
    if (is_area(source.kind)) {
        placed.radius = source.radius / frame.cell_width;
        placed.edge_u = frame.direction_to_cells(source.edge_u) / frame.cell_width;
        placed.edge_v = frame.direction_to_cells(source.edge_v) / frame.cell_width;
        if (source.kind != SourceKind::sphere)
            placed.axis =
                -glm::normalize(glm::cross(glm::normalize(placed.edge_u), glm::normalize(placed.edge_v)));
        placed.position -= source.before * placed.axis;
        return placed;
    }
    placed.axis = -frame.direction_to_cells(glm::normalize(source.direction));
    if (source.kind != SourceKind::spot) return placed;
    placed.cut_off = source.angle < 90 ? std::cos(glm::radians(source.angle)) : 0;
    placed.falloff = source.falloff;
    return placed;
}

}  // namespace

CellScene place_scene(const Scene& scene, const Frame& frame, const PictureSettings& settings,
                      const std::vector<double>& chord_errors) {
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
        placed.sources.push_back(placed_source(source, frame, share));
    }
    for (const Primitive& primitive : scene.primitives) {
        const auto first = std::uint32_t(placed.polygons.size());
        const auto number = std::size_t(&primitive - scene.primitives.data());
        const double chord_error = chord_errors.empty() ? settings.chord_error : chord_errors.at(number);
        auto polygons =
            tessellate(primitive, first, frame, chord_error / frame.pixels_per_cell(), &placed.warnings);
        if (auto surface = curved_surface(primitive, frame); surface && !polygons.empty()) {
            surface->first_polygon = first;
            surface->polygons = std::uint32_t(polygons.size());
            placed.curved.push_back(*surface);
        }
        std::move(polygons.begin(), polygons.end(), std::back_inserter(placed.polygons));
    }
    const Box cube = frame.cube();
    constexpr double hair = 1e-6;  // cells; a polygon that only touches a face does not lie beyond it
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
    for (const CurvedSurface& surface : placed.curved) {
        const Box box = bounds_of(surface);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (box.low[int(axis)] < cube.low[int(axis)] - hair) placed.beyond[2 * axis] = true;
            if (box.high[int(axis)] > cube.high[int(axis)] + hair) placed.beyond[2 * axis + 1] = true;
        }
    }
    if (!any_inside && !placed.polygons.empty()) {
        placed.warnings.push_back("nothing of the scene lies in the cube that the viewer sees");
    }
    return placed;
}

}  // namespace raycell
