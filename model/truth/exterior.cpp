#include "model/truth/exterior.hpp"

#include <algorithm>

namespace raycell {

ClassicalExterior::ClassicalExterior(const CellScene& scene, const TruthRenderer& truth)
    : scene_(scene), truth_(truth) {}

/// Distance from where the ray left the cube to where it had started, on the polygon that it leaves: 0 or
/// negative.
double ClassicalExterior::started(const ExteriorRequest& request, const Ray& ray) const {
    if (ray.leaves >= scene_.polygons.size()) return 0;
    const Plane& plane = scene_.polygons[ray.leaves].plane;
    const double slope = glm::dot(plane.n, request.direction);
    if (slope == 0) return 0;
    return std::min((plane.c - glm::dot(plane.n, request.origin)) / slope, 0.0);
}

dvec3 ClassicalExterior::radiance(const ExteriorRequest& request, const Ray& ray, Pixel* pixel) const {
    const double from = started(request, ray);
    if (shows_first_hit(ray) && pixel) {
        if (const auto hit = truth_.intersect(request.origin, request.direction, ray.leaves)) {
            HitSetup setup;
            setup.point = truth_.point_at(*hit, request.direction);
            record_first_hit(*pixel, setup, hit->polygon);
        }
    }
    return truth_.radiance(request.origin, request.direction, ray.leaves, ray.generation, ray.weight, nullptr,
                           from);
}

bool ClassicalExterior::blocked(const ExteriorRequest& request, const Ray& ray) const {
    return truth_.occluded(request.origin, request.direction, ray.leaves, request.reach,
                           started(request, ray));
}

}  // namespace raycell
