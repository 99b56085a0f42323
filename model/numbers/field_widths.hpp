// Bits of the fields that messages, slots and voxels share. docs/reference/cell.md has the tables.
#pragma once

namespace raycell::field {

constexpr int type = 3;          ///< of a message
constexpr int polygon_id = 20;   ///< about a million polygons
constexpr int generation = 6;    ///< --max-depth up to 62
constexpr int child = 6;         ///< which child or source of a slot: up to 64
constexpr int age = 17;          ///< cycles, up to the starvation bound plus an epoch
constexpr int edge_count = 8;    ///< of a voxel's part: up to 255
constexpr int axis = 2;          ///< x, y or z
constexpr int edges = 3;         ///< of a trapeze or a span: up to four
constexpr int faces = 6;         ///< of the cube, a bit each
constexpr int vertices = 16;     ///< of a polygon
constexpr int source_count = 7;  ///< up to 64
constexpr int source_kind = 3;
constexpr int samples = 7;        ///< of a source, up to 64
constexpr int sample_place = 16;  ///< a fraction of the pattern's side
constexpr int level_count = 16;   ///< depth levels less one
constexpr int level_mantissa = 16;
constexpr int voxel_index = 10;  ///< up to 1024 voxels in a cell

}  // namespace raycell::field
