// Builds a scenario: what a cell is told and what it has to do, in the order of the cycles.
#pragma once

#include <string>
#include <vector>

#include "testbench/cell/scenarios.hpp"
#include "testbench/golden/messages.hpp"

namespace raycell {

/// The words of all scenarios.
const Arithmetic& script_arithmetic();

/// Scenario of cell (1, 1) in the middle of 3x3: a cube 10 deep in 10 levels, the viewer at infinity, nothing
/// around the cube, otherwise the default machine, with the costs estimated by hand, one unit of a kind and
/// buffers of one message. The own ray sees the background unless something is loaded. Events may be added in
/// any order.
class Script {
  public:
    Script(std::string name, std::string says);

    CellSetup& setup() { return scenario_.setup; }

    // What the cell is told.
    Script& in(Cycle cycle, Side from, int index, int cycles, const Ray& ray);
    Script& in(Cycle cycle, Side from, int index, int cycles, const Answer& answer);
    Script& in(Cycle cycle, Side from, int cycles, const LoadItem& item);
    Script& free(Cycle cycle, Side towards, int index);
    Script& trace(Cycle first);
    Script& drain(Cycle cycle, bool on);  ///< new rays are held back, or not any more

    // What it has to do.
    Script& take(Cycle cycle, Side from, int index);
    Script& out(Cycle cycle, Side towards, int index, int cycles, const Ray& ray);
    Script& out(Cycle cycle, Side towards, int index, int cycles, const Answer& answer);
    Script& out(Cycle cycle, Side towards, int cycles, const LoadItem& item);
    Script& pixel(Cycle cycle, const dvec3& colour);

    /// Nothing else happens up to this cycle.
    Scenario until(Cycle last);

  private:
    Script& add(GoldenEvent::What what, Cycle cycle, Side side, int index, int cycles,
                const std::string& text);
    Script& add(GoldenEvent::What what, Cycle cycle, Side side, int index, int cycles, Message message);
    Scenario scenario_;
};

/// The span of a rectangle corner, corner + u, corner + u + v, corner + v (array coordinates) in row y, as it
/// arrives in the cell at `x` or, if it begins further east, in its first cell. Throws std::logic_error
/// unless the rectangle is one trapeze that meets the row.
LoadItem span_of(const CellSetup& setup, std::uint32_t polygon, const dvec3& corner, const dvec3& u,
                 const dvec3& v, int x, int y);
/// A load message without fields, or the features of an object.
LoadItem load_item(LoadItem::Kind kind, std::uint32_t object = 0);

}  // namespace raycell
