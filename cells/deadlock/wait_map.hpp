// Builds a machine's wait-for graph: what each place holds, and where every ray is.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "cells/channels/message.hpp"
#include "cells/deadlock/wait_graph.hpp"
#include "cells/memory/bytes.hpp"

namespace raycell {

/// What a node waits for: other nodes, all or any of them, or nothing because it moves by itself.
struct Wants {
    bool moves = false;
    bool all = false;
    std::vector<WaitGraph::Index> on;
    std::string text;

    static Wants nothing(std::string why) { return {true, false, {}, std::move(why)}; }
};

/// Maps places and rays to nodes. First all places that hold something are added, then what each of them
/// waits for.
class WaitMap {
  public:
    using Index = WaitGraph::Index;

    /// Adds the place `number` of `owner` (a link's class, a cell's slot, ...).
    Index add(const void* owner, std::uint32_t number, WaitGraph::Node node);
    /// The node of a place; nothing if the place is empty.
    std::optional<Index> find(const void* owner, WaitGraph::Kind kind, std::uint32_t number) const;
    void set(Index node, Wants wants);

    /// Notes that a ray, or the answer to it, is at this node.
    void place(const Ray& ray, Index node) {
        places_[key(ray.home_x, ray.home_y, ray.kind, ray.slot, ray.child)] = node;
    }
    void place(const Answer& answer, Index node) {
        places_[key(answer.home_x, answer.home_y, answer.ray_kind, answer.slot, answer.child)] = node;
    }
    /// The node of the ray that a slot (or voxel) of the home cell sent as this child, or of the ray's
    /// answer.
    std::optional<Index> where(int home_x, int home_y, RayKind kind, std::uint32_t slot,
                               unsigned child) const;

    WaitGraph& graph() { return graph_; }

    // For a machine of several ranks: each rank writes its own places and reads those of the others.
    /// Writes all places and what they hold.
    void write(ByteWriter& bytes) const;
    /// Adds the places that another map wrote. They have no owners here.
    void read(ByteReader& bytes);
    /// Gives a node an owner here.
    void name(const void* owner, WaitGraph::Kind kind, std::uint32_t number, Index node) {
        owners_[{owner, kind, number}] = node;
    }
    /// Writes what the places `first` to `end` - 1 wait for.
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
