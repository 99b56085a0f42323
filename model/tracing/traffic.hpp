// Synthetic ray traffic: hits are drawn instead of found in a scene, so that the communication system can be
// studied apart from pictures. Machine, links, ray store and shading unit are the real ones.
#pragma once

#include "model/tracing/tracing.hpp"

namespace raycell {

enum class Directions {
    isotropic,  ///< all directions of the plane are equally likely
    axial,      ///< east, south, west, north
    diagonal,   ///< the four directions between them
    back        ///< isotropic, but a share of the children turns back, as between facing mirrors
};

/// Shares and probabilities are from 0 to 1.
struct TrafficSettings {
    double hit_probability = 0.1;  ///< of a ray in each cell that it enters
    double reflected = 1;          ///< probability that a hit has a reflected child
    double refracted = 0;          ///< probability that a hit has a refracted child
    int sources = 0;               ///< shadow rays of each hit, 0..max_sources
    Directions directions = Directions::back;
    double turn_back = 0.5;  ///< with `back`: share of the children that go back to the cell that their
                             ///< parent came from and hit there
    std::uint64_t seed = 1;
};

/// Draws what rays meet. Each draw is a hash of (seed, ray, cell, what is drawn), so it depends on the tree
/// alone, not on time: the untimed machine gives the same picture, bit for bit.
///
/// Each cell has one surface, which nearly fills it: a ray is not tested in the cell that it starts from.
/// Rays run in the plane of the array (dz = 0), so they end at a hit, or leave over the border and bring back
/// the background. A hit's intensity is a draw of its own, plus a share of that draw for every lit source,
/// plus half of each child's intensity.
class SyntheticTraffic {
  public:
    /// Throws std::invalid_argument naming the setting and what was allowed.
    explicit SyntheticTraffic(const TrafficSettings& settings);

    const TrafficSettings& settings() const { return settings_; }

    // With Context::traffic set, these replace the functions of the same names in tracing.hpp.
    Visit visit_cell(const CellStore& store, const Ray& ray, const Context& context) const;
    HitSetup set_up_hit(const Context& context, const CellStore& store, const Ray& ray, const CellHit& hit,
                        int x, int y) const;
    /// Sets place and direction of a primary ray; the rest of the ray must be complete.
    void start_primary(Ray& ray, const Context& context, int x, int y) const;
    /// Sets place and direction of a child, and the target cell of a child that turns back; the rest of the
    /// ray must be complete.
    void start_child(Ray& child, const Ray& parent, const Context& context, const CellStore& store,
                     const HitSetup& setup) const;
    dvec3 local_intensity(const HitSetup& setup, std::uint64_t lit) const;

    /// Puts the cell's surface into its store.
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
/// `generations`: number of generations after the primary ray, 0..62. All but the last may have to wait; with
/// sources, the last too.
PictureSettings traffic_picture(int width, int height, int generations);

/// An empty cube with the one material and the sources that traffic needs.
CellScene traffic_scene(const PictureSettings& picture, const TrafficSettings& traffic);

}  // namespace raycell
