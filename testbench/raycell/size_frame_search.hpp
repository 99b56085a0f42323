// The search for the smallest machine that is accurate enough and renders a whole frame in so many cycles. It
// works on any model that runs machines.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbench/raycell/size_search.hpp"

namespace raycell {

/// An option of `raycell render` that the search chooses, and its values; more of it comes later.
struct FrameAxis {
    std::string option;
    std::vector<std::string> values;
    bool picture;  ///< the picture depends on it; otherwise only time and bits do
};

/// A machine: the index of each axis' value.
using FramePoint = std::vector<std::size_t>;

/// What a machine needs and gives.
struct FrameTrial {
    FramePoint point;
    Accuracy accuracy;
    std::uint64_t voxel_bits = 0;   ///< of the fullest cell
    std::uint64_t most_voxels = 0;  ///< in a cell
    std::uint64_t bits = 0;         ///< of a cell: buffers, slots, registers, voxels, its share of the feed
    std::string verdict;            ///< of a timed run; empty: it was not timed
    std::uint64_t load = 0;         ///< cycles
    std::uint64_t trace = 0;        ///< cycles, `precast` included
    std::string run;                ///< names the run
    bool meets = false;             ///< every goal; set by the search

    bool ended() const { return verdict == "completed"; }
    std::uint64_t cycles() const { return load + trace; }
};

struct FrameGoal {
    SizeGoal accuracy;
    std::uint64_t cycles = 0;  ///< at most, loading and trace

    bool met_by(const FrameTrial& t) const {
        return accuracy.met_by(t.accuracy) && t.ended() && t.cycles() <= cycles;
    }
    /// Whether there is an accuracy to reach.
    bool accurate() const { return accuracy.psnr_db > 0 || accuracy.wrong_hit_percent < 100; }
};

class FrameModel {
  public:
    virtual ~FrameModel() = default;
    /// Runs machines, in the order of the points; `timed`, or for accuracy and voxels alone.
    virtual std::vector<FrameTrial> run(const std::vector<FramePoint>& points, bool timed) const = 0;
    /// The fewest cycles in which a cell can make so many voxels with these settings.
    virtual std::uint64_t loading_floor(const FramePoint& point, std::uint64_t voxels) const = 0;
    /// The search begins a step; for showing how far it is.
    virtual void step_begins(const std::string& /*what*/) const {}
};

/// Searches from coarse to fine. First pictures by the untimed machine: how fine the polygons of curved
/// objects must be with the best of everything else, then every hit test, normals and shadows with those and
/// with the next finer ones. Of those that are accurate enough and could be loaded in time it runs the
/// smallest in the fastest machine; then it takes away from the smallest of those that are in time, option by
/// option, while the goals are met, until nothing one step smaller meets them. Every trial is a run; the
/// machine found is the smallest of all that were run and meet the goals.
class FrameSearch {
  public:
    /// Axes by name: tessellate-for, hit, normals, shadows, word-bits must be among them, with more than
    /// their options' least values last. `start`: the machine from which pictures are tried.
    FrameSearch(const FrameModel& model, const FrameGoal& goal, std::vector<FrameAxis> axes,
                FramePoint start);

    /// The smallest machine that meets the goals, if one was found. Call once.
    std::optional<FrameTrial> find();

    /// Every run, in order: the untimed ones first.
    const std::vector<FrameTrial>& tried() const { return tried_; }
    /// The run nearest to the goals: first accuracy, then cycles.
    const FrameTrial& nearest() const;

  private:
    std::size_t axis(const std::string& option) const;
    FramePoint at(FramePoint point, const std::string& option, std::size_t value) const;
    std::vector<FrameTrial> run(const std::vector<FramePoint>& points, bool timed);
    std::vector<FrameTrial> accurate_pictures();
    std::vector<FrameTrial> in_time(std::vector<FrameTrial> pictures);
    FrameTrial reduced(FrameTrial from);
    bool lower(FrameTrial& best, std::size_t axis);

    const FrameModel& model_;
    const FrameGoal goal_;
    const std::vector<FrameAxis> axes_;
    const FramePoint start_;
    std::vector<FrameTrial> tried_;
    std::map<std::pair<FramePoint, bool>, std::size_t> index_;  ///< point, timed: into tried_
};

/// For each trial whether it is on the Pareto front: timed and completed, and no other such trial is at least
/// as good in bits, cycles and dB and better in one of them.
std::vector<bool> pareto_front(const std::vector<FrameTrial>& trials);

}  // namespace raycell
