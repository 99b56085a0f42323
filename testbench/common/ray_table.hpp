// --rays: every ray of a run as a line of a table.
#pragma once

#include <string>

#include "cells/channels/observer.hpp"
#include "testbench/common/ray_lives.hpp"

namespace raycell {

/// Keeps the life of every ray, some 250 bytes each.
class RayTable : public CellObserver {
  public:
    void cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                    std::uint32_t detail) override;
    void launched(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) override;
    void stalled(const Cell& cell, Cycle now, std::uint64_t ray, Stall cause, Cycle cycles) override;
    void exterior_answered(int x, int y, Cycle now, const Answer& answer) override;
    void exterior_silent(Cycle now, std::uint64_t ray) override;

    /// The file PREFIX.rays.csv, ordered by the cycle of the launch, then by home cell. docs/use/results.md
    /// describes the columns.
    std::string csv() const;

  private:
    RayLives lives_;
};

}  // namespace raycell
