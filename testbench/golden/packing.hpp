// The bits of messages beside their words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cells/channels/message.hpp"
#include "model/machine/load_wire.hpp"
#include "model/machine/wire.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

class Packing {
  public:
    /// `context` must outlive it.
    Packing(const Context& context, const MachineSettings& machine);

    /// The bits of a message. None for exact arithmetic, whose numbers are no words, and for a field that has
    /// no code (a voxel's number that is too large).
    std::optional<WireBits> bits_of(const Message& message) const;
    /// The same in hexadecimal digits, first bit sent on the left; empty if there are none.
    std::string packed(const Message& message) const;
    /// The text (text_of) of the ray or answer with these digits. Throws GoldenError if they are none.
    std::string text_of_bits(const std::string& digits) const;

    /// Where a message differs from these digits (empty: nothing to compare with); else empty. Throws
    /// GoldenError if they are no message.
    std::string objection(const Message& message, const std::string& digits) const;

    /// The layouts, "ray type:3 x:20 ...", a line each; of a span with one edge, of the viewer's message with
    /// one source. None for exact arithmetic.
    std::vector<std::string> layouts() const;
    /// Bits of the widest message that bits_of() packs; 0 for exact arithmetic.
    int widest() const;

  private:
    WireBits pack(const Message& message) const;
    WireBits pack(const LoadItem& item) const;

    const Context& context_;
    Words words_;
    std::optional<Wire> wire_;
    std::optional<LoadWire> load_wire_;
};

}  // namespace raycell
