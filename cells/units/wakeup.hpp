// When a cell must run again of itself.
#pragma once

#include <algorithm>

#include "cells/clock/scheduler.hpp"

namespace raycell {

/// The earliest cycle in which any of a cell's units has something to do without being woken by a link.
struct Wakeup {
    Cycle next = never;
    void at(Cycle cycle) { next = std::min(next, cycle); }
};

}  // namespace raycell
