// GTKWave's save file for a dump: a group for each scope, a radix for each signal.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "cells/probes/vcd_writer.hpp"

namespace raycell {

/// What GTKWave shows first; times in the unit of viewers (VcdWriter::display_time()).
struct SaveFileView {
    std::uint64_t from = 0;    ///< left edge
    std::uint64_t cycle = 1;   ///< length of a cycle; some hundred are shown
    std::int64_t marker = -1;  ///< time of the marker; -1: none
};

/// Returns the text of the save file. `name` is the name of the dump and of the save file, without folder and
/// extension. Scopes below the root are groups: the first is open, the others are closed. In each of them the
/// units come first, then the buffers, and the buffers of `quiet` ("cell_0_1.west.answer") last, in a group
/// of their own.
std::string gtkwave_save_file(const std::vector<VcdWriter::Declaration>& declarations,
                              const std::string& name, const SaveFileView& view,
                              const std::set<std::string>& quiet = {});

}  // namespace raycell
