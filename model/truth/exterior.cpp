#include "model/truth/exterior.hpp"

#include <stdexcept>

namespace raycell {

ClassicalExterior::ClassicalExterior(const CellScene& scene, const TruthRenderer& truth)
    : scene_(scene), truth_(truth) {
    if (truth.of() != TruthOf::polygons)
        throw std::invalid_argument("the exterior goes on with the machine's polygons");
}

dvec3 ClassicalExterior::radiance(const ExteriorRequest& request, const Ray& ray, Pixel* pixel) const {
    if (ray.kind == RayKind::primary && pixel) {
        if (const auto hit = truth_.intersect(request.origin, request.direction, ray.leaves)) {
            const Polygon& polygon = scene_.polygons[hit->index];
            HitSetup setup;
            setup.point =
                shade_point(hit->position, request.direction,
                            polygon.normal.at(project(hit->position, polygon.drop)), polygon.plane.n);
            record_first_hit(*pixel, setup, polygon.id);
        }
    }
    return truth_.radiance(request.origin, request.direction, ray.leaves, ray.generation, ray.weight);
}

bool ClassicalExterior::blocked(const ExteriorRequest& request, const Ray& ray) const {
    return truth_.occluded(request.origin, request.direction, ray.leaves, request.reach);
}

}  // namespace raycell
