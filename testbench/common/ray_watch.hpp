// The life of chosen rays and their children, as text: --watch-ray, --watch-pixel.
#pragma once

#include <iosfwd>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "cells/channels/observer.hpp"
#include "model/settings/settings.hpp"
#include "testbench/common/ray_lives.hpp"

namespace raycell {

/// Writes one line per event: cycle, cell, ray, what happened, indented by generation. Events are sorted by
/// cycle, then by cell, row by row (the exterior after all cells), then in the order in which the cell did
/// them, so the text does not depend on the order in which cells run. The wait of a ray or its answer is in
/// the line of the event that ended it, or in a line of its own.
class RayWatch : public CellObserver {
  public:
    /// `width`, `height`: of the array, cells.
    RayWatch(std::ostream& out, Networks networks, int width, int height)
        : out_(out), networks_(networks), width_(width), height_(height) {}

    /// Watches a ray and its descendants.
    void watch_ray(std::uint64_t id) { roots_.emplace(id, false); }
    /// Watches all rays of the tree of a pixel, by its index in the picture. Precast rays belong to no tree.
    void watch_pixel(std::uint64_t pixel) { pixels_.insert(pixel); }
    /// Writes the events of the last cycle and a line per ray. `now`: the run's last cycle.
    void finish(Cycle now);

    void cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                    std::uint32_t detail) override;
    void launched(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) override;
    void stalled(const Cell& cell, Cycle now, std::uint64_t ray, Stall cause, Cycle cycles) override;
    void exterior_answered(int x, int y, Cycle now, const Answer& answer) override;

  private:
    struct Line {
        std::size_t cell;
        std::uint64_t ray;
        std::string text;
    };

    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }
    void tell(std::size_t cell, int x, int y, Cycle now, const RayLife& life, const std::string& what);
    void flush();
    std::string what_happened(const Cell& cell, CellEvent event, std::uint32_t detail, RayLife& life) const;
    void summarise(const RayLife& life, Cycle now);

    std::ostream& out_;
    Networks networks_;
    int width_;
    int height_;
    std::map<std::uint64_t, bool> roots_;  ///< watched by id, and whether it was launched
    std::unordered_set<std::uint64_t> pixels_;
    RayLives lives_;
    Cycle cycle_ = 0;  ///< of lines_
    std::vector<Line> lines_;
};

struct RenderOptions;
/// The watch that the options ask for, null if they ask for none. Throws UsageError for what can't be
/// watched.
std::unique_ptr<RayWatch> watch_of(const RenderOptions& options, std::ostream& out);

/// Reads a ray's id in the form of ray_name(). False if the word has another form.
bool parse_ray(const std::string& word, std::uint64_t& id);

}  // namespace raycell
