// Finds the polygons that a ray may meet: Embree's bounding volumes round tests of our own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "model/truth/probe_ray.hpp"

namespace raycell {

/// The nearest polygon among those given, exactly as if all of them had been tried.
///
/// Every polygon is a user-defined primitive of Embree 3: Embree only walks its tree of boxes, in single
/// precision; ProbeRay decides, in double. The boxes are padded by more than single precision can lose.
class PolygonIndex {
  public:
    /// Keeps a reference: `polygons` must outlive the index and stay unchanged.
    /// Throws std::invalid_argument naming a polygon with fewer than 3 vertices, a vertex that is not finite
    /// or lies beyond 1e15 cells; std::runtime_error if Embree can't build.
    explicit PolygonIndex(const std::vector<Polygon>& polygons);
    ~PolygonIndex();
    PolygonIndex(const PolygonIndex&) = delete;
    PolygonIndex& operator=(const PolygonIndex&) = delete;

    struct Nearest {
        double t = 0;
        std::size_t index = 0;  ///< into the polygons given
    };

    /// The nearest polygon with nearest_hit < t <= t_max whose id is not `exclude`; within exact_tie of the
    /// nearest: the lowest id.
    std::optional<Nearest> nearest(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

    /// Whether any polygon but `exclude` is met with nearest_hit < t <= t_max.
    bool any(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace raycell
