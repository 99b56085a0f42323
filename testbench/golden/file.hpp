// Golden vectors as a file (docs/reference/cell_tb.md): what one cell is told, and what it does.
#pragma once

#include <array>
#include <istream>
#include <string>
#include <vector>

#include "cells/environment.hpp"
#include "testbench/golden/words.hpp"

namespace raycell {

/// One line after the head: something that the cell is told (in, free, phase, drain) or that it does (out,
/// take, pixel).
struct GoldenEvent {
    enum class What : std::uint8_t { in, free, phase, drain, out, take, pixel };
    static constexpr int load_link = side_count;  ///< an extra side: the link from the row's distributor
    What what = What::in;
    Cycle cycle = 0;
    int side = 0;
    int index = 0;   ///< buffer class
    int cycles = 0;  ///< in, out: cycles that the message takes on the link
    std::vector<std::string>
        tokens;             ///< the message; for a pixel its colour, for a phase its name, for drain 0 or 1
    int line = 0;           ///< line of the file; 0: none
    std::string bits = {};  ///< the message's, hexadecimal; empty: none
    int bit_count = 0;      ///< of `bits`, where a message was packed; 0: as read from a file
    std::vector<std::string> remarks = {};  ///< what the wires do not carry
    bool expected() const { return what >= What::out; }
};

/// "1234 out east 0 13 BITS ray ... ; REMARKS".
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
    bool traversal = false;                 ///< of the traversal unit alone
};

/// A head with this first line is read; no other version is.
constexpr const char* golden_version = "raycell-golden 2";
/// The line of the head that tells vectors of the traversal unit from those of a cell.
constexpr const char* traversal_part = "part traversal";
/// Stands where a message has no bits.
constexpr const char* no_bits = "-";
/// What stands behind it is a remark.
constexpr char remark_mark = ';';

/// The setup as lines, after those of the configuration (TOML). `context` must have the same picture settings
/// and scene.
std::string setup_text(const CellSetup& setup, const Context& context, const std::string& configuration);

struct GoldenFile {
    std::string name;           ///< for messages
    std::string configuration;  ///< TOML
    struct Line {
        int number = 0;
        std::vector<std::string> tokens;
        std::vector<std::string> remarks = {};
    };
    std::vector<Line> head;  ///< lines that read_setup() has to read
    bool traversal = false;  ///< of the traversal unit alone: `lines`; else of a cell: `events`
    std::vector<GoldenEvent> events;
    std::vector<Line> lines;
    Cycle last = 0;  ///< cycle in which the record ends
};

/// Reads all lines, leaving their numbers as text; `name` is for messages. Throws GoldenError "NAME:LINE:
/// what, what was allowed".
GoldenFile read_golden(std::istream& in, const std::string& name);

/// Reads the numbers of the head. `setup` must have picture and machine already, from the configuration.
/// Throws GoldenError if something is missing, a format differs, or the links are not those that the cell
/// uses.
void read_setup(const GoldenFile& file, CellSetup& setup);

}  // namespace raycell
