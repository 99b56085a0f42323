// What a tested ray needs next.
#pragma once

#include "model/machine/message.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// The one answer to "what does this ray need next?", fixed when its test is over: the cell's step acts on
/// it, and waveforms, statistics, the wait-for graph and reports of stopped runs tell it. A ray that needs
/// nothing ends without a word: a precast ray that nothing blocked.
struct Need {
    enum class Kind : std::uint8_t {
        nothing,
        output,       ///< room behind the output over `side`, in buffer class `index`, and its wires
        response,     ///< an answer of kind `answer`: its way, or the ray store's port if this is its home
        border_walk,  ///< another test: it has left the cube and goes on to the border
        slot,         ///< a slot of the ray store, and its port; or the way of a notice that it is postponed
        shading_unit  ///< a hit that waits for no other ray
    };
    Kind kind = Kind::nothing;
    Side side : 2;            ///< of an output
    Answer::Kind answer : 2;  ///< of a response
    bool leaves : 1;          ///< over the array's border: an output there is the exterior's
    bool lost : 1;            ///< left the cube where nothing is beyond: the background answers
    std::uint8_t index = 0;   ///< class of an output's buffer
    Need() : side(Side::east), answer(Answer::Kind::intensity), leaves(false), lost(false) {}
};

/// `visit`: what the ray's test in cell (x, y) found.
Need need_of(const Ray& ray, const Visit& visit, const CellStore& store, int x, int y,
             const BufferClasses& classes, const Context& context);

}  // namespace raycell
