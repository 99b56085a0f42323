// Bits of the feed: what lies between the scene's memory and the rows of cells.
#pragma once

#include "model/machine/message.hpp"

namespace raycell {

struct FeedBits {
    std::int64_t buffers = 0;    ///< of the links between the stages and down the rows
    std::int64_t registers = 0;  ///< messages that a stage or a distributor works on, surfaces that rows keep
    std::int64_t wires = 0;      ///< wires of these links, and of those into the rows
    std::int64_t total() const { return buffers + registers; }
};

/// Depth of the buffers between two stages before the rows, messages.
constexpr int feed_link_depth = 4;

/// Buffers are those of polygons with four corners; for one with more corners they would have to be wider.
FeedBits feed_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats);

}  // namespace raycell
