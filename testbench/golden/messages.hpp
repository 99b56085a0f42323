// Messages as text: one list of fields for writing, reading and naming them.
#pragma once

#include <string>
#include <vector>

#include "cells/channels/message.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// "ray FIELDS", "answer FIELDS", "features OBJECT", "span FIELDS", ... (docs/reference/cell_tb.md).
std::string text_of(const Words& words, const Message& message);

/// Names of the fields of a kind of message ("ray", "answer", "span", "features", "setup", "end_of_scene"),
/// the kind itself excluded. Outlines and edges beyond those there are have no fields: `span` names the first
/// ones only.
std::vector<std::string> field_names(const std::string& kind);

/// Reads the tokens of a message; what it holds is taken from `pools`. Throws GoldenError naming the field.
Message read_message(const Words& words, const std::vector<std::string>& tokens, MessagePools& pools);

}  // namespace raycell
