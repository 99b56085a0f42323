#include "cells/units/input_ports.hpp"

namespace raycell {

void InputPorts::elaborate(const BufferClasses& classes) {
    for (int side = 0; side < side_count; ++side) {
        Link* in = links_[std::size_t(side)];
        if (!in) continue;
        const bool horizontal = side % 2 == 0;
        for (int index = 0; index < classes.count; ++index) {
            std::uint32_t bits = classes.holds_answers(index) ? answer_bit(std::size_t(side)) : 0;
            // A ray that comes in at one side runs towards the opposite side.
            if (classes.holds_rays(index) && classes.used(index, horizontal, opposite(Side(side)))) {
                bits |= 1U << count_;
                inputs_[count_++] = RayInput(Side(side), in->place(index));
            }
            if (bits) in->watch(index, bits);
            if (classes.holds_answers(index)) answer_places_[std::size_t(side)] = in->place(index);
        }
    }
}

}  // namespace raycell
