// Scripted scenarios for one cell: what it is told, what it has to do, and in which cycles.
#pragma once

#include <string>
#include <vector>

#include "testbench/golden/file.hpp"

namespace raycell {

struct Scenario {
    std::string name;
    std::string says;  ///< a sentence: what it shows
    CellSetup setup;
    std::vector<GoldenEvent> events;
    Cycle last = 0;
};

/// All of them, in the order of a cell's life.
std::vector<Scenario> all_scenarios();

// The parts of all_scenarios(), a file each.
std::vector<Scenario> loading_scenarios();
std::vector<Scenario> routing_scenarios();
std::vector<Scenario> hit_scenarios();
std::vector<Scenario> waiting_scenarios();
std::vector<Scenario> turn_scenarios();

}  // namespace raycell
