// What a tested ray needs next.
#pragma once

#include "model/machine/message.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// What a tested ray needs next. It is fixed when the ray's test is over. The cell's step acts on it;
/// waveforms, statistics, the wait-for graph and reports of stopped runs show it. A ray that needs nothing
/// ends without an answer: a precast ray that nothing blocked.
struct Need {
    enum class Kind : std::uint8_t {
        nothing,
        output,    ///< a free place behind the output over `side`, in buffer class `index`, and free wires
        response,  ///< the way for an answer of kind `answer`; the ray store's port if its home is this cell
        border_walk,  ///< another test: it has left the cube and continues to the border
        slot,         ///< a slot of the ray store, and its port; or else the way for a postponed notice
        shading_unit  ///< a hit that waits for no other ray
    };
    Kind kind = Kind::nothing;
    Side side : 2;            ///< of an output
    Answer::Kind answer : 2;  ///< of a response
    bool leaves : 1;          ///< over the array's border: the output leads to the exterior
    bool lost : 1;            ///< left the cube where nothing is beyond: answered with the background, or lit
    std::uint8_t index = 0;   ///< class of an output's buffer
    Need() : side(Side::east), answer(Answer::Kind::intensity), leaves(false), lost(false) {}
};

/// `visit`: what the ray's test in cell (x, y) found.
Need need_of(const Ray& ray, const Visit& visit, const CellStore& store, int x, int y,
             const BufferClasses& classes, const Context& context);

}  // namespace raycell
