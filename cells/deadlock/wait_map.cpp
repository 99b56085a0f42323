#include "cells/deadlock/wait_map.hpp"

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

void WaitMap::write(ByteWriter& bytes) const {
    bytes.put(std::uint64_t(graph_.nodes().size()));
    for (const WaitGraph::Node& node : graph_.nodes()) {
        bytes.put(node.kind);
        bytes.put(node.x);
        bytes.put(node.y);
        bytes.put(node.side);
        bytes.put(node.since);
        bytes.put(node.what);
        bytes.put(node.holds);
    }
    bytes.put(std::uint64_t(places_.size()));
    for (const auto& [child, node] : places_) {
        const auto& [x, y, kind, slot, number] = child;
        bytes.put(x);
        bytes.put(y);
        bytes.put(kind);
        bytes.put(slot);
        bytes.put(number);
        bytes.put(node);
    }
}

void WaitMap::read(ByteReader& bytes) {
    const auto first = Index(graph_.nodes().size());
    for (auto nodes = bytes.get<std::uint64_t>(); nodes > 0; --nodes) {
        WaitGraph::Node node;
        node.kind = bytes.get<WaitGraph::Kind>();
        node.x = bytes.get<int>();
        node.y = bytes.get<int>();
        node.side = bytes.get<int>();
        node.since = bytes.get<std::uint64_t>();
        node.what = bytes.get_text();
        node.holds = bytes.get_text();
        graph_.add(std::move(node));
    }
    for (auto places = bytes.get<std::uint64_t>(); places > 0; --places) {
        const int x = bytes.get<int>();
        const int y = bytes.get<int>();
        const auto kind = bytes.get<RayKind>();
        const auto slot = bytes.get<std::uint32_t>();
        const auto number = bytes.get<unsigned>();
        places_[key(x, y, kind, slot, number)] = first + bytes.get<Index>();
    }
}

void WaitMap::write_waits(ByteWriter& bytes, Index first, Index end) const {
    bytes.put(first);
    bytes.put(end);
    for (Index i = first; i < end; ++i) {
        const WaitGraph::Node& node = graph_.nodes()[i];
        bytes.put(node.moves);
        bytes.put(node.all);
        bytes.put_all(node.waits_for);
        bytes.put(node.wants);
    }
}

void WaitMap::read_waits(ByteReader& bytes) {
    const auto first = bytes.get<Index>();
    const auto end = bytes.get<Index>();
    for (Index i = first; i < end; ++i) {
        Wants wants;
        wants.moves = bytes.get<bool>();
        wants.all = bytes.get<bool>();
        wants.on = bytes.get_all<Index>();
        wants.text = bytes.get_text();
        set(i, std::move(wants));
    }
}

std::string describe(const Ray& ray) {
    constexpr const char* kinds[] = {"primary", "reflected", "refracted", "shadow", "memo", "precast"};
    return std::string(kinds[int(ray.kind)]) + " ray " + ray_name(ray.id) + " of generation " +
           std::to_string(ray.generation);
}

std::string describe(const Answer& answer) {
    constexpr const char* kinds[] = {"intensity", "lit", "blocked", "postponed"};
    return std::string("answer '") + kinds[int(answer.kind)] + "' to ray " + ray_name(answer.id);
}

std::string describe(const LoadItem& item) {
    return std::string("load message '") + name_of(item.kind) + "'";
}

}  // namespace raycell
