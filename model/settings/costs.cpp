#include "model/settings/costs.hpp"

#include <charconv>
#include <stdexcept>

namespace raycell {

std::vector<std::pair<std::string, std::uint32_t CostTable::*>> CostTable::entries() {
    return {{"walk_step", &CostTable::walk_step},
            {"compare_depth", &CostTable::compare_depth},
            {"compare_interval", &CostTable::compare_interval},
            {"compare_plane", &CostTable::compare_plane},
            {"compare_mask", &CostTable::compare_mask},
            {"compare_edge", &CostTable::compare_edge},
            {"per_edge", &CostTable::per_edge},
            {"shade_setup", &CostTable::shade_setup},
            {"normal_linear", &CostTable::normal_linear},
            {"source_view", &CostTable::source_view},
            {"reflect", &CostTable::reflect},
            {"refract", &CostTable::refract},
            {"local_intensity", &CostTable::local_intensity},
            {"per_lit_source", &CostTable::per_lit_source},
            {"reciprocal_newton", &CostTable::reciprocal_newton},
            {"reciprocal_table", &CostTable::reciprocal_table},
            {"reciprocal_rounded", &CostTable::reciprocal_rounded},
            {"root_newton", &CostTable::root_newton},
            {"root_table", &CostTable::root_table},
            {"root_rounded", &CostTable::root_rounded},
            {"power_tables", &CostTable::power_tables},
            {"power_schlick", &CostTable::power_schlick},
            {"power_rounded", &CostTable::power_rounded},
            {"route_return", &CostTable::route_return},
            {"backoff", &CostTable::backoff},
            {"load_voxel", &CostTable::load_voxel},
            {"load_forward", &CostTable::load_forward},
            {"geometry_polygon", &CostTable::geometry_polygon},
            {"precomputation_trapeze", &CostTable::precomputation_trapeze},
            {"distribution_span", &CostTable::distribution_span},
            {"distribution_pass", &CostTable::distribution_pass}};
}

namespace {

std::uint32_t by_method(Iteration method, std::uint32_t newton, std::uint32_t table, std::uint32_t rounded) {
    return method == Iteration::newton ? newton : method == Iteration::table ? table : rounded;
}

}  // namespace

std::uint32_t CostTable::reciprocal(const OperatorSettings& operators) const {
    return by_method(operators.reciprocal, reciprocal_newton, reciprocal_table, reciprocal_rounded);
}

std::uint32_t CostTable::root(const OperatorSettings& operators) const {
    return by_method(operators.root, root_newton, root_table, root_rounded);
}

std::uint32_t CostTable::power(const OperatorSettings& operators) const {
    if (operators.power == PowerMethod::schlick) return power_schlick + reciprocal(operators);
    return operators.power == PowerMethod::tables ? power_tables : power_rounded;
}

void CostTable::set(const std::string& assignment) {
    const auto equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    for (const auto& [entry, member] : entries()) {
        if (entry != name) continue;
        std::uint32_t cycles = 0;
        const char* begin = assignment.data() + std::min(assignment.size(), equals + 1);
        const char* end = assignment.data() + assignment.size();
        const auto [stop, error] = std::from_chars(begin, end, cycles);
        if (equals == std::string::npos || begin == end || error != std::errc{} || stop != end ||
            cycles < 1 || cycles > 1000000) {
            throw std::invalid_argument("cost '" + assignment +
                                        "': expected NAME=CYCLES with 1 to 1000000 cycles");
        }
        this->*member = cycles;
        return;
    }
    std::string known;
    for (const auto& entry : entries()) known += (known.empty() ? "" : ", ") + entry.first;
    throw std::invalid_argument("unknown cost '" + name + "'; known are: " + known);
}

}  // namespace raycell
