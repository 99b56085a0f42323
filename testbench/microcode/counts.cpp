#include "testbench/microcode/counts.hpp"

namespace raycell {

std::uint32_t table_cycles(const CostTable& costs, const MicroTrial& trial) {
    const MicroCost& cost = trial.cost();
    const OperatorSettings& operators = trial.operators();
    std::uint32_t cycles = std::uint32_t(cost.reciprocals) * costs.reciprocal(operators) +
                           std::uint32_t(cost.roots) * costs.root(operators) +
                           std::uint32_t(cost.powers) * costs.power(operators);
    if (cost.entry == "reciprocal") return costs.reciprocal(operators);
    if (cost.entry == "root") return costs.root(operators);
    if (cost.entry == "power") return costs.power(operators);
    for (const auto& [name, member] : CostTable::entries()) {
        if (name == cost.entry) cycles += costs.*member;
    }
    return cycles;
}

}  // namespace raycell
