// Messages as text: one list of fields for writing, reading and naming them.
#pragma once

#include <string>
#include <vector>

#include "cells/channels/message.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// A message as text: its type, then the fields that its bits carry, in their order: "ray FIELDS",
/// "shadow_ray FIELDS", "intensity FIELDS", "lit FIELDS", ..., "span FIELDS" (docs/reference/cell_tb.md).
std::string text_of(const Words& words, const Message& message);

/// What the wires do not carry, as pairs of name and value: for the reader, and for the model's own replay.
std::string remarks_of(const Message& message);

/// Names of the fields of a message's tokens, of which the first is its type and has no name.
std::vector<std::string> field_names(const Words& words, const std::vector<std::string>& tokens);

/// What tells the kind of a shadow ray or of a verdict, beside the message.
struct KindRules {
    Shadows shadows = Shadows::per_hit;
    bool precast = false;  ///< the phase
};

/// Reads a message from its tokens and takes its storage from `pools`. Of the remarks it uses the id, and of
/// a span the object: 0 if they are missing. Throws GoldenError naming the field.
Message read_message(const Words& words, const std::vector<std::string>& tokens,
                     const std::vector<std::string>& remarks, const KindRules& rules, MessagePools& pools);

/// The first field in which two messages of one type differ; empty if there is none, or if they are of
/// different types.
std::string difference(const Words& words, const std::vector<std::string>& is,
                       const std::vector<std::string>& expected);
/// The same for any two lines of equally many tokens, from the second token on.
std::string difference(const std::vector<std::string>& is, const std::vector<std::string>& expected,
                       const std::vector<std::string>& names);

/// Returns its storage.
void give_back(const Message& message, MessagePools& pools);

}  // namespace raycell
