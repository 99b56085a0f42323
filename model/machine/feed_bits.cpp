#include "model/machine/feed_bits.hpp"

#include <algorithm>

namespace raycell {

FeedBits feed_bits(const PictureSettings& picture, const MachineSettings& machine, const Formats& formats) {
    const MessageBits bits = message_bits(picture, machine, formats);
    const std::int64_t polygon = bits.polygon + 4 * bits.vertex;
    const std::int64_t trapeze = std::max(bits.longest_trapeze(), bits.surface);
    const std::int64_t rows = picture.height;
    const std::int64_t lanes = std::min<std::int64_t>(machine.feed_lanes, rows);
    FeedBits feed;
    feed.buffers = lanes * feed_link_depth * (polygon + trapeze);
    feed.buffers += (rows - lanes) * machine.buffer_depth * trapeze;    // from the row above
    feed.buffers += rows * machine.buffer_depth * bits.longest_span();  // into the first cell
    feed.registers = lanes * (2 * polygon + trapeze);  // one in each stage, one on its way out
    feed.registers += rows * (bits.surface + trapeze + bits.longest_span());
    feed.wires = (lanes * 2 + rows - lanes) * machine.feed_bits + rows * machine.link_bits;
    return feed;
}

}  // namespace raycell
