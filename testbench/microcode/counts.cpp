#include "testbench/microcode/counts.hpp"

#include <algorithm>
#include <cmath>

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

namespace {

struct Counter {
    std::string datapath;
    std::uint64_t runs;
    std::uint64_t seed;
    std::map<std::string, std::uint32_t> entries;  ///< operators under their methods' names

    static std::string method_name(const std::string& name, const OperatorSettings& o) {
        const auto of = [](Iteration i) {
            return i == Iteration::newton ? "_newton" : i == Iteration::table ? "_table" : "_rounded";
        };
        if (name == "reciprocal") return name + of(o.reciprocal);
        if (name == "root") return name + of(o.root);
        if (name == "power") return name + (o.power == PowerMethod::tables ? "_tables" : "_schlick");
        return name;
    }

    MicroSetting setting_of(const OperatorSettings& o) const {
        MicroSetting setting;
        setting.numbers.operators = o;
        setting.extent = {128, 128, 200, 0.2};
        const int wide = widest_operand(setting.formats());
        for (const Datapath& path : datapaths(setting.numbers.word_bits, wide)) {
            if (path.name == datapath) setting.datapath = path;
        }
        return setting;
    }

    /// Whether an entry is counted into the table.
    static bool in_table(const std::string& entry) {
        const std::vector<std::string> counted = CostTable::counted();
        return std::find(counted.begin(), counted.end(), entry) != counted.end();
    }

    /// Adds the programs of `o` whose entries are, or are not, operators.
    void count(const OperatorSettings& o, bool operators) {
        std::map<std::string, double> sums;
        for (const auto& trial : micro_trials(setting_of(o))) {
            const MicroCost& cost = trial->cost();
            const std::string name = method_name(cost.entry, o);
            if (!in_table(name) || (name != cost.entry) != operators || entries.count(name) != 0) continue;
            double own = run_trial(*trial, runs, seed).mean;
            if (cost.reciprocals) own -= cost.reciprocals * double(entries.at(method_name("reciprocal", o)));
            if (cost.roots) own -= cost.roots * double(entries.at(method_name("root", o)));
            if (cost.powers) own -= cost.powers * double(entries.at(method_name("power", o)));
            sums[name] += cost.times * own;
            // A power may hold a reciprocal: it comes after it.
            if (operators) entries[name] = std::uint32_t(std::max(std::lround(own), 1L));
        }
        for (const auto& [name, sum] : sums) entries[name] = std::uint32_t(std::max(std::lround(sum), 1L));
    }
};

}  // namespace

std::map<std::string, std::uint32_t> count_costs(const std::string& datapath, std::uint64_t runs,
                                                 std::uint64_t seed) {
    Counter counter{datapath, runs, seed, {}};
    OperatorSettings tables;
    OperatorSettings schlick;
    schlick.power = PowerMethod::schlick;
    for (const Iteration method : {Iteration::newton, Iteration::table, Iteration::rounded}) {
        OperatorSettings o;
        o.reciprocal = o.root = method;
        counter.count(o, true);
    }
    counter.count(schlick, true);
    counter.count(tables, false);
    // The same programs.
    counter.entries["compare_depth"] = counter.entries.at("compare_interval");
    counter.entries["light_again"] = counter.entries.at("source_view");
    counter.entries["mirrored"] = counter.entries.at("reflect");
    return counter.entries;
}

}  // namespace raycell
