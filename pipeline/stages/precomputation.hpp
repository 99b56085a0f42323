// Stage 2, precomputation: splits polygons into trapezes, with the values at their corners that the display
// needs (paper, section 2.2).
#pragma once

#include <vector>

#include "pipeline/stages/stage.hpp"

namespace raycell {

class Precomputation : public Stage {
  public:
    /// `rows`: those of its lane; trapezes that lie beside them are not made.
    Precomputation(sc_core::sc_module_name name, Environment& environment, Stretch rows)
        : Stage(name, environment), rows_(rows) {}
    sc_core::sc_port<LinkIn> in;
    sc_core::sc_port<LinkOut> out;

    /// Number of load messages in the stage itself.
    std::size_t holds() const { return item_ ? 1 : 0; }
    /// Its part of the wait-for graph.
    void add_places(WaitMap& map, const Link& input) const;
    void add_waits(WaitMap& map, const Link& input) const;

  private:
    Cycle step(Cycle now) override;
    void take(LoadItem& item);

    Stretch rows_;
    std::vector<Trapeze> trapezes_;  ///< of the polygon at work
    std::size_t next_ = 0;
    bool surface_sent_ = false;
    LoadItem* item_ = nullptr;  ///< the message to send
    Cycle ready_ = 0;
};

}  // namespace raycell
