// Finds the surfaces that a ray may meet: Embree's bounding volumes around our own tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "model/geometry/placement.hpp"
#include "model/truth/probe_ray.hpp"

namespace raycell {

enum class TruthOf {
    scene,    ///< spheres and cones are met as such
    polygons  ///< their polygons are
};

/// Surfaces of a scene, by number: its polygons in their order, then its curved ones.
class Surfaces {
  public:
    /// Keeps a reference to the scene.
    Surfaces(const CellScene& scene, TruthOf of) : scene_(scene), of_(of) {}
    std::size_t end() const {
        return scene_.polygons.size() + (of_ == TruthOf::scene ? scene_.curved.size() : 0);
    }
    /// The numbers of those that rays can meet: of a curved object not its polygons too.
    std::vector<std::size_t> met() const;
    const Polygon* polygon(std::size_t i) const {
        return i < scene_.polygons.size() ? &scene_.polygons[i] : nullptr;
    }
    const CurvedSurface& curved(std::size_t i) const { return scene_.curved[i - scene_.polygons.size()]; }
    std::uint32_t id(std::size_t i) const {
        const Polygon* p = polygon(i);
        return p ? p->id : curved(i).first_polygon;
    }
    std::uint32_t object(std::size_t i) const {
        const Polygon* p = polygon(i);
        return p ? p->object : curved(i).object;
    }
    Box bounds(std::size_t i) const;
    /// Where a ray meets a surface with t_min < t <= t_max. A ray that leaves the polygon `leaves` does not
    /// meet it again, nor, where it starts, the curved surface that it is of.
    std::optional<double> meet(std::size_t i, const ProbeRay& ray, std::uint32_t leaves, double t_min,
                               double t_max) const;

  private:
    const CellScene& scene_;
    TruthOf of_;
};

/// Finds the nearest surface that a ray meets, exactly as if all had been tried.
///
/// Every surface is a user-defined primitive of Embree 3: Embree only walks its tree of boxes, in single
/// precision; Surfaces::meet() decides, in double. The boxes are padded by more than single precision can
/// lose.
class SurfaceIndex {
  public:
    /// The scene must outlive the index and stay unchanged. Throws std::invalid_argument naming a polygon
    /// with fewer than 3 vertices, or a surface that is not finite or reaches beyond 1e15 cells;
    /// std::runtime_error if Embree can't build.
    explicit SurfaceIndex(const Surfaces& surfaces);
    ~SurfaceIndex();
    SurfaceIndex(const SurfaceIndex&) = delete;
    SurfaceIndex& operator=(const SurfaceIndex&) = delete;

    struct Nearest {
        double t = 0;
        std::size_t index = 0;  ///< number of the surface
    };

    /// The nearest surface with nearest_hit < t <= t_max, for a ray that leaves the polygon `exclude`; among
    /// those within exact_tie of the nearest, the one with the lowest id.
    std::optional<Nearest> nearest(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

    /// Whether any surface is met with nearest_hit < t <= t_max.
    bool any(const ProbeRay& ray, std::uint32_t exclude, double t_max) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace raycell
