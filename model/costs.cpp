#include "model/costs.hpp"

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
            {"route_return", &CostTable::route_return},
            {"backoff", &CostTable::backoff},
            {"load_voxel", &CostTable::load_voxel},
            {"load_forward", &CostTable::load_forward},
            {"geometry_polygon", &CostTable::geometry_polygon},
            {"precomputation_trapeze", &CostTable::precomputation_trapeze},
            {"distribution_span", &CostTable::distribution_span},
            {"distribution_pass", &CostTable::distribution_pass}};
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
