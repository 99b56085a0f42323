// GTKWave's save file beside a dump: groups as the dump's scopes, a radix for each signal.
#pragma once

#include <string>
#include <vector>

#include "cells/probes/vcd_writer.hpp"

namespace raycell {

/// `name`: the dump's file without folder and ending, the save file's too. Scopes below the first one are
/// groups; in the first group all is open, of the others one sees the name until one opens them. The view
/// begins at `from` and shows some hundred cycles of `cycle` each, both in the unit that viewers count in.
std::string gtkwave_save_file(const std::vector<VcdWriter::Declaration>& declarations,
                              const std::string& name, std::uint64_t from, std::uint64_t cycle);

}  // namespace raycell
