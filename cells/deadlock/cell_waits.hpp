// What a cell's buffers, slots and units wait for: the cell's part of the wait-for graph, read from outside.
// A ray's need is what the cell itself acts on (model/machine/need.hpp); what slots, answers and load
// messages wait for is written here a second time: whoever changes when they move changes it here.
#pragma once

#include "cells/cell.hpp"
#include "cells/deadlock/wait_map.hpp"

namespace raycell {

// All places of the array first, then what each waits for.
void add_places(const Cell& cell, WaitMap& map);
void add_waits(const Cell& cell, WaitMap& map);

/// Adds the buffer of a class at the end of a link, if it holds anything.
void add_buffer(WaitMap& map, const Link& link, int index, WaitGraph::Node node);
/// What a message waits for that wants to go over a link.
Wants wants_buffer(const WaitMap& map, const Link& out, int index, const std::string& name);

/// What stands in the cell, a line each: for reports of runs that stopped.
std::vector<std::string> describe_blocked(const Cell& cell);

}  // namespace raycell
