// Stage 1, geometry: sends the scene's tessellated polygons, clipped to the cube, to precomputation. The
// order is: sources and viewer, then the features and the polygons of each object, then the end-of-scene
// mark. With several lanes each has a geometry of its own, which sends what its rows need.
#pragma once

#include "model/loading/trapeze.hpp"
#include "pipeline/stages/stage.hpp"

namespace raycell {

class Geometry : public Stage {
  public:
    /// `rows`: those of its lane.
    Geometry(sc_core::sc_module_name name, Environment& environment, Stretch rows)
        : Stage(name, environment), rows_(rows) {}
    sc_core::sc_port<LinkOut> out;

    /// Begins to send the scene in the next cycle.
    void start() { environment().scheduler.wake(*this, environment().scheduler.now() + 1); }
    /// Number of the scene's polygons that are done: sent, or found to lie outside the cube.
    std::size_t polygons_taken() const { return polygon_; }
    /// Number of load messages in the stage itself.
    std::size_t holds() const { return item_ ? 1 : 0; }
    /// Its part of the wait-for graph.
    void add_places(WaitMap& map) const;
    void add_waits(WaitMap& map) const;

  private:
    Cycle step(Cycle now) override;
    /// The next item in the loading order; null after the end-of-scene mark.
    LoadItem* next_item();
    /// Passes over what has no part in the lane's rows. False if no polygon is left.
    bool find_polygon();

    Stretch rows_;
    std::size_t polygon_ = 0;       ///< index into the scene's polygons
    std::int64_t object_ = -1;      ///< whose features were sent
    std::size_t looked_up_to_ = 0;  ///< end of the object that was found to have a part in the rows
    bool setup_sent_ = false;
    bool end_sent_ = false;
    LoadItem* item_ = nullptr;
    Cycle ready_ = 0;
    std::uint64_t work_ = 0;  ///< cycles spent on the item
};

}  // namespace raycell
