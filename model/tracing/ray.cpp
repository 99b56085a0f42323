#include "model/tracing/ray.hpp"

#include <algorithm>

namespace raycell {

void set_direction(Ray& ray, const dvec3& direction, const Arithmetic& arithmetic) {
    ray.direction = direction;
    // A ray with so small a component never crosses, and the reciprocal would be too large.
    const auto inverse = [&](double d) { return std::abs(d) < 1e-12 ? 0.0 : arithmetic.reciprocal(d); };
    ray.inverse_x = inverse(direction.x);
    ray.inverse_y = inverse(direction.y);
    if (ray.inverse_x == 0) ray.direction.x = 0;
    if (ray.inverse_y == 0) ray.direction.y = 0;
}

Crossing next_crossing(const Ray& ray, const Arithmetic& arithmetic) {
    const Format& distance = arithmetic.formats().distance;
    Crossing x;
    Crossing y;
    if (ray.inverse_x > 0) {
        x = {arithmetic.product(distance, 1 - ray.position.x, ray.inverse_x), Side::east};
    } else if (ray.inverse_x < 0) {
        x = {arithmetic.product(distance, -ray.position.x, ray.inverse_x), Side::west};
    }
    if (ray.inverse_y > 0) {
        y = {arithmetic.product(distance, 1 - ray.position.y, ray.inverse_y), Side::south};
    } else if (ray.inverse_y < 0) {
        y = {arithmetic.product(distance, -ray.position.y, ray.inverse_y), Side::north};
    }
    return y.t < x.t ? y : x;
}

dvec3 point_at(const Ray& ray, double t, const Arithmetic& arithmetic) {
    const Formats& formats = arithmetic.formats();
    return {arithmetic.mac(formats.unit, ray.position.x, t, ray.direction.x),
            arithmetic.mac(formats.unit, ray.position.y, t, ray.direction.y), depth_at(ray, t, arithmetic)};
}

void move_along(Ray& ray, double t, const Arithmetic& arithmetic) {
    ray.position = point_at(ray, t, arithmetic);
    ray.position.x = std::clamp(ray.position.x, 0.0, 1.0);
    ray.position.y = std::clamp(ray.position.y, 0.0, 1.0);
    ray.reach = arithmetic.hold_reach(ray.reach - t);
    ray.fresh = false;
}

void cross(Ray& ray, const Crossing& crossing, const Arithmetic& arithmetic) {
    // An axial ray crosses nothing: it is only passed on to the border, and keeps its place in its own
    // column.
    if (ray.inverse_x == 0 && ray.inverse_y == 0) return;
    move_along(ray, crossing.t, arithmetic);
    switch (crossing.side) {
        case Side::east:
            ray.position.x = 0;
            break;
        case Side::west:
            ray.position.x = 1;
            break;
        case Side::south:
            ray.position.y = 0;
            break;
        case Side::north:
            ray.position.y = 1;
            break;
    }
}

double way_out(const Ray& ray, double bound, const Arithmetic& arithmetic) {
    const double way = arithmetic.product(arithmetic.formats().distance, bound - ray.position.z,
                                          arithmetic.reciprocal(ray.direction.z));
    return std::max(way, 0.0);
}

Crossing border_crossing(const Ray& ray, const Arithmetic& arithmetic) {
    const Crossing crossing = next_crossing(ray, arithmetic);
    if (ray.inverse_x != 0 || ray.inverse_y != 0) return crossing;
    return {0, Side::east};
}

}  // namespace raycell
