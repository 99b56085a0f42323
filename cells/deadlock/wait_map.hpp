// Builds a machine's wait-for graph: who holds what, and where every ray under way is.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "cells/channels/message.hpp"
#include "cells/deadlock/wait_graph.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// What something waits for: nodes, all or any of them, or nothing because it moves by itself.
struct Wants {
    bool moves = false;
    bool all = false;
    std::vector<WaitGraph::Index> on;
    std::string text;

    static Wants nothing(std::string why) { return {true, false, {}, std::move(why)}; }
};

/// First every place that holds something is added, with what it holds; then what each waits for.
class WaitMap {
  public:
    using Index = WaitGraph::Index;

    /// Adds the place `number` of `owner` (a link's class, a cell's slot, ...).
    Index add(const void* owner, std::uint32_t number, WaitGraph::Node node);
    /// Nothing for a place that is empty.
    std::optional<Index> find(const void* owner, WaitGraph::Kind kind, std::uint32_t number) const;
    void set(Index node, Wants wants);

    /// A ray, or an answer on its way home, is at this node.
    void place(const Ray& ray, Index node) {
        places_[key(ray.home_x, ray.home_y, ray.kind, ray.slot, ray.child)] = node;
    }
    void place(const Answer& answer, Index node) {
        places_[key(answer.home_x, answer.home_y, answer.ray_kind, answer.slot, answer.child)] = node;
    }
    /// Where the ray is that this cell's slot (or voxel) sent as this child, or its answer.
    std::optional<Index> where(int home_x, int home_y, RayKind kind, std::uint32_t slot,
                               unsigned child) const;

    WaitGraph& graph() { return graph_; }

    // For a machine that several ranks simulate: each writes the places of its own and reads the others'.
    /// All places and what stands there.
    void write(ByteWriter& bytes) const;
    /// Adds what another map wrote. Its places have no owners here.
    void read(ByteReader& bytes);
    /// Makes a place known here as this owner's.
    void name(const void* owner, WaitGraph::Kind kind, std::uint32_t number, Index node) {
        owners_[{owner, kind, number}] = node;
    }
    /// What the places [first, end) wait for.
    void write_waits(ByteWriter& bytes, Index first, Index end) const;
    void read_waits(ByteReader& bytes);

  private:
    using Owner = std::tuple<const void*, WaitGraph::Kind, std::uint32_t>;
    using Child = std::tuple<int, int, RayKind, std::uint32_t, unsigned>;
    static Child key(int x, int y, RayKind kind, std::uint32_t slot, unsigned child) {
        return {x, y, kind, slot, child};
    }

    WaitGraph graph_;
    std::map<Owner, Index> owners_;
    std::map<Child, Index> places_;
};

std::string describe(const Ray& ray);
std::string describe(const Answer& answer);
std::string describe(const LoadItem& item);

}  // namespace raycell
