#include "model/machine/second_store_bits.hpp"

#include <algorithm>

#include "model/machine/storage_bits.hpp"
#include "model/numbers/bits.hpp"

namespace raycell {

SecondStoreBits second_store_bits(const PictureSettings& picture, const MachineSettings& machine,
                                  const Formats& formats, const SourceCounts& sources, std::uint64_t store) {
    const MessageBits messages = message_bits(picture, machine, formats);
    const int longest = std::max({messages.longest_span(), messages.features, messages.setup(sources)});
    SecondStoreBits bits;
    bits.store = std::int64_t(store);
    bits.buffer = std::int64_t(longest) * machine.buffer_depth;
    bits.output = longest;
    // As for the other links (storage_bits.cpp): wires in and out.
    bits.control =
        bits_for(machine.buffer_depth + 1) + 2 * bits_for(link_cycles(longest, machine.link_bits) + 1) + 1;
    bits.latches = register_bits(picture, machine, formats, sources).latches;
    bits.wires = machine.link_bits;
    return bits;
}

}  // namespace raycell
