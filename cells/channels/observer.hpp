// Interfaces of the observers of a run: probes, golden vectors, the life of a ray. They are told of each
// event in its own cycle. A run without observers costs one comparison with null per event.
#pragma once

#include <cstdint>

#include "cells/channels/message.hpp"
#include "cells/channels/stall.hpp"
#include "cells/clock/scheduler.hpp"

namespace raycell {

class Cell;
class Link;
enum class Phase : std::uint8_t;

/// What a cell does. The first seven make up the schedule's hash; their numbers must not change.
enum class CellEvent : std::uint32_t {
    load = 1,  ///< took a load message; detail: its LoadItem::Kind
    send,      ///< a ray or an answer left over a link; detail: side · 256 + class
    deliver,   ///< an answer came home; detail: Answer::Kind
    accept,    ///< a ray that hit took a slot; detail: the slot
    postpone,  ///< a ray that found no slot was destroyed
    shade,     ///< the shading unit finished a slot; detail: the slot
    test,      ///< the traversal unit began a ray's test; detail: its Visit::Event
    launch,    ///< a ray was launched, also again; detail: its RayKind
    answer,    ///< an answer set out for its home; detail: Answer::Kind
    direct,    ///< a hit that needs no slot went into the shading unit
    silent     ///< a precast ray reached its source: it ends without an answer
};

class CellObserver {
  public:
    virtual ~CellObserver() = default;
    /// `ray`: id of the ray concerned, for an answer that of the ray that it answers; 0 for loading.
    virtual void cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                            std::uint32_t detail) = 0;
    /// A ray is launched, also again; called before the event `launch`. `parent` is null for primary and
    /// precast rays.
    virtual void launched(const Cell& /*cell*/, Cycle /*now*/, const Ray& /*ray*/, const Ray* /*parent*/) {}
    /// A ray or its answer moves on after it has waited `cycles` in a cell.
    virtual void stalled(const Cell& /*cell*/, Cycle /*now*/, std::uint64_t /*ray*/, Stall /*cause*/,
                         Cycle /*cycles*/) {}
    /// The whole array begins a phase; `first` is its first cycle.
    virtual void phase_begins(Phase /*phase*/, Cycle /*first*/) {}
    /// From this cycle on cells send no new rays (`on`), or send them again (Environment::draining).
    virtual void draining(bool /*on*/, Cycle /*now*/) {}
    /// An exterior processor's answer starts over the border into cell (x, y).
    virtual void exterior_answered(int /*x*/, int /*y*/, Cycle /*now*/, const Answer& /*answer*/) {}
    /// A precast ray reached its source outside the array: it ends there without an answer.
    virtual void exterior_silent(Cycle /*now*/, std::uint64_t /*ray*/) {}
};

class LinkObserver {
  public:
    virtual ~LinkObserver() = default;
    /// A message of a class starts over the link's wires and is visible at the far end after `cycles`.
    virtual void sent(const Link& link, int index, const Message& message, int cycles, Cycle now) = 0;
    /// The oldest message of a class leaves the buffer at the far end.
    virtual void popped(const Link& link, int index, const Message& message, Cycle now) = 0;
};

}  // namespace raycell
