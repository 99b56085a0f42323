#include "testbench/cell/scenarios.hpp"

namespace raycell {

std::vector<Scenario> all_scenarios() {
    std::vector<Scenario> all;
    for (const auto& part :
         {loading_scenarios(), routing_scenarios(), hit_scenarios(), waiting_scenarios(), turn_scenarios()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace raycell
