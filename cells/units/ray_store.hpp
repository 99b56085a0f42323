// The ray store: M slots for rays that wait for answers (paper, section 4.2).
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "cells/channels/message.hpp"
#include "cells/clock/scheduler.hpp"
#include "cells/units/retry.hpp"

namespace raycell {

/// A ray that hit, and what its intensity still lacks.
struct Slot {
    enum class State : std::uint8_t { empty, to_set_up, in_setup, waiting, in_shading, to_answer };
    State state = State::empty;
    RayPacket* packet = nullptr;
    HitSetup setup;
    std::uint64_t to_ask = 0;   ///< sources whose shadow ray is still to be sent
    std::uint64_t awaited = 0;  ///< sources whose verdict is still to come (per-hit)
    std::uint64_t lit = 0;
    bool send_child[2] = {false, false};   ///< reflected, refracted: must be sent, also again
    bool await_child[2] = {false, false};  ///< its answer is still to come
    Retry retry[2];                        ///< after a postponement
    dvec3 colour[2] = {dvec3(0), dvec3(0)};
    RayPacket* child = nullptr;  ///< the child register: waits to leave the cell
    dvec3 result{0, 0, 0};
    Cycle since = 0;              ///< when the ray was accepted
    Cycle changed = 0;            ///< when it entered its state
    Wait wait;                    ///< for the shading unit, or of its reply for a way out
    std::uint32_t next_free = 0;  ///< in an empty slot: the slot that became free before it
};

/// Gives out slots (design, section 5). With `reserved`, each generation that may have to wait keeps one slot
/// for itself and the rest is free for all; if M is smaller than the number of these generations, the deepest
/// share the last slot. With `nested`, generations 0 to g together leave one slot for each deeper generation;
/// the deepest may take all.
class RayStore {
  public:
    RayStore(int capacity, int generations, Slots policy);

    /// Takes a slot for a ray of this generation; returns its index, or nothing if there is no room.
    std::optional<std::uint32_t> allocate(int generation);
    void release(std::uint32_t index, int generation);
    /// Whether allocate() would find a slot.
    bool has_room(int generation) const;
    /// Whether a ray of generation `wanting`, which has no room now, gets room when a ray of generation
    /// `held` gives back its slot; with `nested` perhaps only after several such slots are given back.
    bool would_help(int held, int wanting) const;

    Slot& operator[](std::uint32_t index) { return slots_[index]; }
    const Slot& operator[](std::uint32_t index) const { return slots_[index]; }
    /// Number of slots ever used: a scan need not look further.
    std::uint32_t touched() const { return std::uint32_t(slots_.size()); }
    int used() const { return used_; }
    int capacity() const { return capacity_; }
    int peak() const { return peak_; }
    /// Cycles that the rays now in the store have spent there.
    Cycle waiting_cycles(Cycle now) const;

  private:
    int group(int generation) const { return std::min(generation, groups_ - 1); }
    int used_by(int group) const { return used_by_ ? used_by_[group] : 0; }
    int borrowed() const;
    int full_from(int from) const;

    static constexpr std::uint32_t none = ~std::uint32_t(0);
    std::vector<Slot> slots_;                   ///< grows to `capacity`
    std::unique_ptr<std::uint16_t[]> used_by_;  ///< per group, once a slot has been given out
    std::uint32_t free_ = none;                 ///< the slot that became free last
    int capacity_;
    int shared_;      ///< slots beyond one for each group
    int groups_ = 0;  ///< none with policy `free`
    int used_ = 0;
    int peak_ = 0;
    bool nested_;
};

}  // namespace raycell
