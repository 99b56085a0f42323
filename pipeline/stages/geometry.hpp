// Stage 1, geometry: hands the tessellated polygons of the scene, cut to the cube, to precomputation. First
// the sources and the viewer, then per object its features and its polygons, at last the end-of-scene mark.
#pragma once

#include "pipeline/stages/stage.hpp"

namespace raycell {

class Geometry : public Stage {
  public:
    Geometry(sc_core::sc_module_name name, Environment& environment) : Stage(name, environment) {}
    sc_core::sc_port<LinkOut> out;

    /// Begins with the scene in the next cycle.
    void start() { environment().scheduler.wake(*this, environment().scheduler.now() + 1); }
    /// Polygons of the scene that it is done with, sent on or found to lie outside the cube.
    std::size_t polygons_taken() const { return polygon_; }
    /// Load messages in no link.
    std::size_t holds() const { return item_ ? 1 : 0; }
    /// Its part of the wait-for graph.
    void add_places(WaitMap& map) const;
    void add_waits(WaitMap& map) const;

  private:
    Cycle step(Cycle now) override;
    /// The next item in the loading order; null behind the end-of-scene mark.
    LoadItem* next_item();

    std::size_t polygon_ = 0;  ///< index into the scene's polygons
    std::int64_t object_ = -1;
    bool setup_sent_ = false;
    bool end_sent_ = false;
    LoadItem* item_ = nullptr;
    Cycle ready_ = 0;
    std::uint64_t work_ = 0;  ///< cycles spent on the item
};

}  // namespace raycell
