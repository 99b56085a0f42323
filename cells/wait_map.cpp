#include "cells/wait_map.hpp"

namespace raycell {

WaitMap::Index WaitMap::add(const void* owner, std::uint32_t number, WaitGraph::Node node) {
    const WaitGraph::Kind kind = node.kind;
    const Index index = graph_.add(std::move(node));
    owners_[{owner, kind, number}] = index;
    return index;
}

std::optional<WaitMap::Index> WaitMap::find(const void* owner, WaitGraph::Kind kind,
                                            std::uint32_t number) const {
    const auto found = owners_.find({owner, kind, number});
    if (found == owners_.end()) return std::nullopt;
    return found->second;
}

void WaitMap::set(Index node, Wants wants) {
    WaitGraph::Node& n = graph_[node];
    n.moves = wants.moves;
    n.all = wants.all;
    n.waits_for = std::move(wants.on);
    n.wants = std::move(wants.text);
}

std::optional<WaitMap::Index> WaitMap::where(int home_x, int home_y, RayKind kind, std::uint32_t slot,
                                             unsigned child) const {
    const auto found = places_.find(key(home_x, home_y, kind, slot, child));
    if (found == places_.end()) return std::nullopt;
    return found->second;
}

std::string name_ray(std::uint64_t id) {
    return std::to_string(id >> 32) + "/" + std::to_string(id & 0xffffffffU);
}

std::string describe(const Ray& ray) {
    constexpr const char* kinds[] = {"primary", "reflected", "refracted", "shadow", "memo", "precast"};
    return std::string(kinds[int(ray.kind)]) + " ray " + name_ray(ray.id) + " of generation " +
           std::to_string(ray.generation);
}

std::string describe(const Answer& answer) {
    constexpr const char* kinds[] = {"intensity", "lit", "blocked", "postponed"};
    return std::string("answer '") + kinds[int(answer.kind)] + "' to ray " + name_ray(answer.id);
}

const char* name_of(Side side) {
    constexpr const char* names[] = {"east", "south", "west", "north"};
    return names[int(side)];
}

}  // namespace raycell
