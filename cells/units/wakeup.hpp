// When a cell must run again without being woken.
#pragma once

#include <algorithm>

#include "cells/clock/scheduler.hpp"

namespace raycell {

/// The earliest cycle in which a unit of the cell has work, without a wake by a link.
struct Wakeup {
    Cycle next = never;
    void at(Cycle cycle) { next = std::min(next, cycle); }
};

}  // namespace raycell
