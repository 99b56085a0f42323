// What a cell's buffers, slots and units wait for: the cell's part of the wait-for graph, read from outside.
// A ray's need is the one that the cell itself acts on (model/machine/need.hpp). The rules for slots, answers
// and load messages are repeated here: a change of when they move must be made here too.
#pragma once

#include "cells/cell.hpp"
#include "cells/deadlock/wait_map.hpp"

namespace raycell {

// To be called in this order: add_places() for all cells of the array, then add_waits().
void add_places(const Cell& cell, WaitMap& map);
void add_waits(const Cell& cell, WaitMap& map);

/// Adds the buffer of a class at the end of a link, if it holds a message.
void add_buffer(WaitMap& map, const Link& link, int index, WaitGraph::Node node);
/// What a message that wants to go over a link waits for.
Wants wants_buffer(const WaitMap& map, const Link& out, int index, const std::string& name);

/// The messages in the cell, one line each, for reports of runs that stopped.
std::vector<std::string> describe_blocked(const Cell& cell);

}  // namespace raycell
