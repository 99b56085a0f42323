// The counters and the observer of a run: all that the cells of an array report goes through them.
#pragma once

#include <vector>

#include "cells/channels/observer.hpp"
#include "cells/meters/counters.hpp"
#include "cells/meters/ledger.hpp"
#include "model/numbers/hash.hpp"

namespace raycell {

/// The meters of an array.
struct Meters {
    Counters counters;
    /// Hops per pixel, for Pixel::hops. Kept apart from the picture, because every hop of a traced ray writes
    /// here and a picture is larger than a cache.
    std::vector<std::uint32_t> pixel_hops;
    Ledger ledger;
    CellObserver* observer = nullptr;  ///< told of every cell's events; null: none
};

/// The meter of one cell: its statistics and the hash of its schedule. It adds to the array's counters too.
class CellMeter {
  public:
    const CellStatistics& statistics() const { return statistics_; }
    std::uint64_t hash() const { return hash_.value(); }
    /// Restores the state after loading, from a saved array.
    void restore(std::uint64_t hash, std::uint64_t load_hops, std::uint64_t loading_cycles) {
        hash_ = Fnv(hash);
        statistics_.load_hops = load_hops;
        statistics_.loading_cycles = loading_cycles;
    }

    /// Adds (cycle, event, detail) to the hash of the cell's schedule. The array joins the hashes in the
    /// order of its cells.
    void note(Cycle now, CellEvent event, std::uint32_t detail) {
        for (const std::uint64_t word : {now, std::uint64_t(event), std::uint64_t(detail)}) hash_.add(word);
    }
    /// A load message was taken; it ends here (`ends`) or moves on.
    void load_passed(Counters& all, bool ends) {
        if (ends) {
            ++all.loads_delivered;
        } else {
            ++all.load_hops;
            ++statistics_.load_hops;
        }
    }
    /// A span is kept, whose voxel takes `cycles` cycles.
    void kept(Cycle cycles) { statistics_.loading_cycles += cycles; }
    /// The end-of-scene mark has passed and the cell's last voxel is made.
    void loaded(Counters& all, Cycle now) {
        ++all.cells_loaded;
        all.last_progress = now;
    }
    /// A ray's test of `cycles` cycles began.
    void tested(Counters& all, const Visit& visit, std::uint32_t cycles) {
        all.rays.ties += visit.event == Visit::Event::hit && visit.hit.tied;
        all.traversal_cycles += cycles;
        statistics_.traversal_cycles += cycles;
    }
    /// A ray left, to a neighbour or over the array's border. A hop over the border counts as a return hop.
    void ray_left(Counters& all, bool over_border) {
        if (over_border) {
            ++all.rays.exterior;
            ++all.rays.return_hops;
            ++statistics_.return_hops;
        } else {
            ++all.rays.ray_hops;
            ++statistics_.ray_hops;
        }
    }
    void answer_left(Counters& all) {
        ++all.rays.return_hops;
        ++statistics_.return_hops;
    }
    /// An answer has come home.
    void delivered(Counters& all, Answer::Kind kind, Cycle now) {
        ++all.answers_delivered;
        if (kind != Answer::Kind::postponed) all.last_progress = now;
    }
    void postponed(Counters& all) {
        ++all.rays_destroyed;
        ++statistics_.postponed;
    }
    void ended_silently(Counters& all, Cycle now) {
        ++all.rays_silent;
        all.last_progress = now;
    }
    /// A job of the shading unit began.
    void shaded(Counters& all, std::uint32_t cycles) {
        all.shading_cycles += cycles;
        statistics_.shading_cycles += cycles;
    }
    /// A slot is free again after it was taken for `cycles` cycles.
    void slot_left(Counters& all, Cycle cycles) {
        all.slot_cycles += cycles;
        statistics_.slot_cycles += cycles;
        --all.slots_used;
    }
    void stalled(Stall cause, Cycle cycles) { statistics_.stalls[cause] += cycles; }

  private:
    friend class Prefetch;
    Fnv hash_{0};
    CellStatistics statistics_;
};

}  // namespace raycell
