#include "model/ray.hpp"

#include <algorithm>

#include "model/arithmetic.hpp"

namespace raycell {

void set_direction(Ray& ray, const dvec3& direction) {
    ray.direction = direction;
    // A reciprocal too large to be a number belongs to a ray that never crosses.
    const auto inverse = [](double d) { return std::abs(d) < 1e-12 ? 0.0 : arith::reciprocal(d); };
    ray.inverse_x = inverse(direction.x);
    ray.inverse_y = inverse(direction.y);
    if (ray.inverse_x == 0) ray.direction.x = 0;
    if (ray.inverse_y == 0) ray.direction.y = 0;
}

Crossing next_crossing(const Ray& ray) {
    Crossing x;
    Crossing y;
    if (ray.inverse_x > 0) {
        x = {(1 - ray.position.x) * ray.inverse_x, Side::east};
    } else if (ray.inverse_x < 0) {
        x = {-ray.position.x * ray.inverse_x, Side::west};
    }
    if (ray.inverse_y > 0) {
        y = {(1 - ray.position.y) * ray.inverse_y, Side::south};
    } else if (ray.inverse_y < 0) {
        y = {-ray.position.y * ray.inverse_y, Side::north};
    }
    return y.t < x.t ? y : x;
}

void cross(Ray& ray, const Crossing& crossing) {
    // An axial ray crosses nothing: it is only carried to the border, and keeps its place in its own column.
    if (ray.inverse_x == 0 && ray.inverse_y == 0) return;
    ray.position += crossing.t * ray.direction;
    ray.position.x = std::clamp(ray.position.x, 0.0, 1.0);
    ray.position.y = std::clamp(ray.position.y, 0.0, 1.0);
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
    ray.reach -= crossing.t;
    ray.fresh = false;
}

Crossing border_crossing(const Ray& ray) {
    const Crossing crossing = next_crossing(ray);
    if (ray.inverse_x != 0 || ray.inverse_y != 0) return crossing;
    return {0, Side::east};
}

}  // namespace raycell
