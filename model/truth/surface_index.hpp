// Finds the polygons that a ray may meet: Embree's bounding volumes around our own tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "model/truth/probe_ray.hpp"

namespace raycell {

/// Finds the nearest polygon that a ray meets, exactly as if all polygons had been tried.
///
/// Every polygon is a user-defined primitive of Embree 3: Embree only walks its tree of boxes, in single
/// precision; ProbeRay decides, in double. The boxes are padded by more than single precision can lose.
class PolygonIndex {
  public:
    /// Keeps a reference: `polygons` must outlive the index and stay unchanged. Throws std::invalid_argument
    /// naming a polygon with fewer than 3 vertices, or with a vertex that is not finite or lies beyond 1e15
    /// cells; std::runtime_error if Embree can't build.
    explicit PolygonIndex(const std::vector<Polygon>& polygons);
    ~PolygonIndex();
    PolygonIndex(const PolygonIndex&) = delete;
    PolygonIndex& operator=(const PolygonIndex&) = delete;

    struct Nearest {
        double t = 0;
        std::size_t index = 0;  ///< into the polygons given
    };

    /// The nearest polygon with nearest_hit < t <= t_max whose id is not `exclude`; among those within
    /// exact_tie of the nearest, the one with the lowest id.
    std::optional<Nearest> nearest(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

    /// Whether any polygon but `exclude` is met with nearest_hit < t <= t_max.
    bool any(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace raycell
