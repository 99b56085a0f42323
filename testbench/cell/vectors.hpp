// Scenarios as files of golden vectors.
#pragma once

#include <string>
#include <vector>

#include "testbench/cell/scenarios.hpp"
#include "testbench/common/new_file.hpp"

namespace raycell {

/// Whether --write names a folder.
inline bool is_folder(const std::string& write) { return !write.empty() && write.back() == '/'; }

/// `write` is the file of one scenario, or a folder for NAME.txt of each. Beside each are NAME.in.hex and
/// NAME.out.hex for $readmemh, unless its numbers are no words.
std::string vector_prefix(const std::string& write);
std::vector<std::string> vector_suffixes(const std::vector<Scenario>& scenarios, const std::string& write);
void write_vectors(const std::vector<Scenario>& scenarios, const std::string& write, OutputSet& outputs);

}  // namespace raycell
