// What the units of a cell pass to each other.
package raycell_cell;
  import raycell_pkg::*;

  localparam int SIDES = 4;
  localparam int EAST = 0, SOUTH = 1, WEST = 2, NORTH = 3;  // also the order wherever one is needed
  localparam int LOAD_LINK = 4;  // from the row's distributor, in the first column

  // Places of rays: the buffers by side and class, then the own ray's register.
  localparam int PLACES = SIDES * RAY_CLASSES + 1;
  localparam int OWN = PLACES - 1;
  localparam int PLACE_INDEX_BITS = $clog2(PLACES + 1);

  localparam int TIME_BITS = 48;
  typedef logic [47:0] time_t;

  // A ray's number in the run: no part of a message, but back-offs are drawn from it, and benches follow it.
  localparam int ID_BITS = 64;
  typedef logic [63:0] id_t;

  localparam logic [1:0] PHASE_LOAD = 0, PHASE_PRECAST = 1, PHASE_TRACE = 2;

  // What every cell has latched from the viewer's message.
  typedef struct packed {
    logic [5:0] beyond;  // left, right, top, bottom, front, back: something of the scene is there
    logic signed [raycell_pkg::DEPTH_BITS-1:0] depth;
    logic [raycell_pkg::WORD-1:0] red;
    logic [raycell_pkg::WORD-1:0] green;
    logic [raycell_pkg::WORD-1:0] blue;
    logic [6:0] sources;  // how many
  } known_t;

  /* verilator lint_off UNUSEDPARAM */  // a cell without voxels has no hits
  localparam logic [2:0] NEED_OUTPUT = 0, NEED_ANSWER = 1, NEED_NOTHING = 2, NEED_TEST = 3, NEED_SLOT = 4;
  localparam int VOXEL_BITS = 16;  // of a voxel's number
  localparam int DECISION_BITS = 3 * WORD + DEPTH_BITS + DISTANCE_BITS + VOXEL_BITS + 8;
  /* verilator lint_on UNUSEDPARAM */

  // What a tested ray needs, and the ray as it goes on.
  typedef struct packed {
    logic [2:0] need;  // NEED_TEST: another test in its place, outside the cube now; NEED_SLOT: a hit
    logic [1:0] side;
    logic lost;  // nothing is where it goes: its answer is the background
    logic blocked;  // a shadow ray has hit something
    logic [raycell_pkg::WORD-1:0] x;
    logic [raycell_pkg::WORD-1:0] y;
    logic [raycell_pkg::DEPTH_BITS-1:0] z;
    logic [raycell_pkg::WORD-1:0] reach;  // of a shadow ray; else the weight
    logic outside;
    logic [raycell_pkg::DISTANCE_BITS-1:0] t;  // of a hit: its distance
    logic [15:0] voxel;  // and its voxel
  } decision_t;
endpackage
