// The untimed machine: the same cells, voxels and rays, recursive and without SystemC. It is the golden
// reference of the timed one: their pictures are equal bit for bit.
#pragma once

#include <functional>
#include <vector>

#include "model/loading/loading.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// Rays by kind, as the JSON reports them.
struct RayCounts {
    std::uint64_t primary = 0;
    std::uint64_t reflected = 0;
    std::uint64_t refracted = 0;
    std::uint64_t shadow = 0;  ///< per hit or memo
    std::uint64_t precast = 0;
    std::uint64_t lost = 0;      ///< left the cube with nothing beyond, or with --exterior none
    std::uint64_t exterior = 0;  ///< handed to the exterior processors
    std::uint64_t ties = 0;      ///< hits at the same distance as another, including those of rays sent again
    std::uint64_t ray_hops = 0;
    std::uint64_t return_hops = 0;
};

void count_ray(RayCounts& counts, RayKind kind);

class UntimedMachine {
  public:
    /// Loads the array. `exterior` may be null if settings.exterior is none or nothing is traced. With
    /// `traffic`, hits are drawn at random. The scene and `traffic` must outlive the machine; the settings
    /// are copied. Throws std::invalid_argument if a needed exterior is missing.
    UntimedMachine(const CellScene& scene, const PictureSettings& settings, const ExteriorTracer* exterior,
                   const SyntheticTraffic* traffic = nullptr);

    /// Traces (or, with --stage load, displays) every pixel; `progress` is called after each row.
    Picture render(const std::function<void(int row)>& progress = {});

    const RayCounts& rays() const { return rays_; }
    /// Hops of rays and answers before tracing began.
    std::uint64_t precast_hops() const { return precast_hops_; }
    const LoadCounts& loaded() const { return loaded_; }
    const std::vector<CellStore>& cells() const { return cells_; }
    StorageCounts storage() const;
    const Context& context() const { return context_; }

  private:
    struct Answer {
        dvec3 colour{0, 0, 0};
        bool blocked = false;
    };
    struct Place {
        int x;
        int y;
    };

    void trace_pixel(Pixel& pixel, int x, int y, int number);
    void precast();
    Answer trace(Ray ray, int x, int y, Pixel* pixel);
    Answer leave(const Ray& ray, Face face, const Crossing& crossing, Place at, Pixel* pixel);
    Answer answer_hit(const Ray& ray, const CellHit& hit, Place at, Pixel* pixel);
    bool source_visible(const Ray& ray, const CellHit& hit, const HitSetup& setup, std::size_t source,
                        Place at, Pixel* pixel);
    CellStore& cell(Place at) {
        return cells_[std::size_t(at.y) * std::size_t(context_.scene.frame.width) + std::size_t(at.x)];
    }
    bool in_array(Place at) const;
    void count_return(const Ray& ray, Place from, Pixel* pixel);

    const PictureSettings settings_;
    Context context_;
    const ExteriorTracer* exterior_;
    LoadCounts loaded_;
    std::vector<CellStore> cells_;
    RayCounts rays_;
    std::uint64_t precast_hops_ = 0;
};

}  // namespace raycell
