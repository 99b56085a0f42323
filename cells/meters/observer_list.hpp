// Several observers of one run.
#pragma once

#include <vector>

#include "cells/channels/observer.hpp"

namespace raycell {

/// Passes every event to all its members, in the order in which they were added.
class CellObserverList : public CellObserver {
  public:
    /// `observer` must outlive the run.
    void add(CellObserver& observer) { members_.push_back(&observer); }
    bool empty() const { return members_.empty(); }

    void cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                    std::uint32_t detail) override {
        for (CellObserver* member : members_) member->cell_event(cell, now, event, ray, detail);
    }
    void launched(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) override {
        for (CellObserver* member : members_) member->launched(cell, now, ray, parent);
    }
    void stalled(const Cell& cell, Cycle now, std::uint64_t ray, Stall cause, Cycle cycles) override {
        for (CellObserver* member : members_) member->stalled(cell, now, ray, cause, cycles);
    }
    void phase_begins(Phase phase, Cycle first) override {
        for (CellObserver* member : members_) member->phase_begins(phase, first);
    }
    void draining(bool on, Cycle now) override {
        for (CellObserver* member : members_) member->draining(on, now);
    }
    void exterior_silent(Cycle now, std::uint64_t ray) override {
        for (CellObserver* member : members_) member->exterior_silent(now, ray);
    }
    void exterior_answered(int x, int y, Cycle now, const Answer& answer) override {
        for (CellObserver* member : members_) member->exterior_answered(x, y, now, answer);
    }

  private:
    std::vector<CellObserver*> members_;
};

}  // namespace raycell
