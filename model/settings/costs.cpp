#include "model/settings/costs.hpp"

#include <charconv>
#include <stdexcept>

#include "model/settings/settings.hpp"

namespace raycell {

namespace {

struct Row {
    const char* name;
    std::uint32_t CostTable::*member;
    std::uint32_t cycles[4];  ///< word, wide, two, estimate
    bool counted;             ///< from a microprogram; otherwise an estimate, whatever the datapath
};

/// microcode_tb prints what it counts (--costs); a test compares.
constexpr Row rows[] = {
    {"walk_step", &CostTable::walk_step, {35, 33, 33, 4}, true},
    {"leave_cube", &CostTable::leave_cube, {27, 23, 23, 0}, true},
    {"compare_depth", &CostTable::compare_depth, {3, 3, 3, 1}, true},
    {"compare_interval", &CostTable::compare_interval, {3, 3, 3, 2}, true},
    {"enter_run", &CostTable::enter_run, {5, 4, 4, 0}, true},
    {"compare_plane", &CostTable::compare_plane, {46, 42, 40, 4}, true},
    {"compare_mask", &CostTable::compare_mask, {85, 79, 77, 5}, true},
    {"compare_edge", &CostTable::compare_edge, {47, 43, 41, 4}, true},
    {"per_edge", &CostTable::per_edge, {8, 6, 6, 2}, true},
    {"shade_setup", &CostTable::shade_setup, {67, 58, 56, 20}, true},
    {"normal_linear", &CostTable::normal_linear, {18, 12, 12, 7}, true},
    {"source_view", &CostTable::source_view, {47, 46, 44, 11}, true},
    {"ray_start", &CostTable::ray_start, {27, 27, 26, 0}, true},
    {"reflect", &CostTable::reflect, {39, 39, 37, 6}, true},
    {"refract", &CostTable::refract, {52, 48, 46, 12}, true},
    {"local_intensity", &CostTable::local_intensity, {24, 24, 21, 6}, true},
    {"per_lit_source", &CostTable::per_lit_source, {33, 33, 32, 14}, true},
    {"mirrored", &CostTable::mirrored, {39, 39, 37, 0}, true},
    {"light_again", &CostTable::light_again, {47, 46, 44, 0}, true},
    {"source_facing", &CostTable::source_facing, {5, 5, 4, 3}, true},
    {"source_emission", &CostTable::source_emission, {9, 9, 8, 4}, true},
    {"emitted", &CostTable::emitted, {6, 6, 6, 2}, true},
    {"sample_shift", &CostTable::sample_shift, {12, 12, 10, 6}, true},
    {"sample_place", &CostTable::sample_place, {31, 31, 25, 12}, true},
    {"disc_axes", &CostTable::disc_axes, {70, 70, 65, 20}, true},
    {"disc_place", &CostTable::disc_place, {80, 80, 74, 20}, true},
    {"per_lit_sample", &CostTable::per_lit_sample, {10, 10, 9, 4}, true},
    {"sample_mean", &CostTable::sample_mean, {8, 6, 6, 3}, true},
    {"reciprocal_newton", &CostTable::reciprocal_newton, {22, 22, 22, 4}, true},
    {"reciprocal_table", &CostTable::reciprocal_table, {16, 16, 16, 2}, true},
    {"reciprocal_rounded", &CostTable::reciprocal_rounded, {109, 109, 109, 20}, true},
    {"root_newton", &CostTable::root_newton, {29, 29, 29, 5}, true},
    {"root_table", &CostTable::root_table, {20, 20, 20, 2}, true},
    {"root_rounded", &CostTable::root_rounded, {221, 221, 221, 20}, true},
    {"power_tables", &CostTable::power_tables, {34, 32, 32, 6}, true},
    {"power_schlick", &CostTable::power_schlick, {11, 10, 10, 3}, true},
    {"power_rounded", &CostTable::power_rounded, {60, 60, 60, 60}, false},
    {"route_return", &CostTable::route_return, {3, 3, 3, 1}, true},
    {"backoff", &CostTable::backoff, {64, 64, 64, 64}, false},
    {"load_depth", &CostTable::load_depth, {126, 126, 126, 12}, true},
    {"load_interval", &CostTable::load_interval, {1901, 1776, 1746, 12}, true},
    {"load_plane", &CostTable::load_plane, {1919, 1791, 1761, 12}, true},
    {"load_mask", &CostTable::load_mask, {3164, 2890, 2841, 12}, true},
    {"load_edge", &CostTable::load_edge, {2089, 1922, 1886, 12}, true},
    {"load_order", &CostTable::load_order, {3, 3, 3, 1}, true},
    {"load_advance", &CostTable::load_advance, {7, 7, 7, 1}, true},
    {"load_forward", &CostTable::load_forward, {4, 4, 4, 1}, true},
    {"geometry_polygon", &CostTable::geometry_polygon, {40, 40, 40, 40}, false},
    {"geometry_skip", &CostTable::geometry_skip, {2, 2, 2, 2}, false},
    {"precomputation_trapeze", &CostTable::precomputation_trapeze, {20, 20, 20, 20}, false},
    {"distribution_span", &CostTable::distribution_span, {8, 8, 8, 8}, false},
    {"distribution_pass", &CostTable::distribution_pass, {1, 1, 1, 1}, false},
};

}  // namespace

CostTable::CostTable(CostBasis from) : basis(from) {
    for (const Row& row : rows) this->*row.member = row.cycles[int(from)];
}

std::vector<std::pair<std::string, std::uint32_t CostTable::*>> CostTable::entries() {
    std::vector<std::pair<std::string, std::uint32_t CostTable::*>> all;
    for (const Row& row : rows) all.emplace_back(row.name, row.member);
    return all;
}

std::vector<std::string> CostTable::counted() {
    std::vector<std::string> names;
    for (const Row& row : rows) {
        if (row.counted) names.emplace_back(row.name);
    }
    return names;
}

namespace {

std::uint32_t by_method(Iteration method, std::uint32_t newton, std::uint32_t table, std::uint32_t rounded) {
    return method == Iteration::newton ? newton : method == Iteration::table ? table : rounded;
}

}  // namespace

std::uint32_t CostTable::load_voxel(HitTest rung) const {
    switch (rung) {
        case HitTest::depth:
            return load_depth;
        case HitTest::interval:
            return load_interval;
        case HitTest::plane:
            return load_plane;
        case HitTest::mask:
            return load_mask;
        case HitTest::edge:
            break;
    }
    return load_edge;
}

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
        // What the estimates have no cycles for may be left out.
        const bool part = CostTable(CostBasis::estimate).*member == 0;
        const char* begin = assignment.data() + std::min(assignment.size(), equals + 1);
        const char* end = assignment.data() + assignment.size();
        const auto [stop, error] = std::from_chars(begin, end, cycles);
        if (equals == std::string::npos || begin == end || error != std::errc{} || stop != end ||
            cycles < (part ? 0 : 1) || cycles > 1000000) {
            throw std::invalid_argument("cost '" + assignment + "': expected NAME=CYCLES with " +
                                        (part ? "0" : "1") + " to 1000000 cycles");
        }
        this->*member = cycles;
        return;
    }
    std::string known;
    for (const auto& entry : entries()) known += (known.empty() ? "" : ", ") + entry.first;
    throw std::invalid_argument("unknown cost '" + name + "'; known are: " + known);
}

}  // namespace raycell
