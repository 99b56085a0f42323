// What became of rays: when each was launched, where it ended, what it and its answer hopped and waited.
#pragma once

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "cells/channels/observer.hpp"

namespace raycell {

/// A ray from its first launch to its answer at home.
struct RayLife {
    static constexpr std::size_t no_parent = ~std::size_t(0);
    /// What the ray ended in; a ray that is still on its way has none.
    enum class End : std::uint8_t { none, hit, background, lit, blocked, exterior, silent };

    std::uint64_t id = 0;
    std::size_t parent = no_parent;  ///< its index among the lives
    RayKind kind = RayKind::primary;
    End end = End::none;
    int generation = 0;
    int depth = 0;  ///< number of its ancestors that are known
    int x = 0;      ///< home: the cell that sent it
    int y = 0;
    int last_x = 0;  ///< cell of its last test
    int last_y = 0;
    Cycle launched = 0;  ///< the first time
    Cycle ended = never;
    std::uint64_t ray_hops = 0;
    std::uint64_t answer_hops = 0;
    std::uint64_t postponed = 0;  ///< times
    /// Rays of this id on their way. With memo, the rays of one pixel from voxels of the same number share
    /// an id.
    int open = 1;
    bool answering = false;  ///< the ray has ended, its answer is on its way
    std::array<Cycle, stall_causes + 1> waited{};

    Cycle waited_in_all() const;
};

constexpr const char* end_names[] = {"", "hit", "background", "lit", "blocked", "exterior", "silent"};
constexpr const char* ray_kind_names[] = {"primary", "reflected", "refracted", "shadow", "memo", "precast"};

/// The lives of rays, kept up to date from a run's events. Who uses it decides which rays are in it.
class RayLives {
  public:
    /// Null if the ray is not in it.
    RayLife* find(std::uint64_t id);
    /// A ray is launched again. False if it is not in it.
    bool again(std::uint64_t id);
    /// Adds a ray that is launched for the first time in `cell`.
    void add(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent);
    /// Takes in an event of a ray that is in it.
    static void note(RayLife& life, const Cell& cell, Cycle now, CellEvent event, std::uint32_t detail);
    static void from_exterior(RayLife& life);
    static void silent_outside(RayLife& life, Cycle now);

    const std::vector<RayLife>& all() const { return lives_; }
    /// Indices in the order of first launch, then home cell (row by row), then id: it does not depend on the
    /// order in which cells run.
    std::vector<std::size_t> in_order() const;

  private:
    std::unordered_map<std::uint64_t, std::size_t> known_;  ///< index of a ray in lives_
    std::vector<RayLife> lives_;
};

}  // namespace raycell
