// The truth: the same scene, camera and shading model, rendered classically, on spheres and cones as such or
// on the exact polygons.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "model/geometry/placement.hpp"
#include "model/picture/picture.hpp"
#include "model/shading/shading.hpp"
#include "model/truth/surface_index.hpp"

namespace raycell {

class TruthRenderer;

/// Limits of a tree of rays, and what the rays meet.
struct TruthSettings {
    int max_depth = 4;              ///< generations after the primary ray, >= 0
    double min_weight = 1.0 / 256;  ///< a secondary ray that weighs less is not sent; 0: no cut
    /// SPD's rules 8 and 9: a transmitting surface always sends one reflected ray, whatever its Ks, and on
    /// total internal reflection no other.
    bool transmitters_reflect = false;
    TruthOf of = TruthOf::scene;
    /// Goes on with rays where they leave the cube; null: nobody, the cube is no border. With it, a truth of
    /// polygons is what a machine of exact arithmetic and this exterior renders.
    const TruthRenderer* beyond = nullptr;
    int source_samples = 256;  ///< shadow rays of a hit to each source that is an area, >= 1
    /// Primary rays of a pixel, 1..256, where the machine's samples lie; and how they lie closest.
    int samples = 1;
    PixelFilter filter = PixelFilter::box;
    int first_of = 1;  ///< the first hit of a pixel is that of the first of so many samples
};

/// Rays of a converged pixel, and of each of its hits to an area if `source_samples` are asked for where a
/// pixel has one ray: every ray has samples of its own.
constexpr int converged_samples = 256;
constexpr int source_samples_of_many(int source_samples) { return std::max(1, source_samples / 64); }

/// The converged truth of pictures with these settings.
TruthSettings truth_settings(const PictureSettings& picture, int source_samples);

struct TruthHit {
    double t = 0;                        ///< distance from the ray's origin, cell widths
    std::uint32_t polygon = no_polygon;  ///< its id; of a curved surface its first polygon's
    std::size_t index = 0;    ///< its place in CellScene::polygons; beyond them: number in Surfaces
    dvec3 position{0, 0, 0};  ///< cell coordinates
};

/// Rays sent, in the terms of the Standard Procedural Databases (Haines 1987).
struct TruthCounts {
    std::uint64_t eye = 0;        ///< primary rays
    std::uint64_t eye_hits = 0;   ///< of them, those that hit anything
    std::uint64_t reflected = 0;  ///< including those of total internal reflection
    std::uint64_t refracted = 0;
    std::uint64_t shadow = 0;  ///< to sources that the normal faces; none is sent to others
};
TruthCounts& operator+=(TruthCounts& sum, const TruthCounts& more);

/// Whitted's ray tracer over the whole, unclipped scene (design, section 7). All methods are const and
/// thread-safe; directions are unit, coordinates those of cells.
///
/// A ray never hits the polygon that it leaves (`exclude`, no_polygon for none), nor a curved surface in the
/// point where it leaves that, and nothing nearer than
/// `nearest_hit`; so it starts exactly at the hit point, without an offset.
class TruthRenderer {
  public:
    /// Called with rows done and rows in all; never by two threads at once.
    using Progress = std::function<void(int, int)>;

    /// Keeps a reference: the scene must outlive the renderer and stay unchanged.
    /// Throws std::invalid_argument for what SurfaceIndex rejects, an object that doesn't exist, more than
    /// max_sources sources, a negative max_depth, or no samples.
    explicit TruthRenderer(const CellScene& scene, const TruthSettings& settings = {});
    explicit TruthRenderer(const CellScene&&, const TruthSettings& = {}) = delete;

    /// The first surface with nearest_hit < t <= t_max; of those within exact_tie of the nearest,
    /// the one with the lowest id. `started`: where the ray left `exclude`, 0 or negative; here and below.
    std::optional<TruthHit> intersect(const dvec3& origin, const dvec3& direction, std::uint32_t exclude,
                                      double t_max = std::numeric_limits<double>::infinity(),
                                      double started = 0) const;

    /// Whether any surface, transparent or not, lies between the origin and t_max. Surfaces within
    /// nearest_hit of either end don't count: a polygon through the source itself does not darken it.
    bool occluded(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, double t_max,
                  double started = 0) const;

    /// Intensity that a ray brings back. `generation` is 0 for a primary ray; `weight` is the product of the
    /// shares on the way to it. If `counts` is given, adds the rays that this ray causes, not the ray itself.
    dvec3 radiance(const dvec3& origin, const dvec3& direction, std::uint32_t exclude, int generation,
                   double weight, TruthCounts* counts = nullptr, double started = 0) const;

    /// A hit as shading sees it, and the object that was hit.
    ShadePoint point_at(const TruthHit& hit, const dvec3& direction) const;
    std::uint32_t object_of(const TruthHit& hit) const { return surfaces_.object(hit.index); }

    /// What it renders.
    TruthOf of() const { return settings_.of; }

    /// The settings' samples of every pixel. cycle and hops stay 0. The picture is the same, bit for
    /// bit, for any number of threads (0: as many as the processor has).
    Picture render(int threads = 0, const Progress& progress = {}) const;

    /// The mean of the first `taken` of a pixel's samples, 0: of all.
    dvec3 pixel(int column, int row, int taken = 0) const;

    /// Counts the rays of an n × n picture by the rules of the Standard Procedural Databases: rays from edge
    /// to edge of the field of view (n = 513 for a resolution of 512: the pixels' corners), trees of depth 5
    /// with the primary ray as 1, no cut by weight. Throws std::invalid_argument if n < 2.
    TruthCounts count(int n, int threads = 0, const Progress& progress = {}) const;

  private:
    struct Tracer;

    const CellScene& scene_;
    TruthSettings settings_;
    Surfaces surfaces_;
    SurfaceIndex index_;
};

}  // namespace raycell
