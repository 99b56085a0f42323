// What a search for accuracy and cycles found: as text, CSV, JSON and chart.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbench/raycell/size_frame_search.hpp"

namespace raycell {

/// All members but the timed runs' chart are about every trial, in the order in which they were made.
class FrameReport {
  public:
    FrameReport(const std::vector<FrameAxis>& axes, const std::vector<FrameTrial>& trials,
                const FrameGoal& goal);

    std::string csv() const;
    /// goal, reached, found or nearest, tried[].
    std::string json(const std::optional<FrameTrial>& found, const FrameTrial& nearest) const;
    /// Cycles against bits and against dB; the front's machines filled, the one found marked.
    std::string chart(const std::optional<FrameTrial>& found) const;
    /// The machines of the Pareto front, by cycles.
    std::string front_table() const;
    /// "hit edge, ..., 12345 bits a cell, 23456 cycles, 40.1 dB"
    std::string words_for(const FrameTrial& trial) const;

  private:
    const std::vector<FrameAxis>& axes_;
    const std::vector<FrameTrial>& trials_;
    const FrameGoal goal_;
    const std::vector<bool> front_;
};

}  // namespace raycell
