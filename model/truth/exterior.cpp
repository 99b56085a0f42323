#include "model/truth/exterior.hpp"

#include <algorithm>

namespace raycell {

ClassicalExterior::ClassicalExterior(const CellScene& scene, const TruthRenderer& truth)
    : scene_(scene), truth_(truth) {}

dvec3 ClassicalExterior::radiance(const ExteriorRequest& request, const Ray& ray, Pixel* pixel) const {
    const double from = started_at(scene_, request, ray);
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
                           started_at(scene_, request, ray));
}

}  // namespace raycell
