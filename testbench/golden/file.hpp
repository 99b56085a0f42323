// Golden vectors as a file (docs/reference/cell_tb.md): what one cell is told, and what it does.
#pragma once

#include <array>
#include <istream>
#include <string>
#include <vector>

#include "cells/environment.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// One line behind the head: something that the cell is told (in, free, phase, drain) or that it does (out,
/// take, pixel).
struct GoldenEvent {
    enum class What : std::uint8_t { in, free, phase, drain, out, take, pixel };
    static constexpr int load_link = side_count;  ///< a side of its own: the row's distributor
    What what = What::in;
    Cycle cycle = 0;
    int side = 0;
    int index = 0;   ///< buffer class
    int cycles = 0;  ///< in, out: that the message takes over the link
    std::vector<std::string>
        tokens;    ///< the message; of a pixel its colour, of a phase its name, of drain 0 or 1
    int line = 0;  ///< of the file, 0: none
    bool expected() const { return what >= What::out; }
};

/// "1234 out east 0 13 ray ...".
std::string text_of(const GoldenEvent& event);
const char* name_of_side(int side);

/// What a cell knows before anything happens.
struct CellSetup {
    PictureSettings picture;
    MachineSettings machine;
    CellScene scene;  ///< no polygons: they come as spans
    int x = 0;
    int y = 0;
    std::array<bool, side_count> linked{};  ///< sides with links, to a neighbour or to the exterior
};

/// The setup as lines, the configuration (TOML) in front; `context` is one of the same settings and scene.
std::string setup_text(const CellSetup& setup, const Context& context, const std::string& configuration);

struct GoldenFile {
    std::string name;           ///< for messages
    std::string configuration;  ///< TOML
    struct Line {
        int number = 0;
        std::vector<std::string> tokens;
    };
    std::vector<Line> head;  ///< what is left of it to be read
    std::vector<GoldenEvent> events;
    Cycle last = 0;  ///< cycle in which the record ends
};

/// Reads all lines, their numbers still as text; `name` is for messages. Throws GoldenError "NAME:LINE: what,
/// what was allowed".
GoldenFile read_golden(std::istream& in, const std::string& name);

/// Reads the head's numbers. `setup` has picture and machine already, as the configuration says. Throws
/// GoldenError where something is missing, formats are others, or there are no links where the cell would use
/// them.
void read_setup(const GoldenFile& file, CellSetup& setup);

}  // namespace raycell
