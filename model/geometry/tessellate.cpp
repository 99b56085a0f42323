#include "model/geometry/tessellate.hpp"

#include <algorithm>
#include <cmath>

namespace raycell {

namespace {

/// No facet of a subdivided octahedron whose corners lie at distance 1 has its plane nearer to the centre
/// than 1 / sqrt(1 + spread/n²).
constexpr double spread_of(int n) { return n <= 2 ? 2 : 1.77; }

/// The corners' distance from a centre or axis, for a radius of 1, that puts the nearest points of the facets
/// as far inside as the corners are outside. `nearest`: their distance if the corners are at 1.
double corners_at(double nearest) { return 2 / (1 + nearest); }

/// The nearest points' distance over that of the corners, with half of the chord error on either side.
double least_ratio(double radius, double chord_error) {
    return (radius - 0.5 * chord_error) / (radius + 0.5 * chord_error);
}

}  // namespace

int sphere_subdivision(double radius, double chord_error) {
    const double ratio = least_ratio(radius, chord_error);
    if (!(ratio > 0.577)) return 1;
    const double steepness = 1 / (ratio * ratio) - 1;
    if (spread_of(2) <= 4 * steepness) return 2;
    const double n = std::sqrt(spread_of(3) / steepness);
    return int(std::clamp(std::ceil(n), 3.0, double(max_sphere_subdivision)));
}

int cone_facets(double radius, double chord_error) {
    const double ratio = least_ratio(radius, chord_error);
    if (!(ratio > 0.5)) return 4;
    const double n = std::acos(-1.0) / std::acos(ratio);
    return int(std::clamp(std::ceil(n), 4.0, double(max_cone_facets)));
}

namespace {

class Builder {
  public:
    Builder(const Primitive& primitive, std::uint32_t first_id, const Frame& frame)
        : frame_(frame), object_(primitive.material), next_id_(first_id) {}

    void polygon(const PolygonPrimitive& shape) {
        std::vector<dvec3> outline;
        outline.reserve(shape.vertices.size());
        for (const dvec3& v : shape.vertices) outline.push_back(frame_.to_cells(v));
        if (!has_area(outline)) return;
        if (shape.normals.empty()) {
            polygons.push_back(make_polygon(next_id_++, object_, std::move(outline)));
            return;
        }
        // Only over a triangle is linear interpolation between the vertices a single function.
        for (const auto& t : triangulate(outline, newell(outline))) {
            triangle({outline[t[0]], outline[t[1]], outline[t[2]]},
                     {to_frame(shape.normals[t[0]]), to_frame(shape.normals[t[1]]),
                      to_frame(shape.normals[t[2]])});
        }
    }

    void sphere(const SpherePrimitive& shape, double chord_error, std::vector<std::string>* warnings) {
        const dvec3 centre = frame_.to_cells(shape.centre);
        const double radius = shape.radius / frame_.cell_width;
        const int n = sphere_subdivision(radius, chord_error);
        if (n == max_sphere_subdivision && warnings) {
            warnings->push_back("a sphere of radius " + std::to_string(radius) + " cells is cut into " +
                                std::to_string(8 * n * n) + " polygons, the limit, not finer");
        }
        const double reach = radius * corners_at(1 / std::sqrt(1 + spread_of(n) / (n * n)));
        // Equal angles along an octant's edges; in its middle facets are larger by half at most.
        const auto step = [&](int i) { return std::sin(0.5 * std::acos(-1.0) * i / n); };
        for (int octant = 0; octant < 8; ++octant) {
            const dvec3 sign{octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
            const bool mirrored = sign.x * sign.y * sign.z < 0;
            // A vertex depends on three whole numbers alone, so octants share their vertices bit for bit.
            const auto normal = [&](int i, int j) {
                return glm::normalize(dvec3(step(i), step(j), step(n - i - j))) * sign;
            };
            const auto facet = [&](dvec3 a, dvec3 b, dvec3 c) {
                if (mirrored != shape.inward) std::swap(b, c);
                const double side = shape.inward ? -1 : 1;
                triangle({centre + reach * a, centre + reach * b, centre + reach * c},
                         {side * a, side * b, side * c});
            };
            for (int i = 0; i < n; ++i) {
                for (int j = 0; i + j < n; ++j) {
                    facet(normal(i, j), normal(i + 1, j), normal(i, j + 1));
                    if (i + j + 1 < n) facet(normal(i + 1, j), normal(i + 1, j + 1), normal(i, j + 1));
                }
            }
        }
    }

    void cone(const ConePrimitive& shape, double chord_error, std::vector<std::string>* warnings) {
        const dvec3 base = frame_.to_cells(shape.base);
        const dvec3 apex = frame_.to_cells(shape.apex);
        const double r0 = shape.base_radius / frame_.cell_width;
        const double r1 = shape.apex_radius / frame_.cell_width;
        const double height = glm::length(apex - base);
        if (!(height > 0)) return;
        const dvec3 axis = (apex - base) / height;
        const dvec3 helper = std::abs(axis.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 u = glm::normalize(glm::cross(axis, helper));
        const dvec3 v = glm::cross(axis, u);
        const double largest = std::max(r0, r1);
        const int n = cone_facets(largest, chord_error);
        if (n == max_cone_facets && warnings) {
            warnings->push_back("a cone of radius " + std::to_string(largest) + " cells is cut into " +
                                std::to_string(n) + " facets, the limit, not finer");
        }
        const double side = shape.inward ? -1 : 1;
        const auto radial = [&](int k) {
            const double angle = 2 * std::acos(-1.0) * (k % n) / n;
            return std::cos(angle) * u + std::sin(angle) * v;
        };
        // With the radius as weight, the normals of a facet's corners interpolate to the cone's direction of
        // normal at every point, however the facet narrows; at a tip they vanish.
        const double outwards = corners_at(std::cos(std::acos(-1.0) / n));
        const double base_weight = r0 / largest;
        const double apex_weight = r1 / largest;
        for (int k = 0; k < n; ++k) {
            const dvec3 e0 = radial(k);
            const dvec3 e1 = radial(k + 1);
            const dvec3 n0 = glm::normalize(height * e0 + (r0 - r1) * axis);
            const dvec3 n1 = glm::normalize(height * e1 + (r0 - r1) * axis);
            std::vector<dvec3> corners;
            std::vector<dvec3> normals;
            const auto corner = [&](const dvec3& end, double weight, const dvec3& e, const dvec3& normal) {
                corners.push_back(end + outwards * largest * weight * e);
                normals.push_back(side * weight * normal);
            };
            corner(base, base_weight, e0, n0);
            if (r0 > 0) corner(base, base_weight, e1, n1);
            corner(apex, apex_weight, e1, n1);
            if (r1 > 0) corner(apex, apex_weight, e0, n0);
            if (shape.inward) {
                std::reverse(corners.begin(), corners.end());
                std::reverse(normals.begin(), normals.end());
            }
            if (corners.size() == 4 && (r1 > r0) != shape.inward) {  // the wide end tells the gradients well
                std::rotate(corners.begin(), corners.begin() + 2, corners.end());
                std::rotate(normals.begin(), normals.begin() + 2, normals.end());
            }
            facet(corners, {normals[0], normals[1], normals[2]});
        }
    }

    std::vector<Polygon> polygons;

  private:
    dvec3 to_frame(const dvec3& normal) const { return frame_.direction_to_cells(normal); }

    static bool has_area(const std::vector<dvec3>& outline) {
        const double area = glm::length(newell(outline));
        return area > 0 && std::isfinite(area);
    }

    void triangle(const std::array<dvec3, 3>& corners, const std::array<dvec3, 3>& normals) {
        facet({corners.begin(), corners.end()}, normals);
    }

    void facet(const std::vector<dvec3>& corners, const std::array<dvec3, 3>& normals) {
        if (!has_area(corners)) return;  // no area in double precision
        polygons.push_back(make_smooth_polygon(next_id_++, object_, corners, normals));
    }

    const Frame& frame_;
    std::uint32_t object_;
    std::uint32_t next_id_;
};

}  // namespace

std::vector<Polygon> tessellate(const Primitive& primitive, std::uint32_t first_id, const Frame& frame,
                                double chord_error, std::vector<std::string>* warnings) {
    Builder builder(primitive, first_id, frame);
    if (const auto* polygon = std::get_if<PolygonPrimitive>(&primitive.shape)) {
        builder.polygon(*polygon);
    } else if (const auto* sphere = std::get_if<SpherePrimitive>(&primitive.shape)) {
        builder.sphere(*sphere, chord_error, warnings);
    } else {
        builder.cone(std::get<ConePrimitive>(primitive.shape), chord_error, warnings);
    }
    return std::move(builder.polygons);
}

}  // namespace raycell
