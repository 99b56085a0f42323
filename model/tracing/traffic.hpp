// Synthetic ray traffic: what rays meet is drawn instead of loaded, so that the communication system can be
// studied apart from pictures. Machine, links, ray store and shading unit are the real ones.
#pragma once

#include "model/tracing/tracing.hpp"

namespace raycell {

enum class Directions {
    isotropic,  ///< every direction of the plane alike
    axial,      ///< east, south, west, north
    diagonal,   ///< the four between them
    back        ///< isotropic, but a share of the children turns back, as between facing mirrors
};

/// Shares and probabilities are from 0 to 1.
struct TrafficSettings {
    double hit_probability = 0.1;  ///< of a ray in each cell that it enters
    double reflected = 1;          ///< probability that a hit has a reflected child
    double refracted = 0;          ///< the same, refracted
    int sources = 0;               ///< shadow rays of each hit, 0..max_sources
    Directions directions = Directions::back;
    double turn_back = 0.5;  ///< with `back`: share of the children that go back to the cell that their
                             ///< parent came from and hit there
    std::uint64_t seed = 1;
};

/// The draws. Each is a hash of (seed, ray, cell, what is drawn), so it depends on the tree alone, not on
/// when something happens: the untimed machine gives the same picture, bit for bit.
///
/// Each cell has one surface, which nearly fills it: a ray is not tested in the cell that it starts from.
/// Rays run in the plane of the array (dz = 0), so they end at a hit or over the border, where the background
/// answers. A hit's intensity is its own draw, a share of it for every lit source, and half of each child's.
class SyntheticTraffic {
  public:
    /// Throws std::invalid_argument naming the setting and what was allowed.
    explicit SyntheticTraffic(const TrafficSettings& settings);

    const TrafficSettings& settings() const { return settings_; }

    // What tracing.hpp's functions of these names do when Context::traffic is set.
    Visit visit_cell(const CellStore& store, const Ray& ray, const Context& context) const;
    HitSetup set_up_hit(const Context& context, const CellStore& store, const Ray& ray, const CellHit& hit,
                        int x, int y) const;
    /// Place and direction of a primary ray, which is complete but for them.
    void start_primary(Ray& ray, const Context& context, int x, int y) const;
    /// Place, direction and, for one that turns back, aim of a child, which is complete but for them.
    void start_child(Ray& child, const Ray& parent, const Context& context, const CellStore& store,
                     const HitSetup& setup) const;
    dvec3 local_intensity(const HitSetup& setup, std::uint64_t lit) const;

    /// Gives a loaded cell its surface.
    static void furnish(CellStore& store, const Frame& frame, int x, int y);

  private:
    enum class Draw : std::uint32_t { hit, place, place_y, direction, turn, reflect, refract, intensity };
    /// Uniform in [0, 1).
    double draw(Draw what, std::uint64_t ray, std::uint32_t cell, std::uint32_t count = 0) const;
    dvec3 direction(std::uint64_t ray, std::uint32_t cell) const;
    bool turns_back(const Ray& child, std::uint32_t cell) const;

    TrafficSettings settings_;
};

/// The settings that traffic runs with: exact arithmetic, no exterior, a shadow ray per hit and source.
/// `generations`: of rays after the primary one, 0..62; they (and the last too, with sources) may have to
/// wait.
PictureSettings traffic_picture(int width, int height, int generations);

/// An empty cube with the one material and the sources that traffic needs.
CellScene traffic_scene(const PictureSettings& picture, const TrafficSettings& traffic);

}  // namespace raycell
