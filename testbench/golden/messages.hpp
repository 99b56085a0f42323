// Messages as text: one list of fields for writing, reading and naming them.
#pragma once

#include <string>
#include <vector>

#include "cells/channels/message.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// A message as text: "ray FIELDS", "answer FIELDS", "features OBJECT", "span FIELDS", ...
/// (docs/reference/cell_tb.md).
std::string text_of(const Words& words, const Message& message);

/// Names of the fields of a message's tokens, of which the first is its kind ("ray", "answer", "span",
/// "features", "setup", "end_of_scene") and has no name.
std::vector<std::string> field_names(const std::vector<std::string>& tokens);

/// Reads a message from its tokens and takes its storage from `pools`. Throws GoldenError naming the field.
Message read_message(const Words& words, const std::vector<std::string>& tokens, MessagePools& pools);

}  // namespace raycell
