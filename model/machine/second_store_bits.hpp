// Bits that let a cell be loaded with the next frame while it traces this one.
#pragma once

#include "model/machine/message.hpp"

namespace raycell {

/// Of a cell with four neighbours, beside what it has without (storage_bits.hpp).
struct SecondStoreBits {
    std::int64_t store = 0;   ///< of voxels, and of spans until they are such: the fullest cell's
    std::int64_t buffer = 0;  ///< of load messages from the west
    std::int64_t output = 0;  ///< register of the load message that leaves to the east
    std::int64_t control =
        0;  ///< places behind the output, cycles until wires are free, which store is traced
    std::int64_t latches = 0;  ///< viewer, background and sources a second time
    std::int64_t wires = 0;    ///< of the link to the next cell of the row; no bits, so not in the total
    std::int64_t total() const { return store + buffer + output + control + latches; }
};

/// `store`: the most bits that a cell's memory of voxels holds, at any time of loading.
SecondStoreBits second_store_bits(const PictureSettings& picture, const MachineSettings& machine,
                                  const Formats& formats, const SourceCounts& sources, std::uint64_t store);

}  // namespace raycell
