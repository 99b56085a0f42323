// GTKWave's save file for a dump: a group for each scope, a radix for each signal.
#pragma once

#include <string>
#include <vector>

#include "cells/probes/vcd_writer.hpp"

namespace raycell {

/// Returns the text of the save file. `name` is the name of the dump and of the save file, without folder and
/// extension. Scopes below the root are groups; the first group is open, the others are closed. The view
/// begins at `from` and shows some hundred cycles of length `cycle`, both in the unit of viewers
/// (VcdWriter::display_time()).
std::string gtkwave_save_file(const std::vector<VcdWriter::Declaration>& declarations,
                              const std::string& name, std::uint64_t from, std::uint64_t cycle);

}  // namespace raycell
