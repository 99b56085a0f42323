// --film: where messages, rays and voxels are in the array, at some hundred moments of a run.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/machine.hpp"

namespace raycell {

/// Coarse maps of the array, one half of the frames for loading and one for precast and trace, each half at
/// equal distances in time. The distance begins with one cycle and doubles whenever there would be more
/// frames than wanted, so the run's length need not be known.
class Film {
  public:
    /// At most `frames` frames, at least 4; a multiple of 4 is used in full. The machine must outlive it and
    /// have the whole array.
    Film(Machine& machine, int frames);

    /// To be called before each cycle `now` that is run: the array has been as it is since the cycle before.
    void before(Cycle now);
    /// The run is over; `last`: its last cycle.
    void finish(Cycle last);
    /// The file PREFIX.film.json; docs/use/results.md describes its keys.
    std::string json() const;

    /// Blocks of cells that the larger side of the array is divided into, at most.
    static constexpr int most_blocks = 64;

  private:
    enum Layer : std::size_t { loads, voxels, rays, answers, slots, pixels_done, layer_count };
    using Map = std::vector<std::uint32_t>;
    struct Frame {
        Cycle cycle = 0;
        Phase phase = Phase::load;
        std::array<Map, layer_count> maps;
    };

    /// The frames of loading, or those of what follows.
    struct Reel {
        std::vector<Frame> frames;
        Cycle interval = 1;
        Cycle next = never;  ///< cycle of the next frame; `never`: it has not begun
    };

    Reel& current();
    void take(Reel& reel, Cycle cycle) const;
    void add_messages(Frame& frame, const Cell& cell, std::size_t block) const;
    static void thin_out(Reel& reel);

    Machine& machine_;
    std::size_t most_;  ///< frames of a reel
    int block_;         ///< cells along a block's side
    int columns_;
    int rows_;
    std::array<Reel, 2> reels_;
};

}  // namespace raycell
