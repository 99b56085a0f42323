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
  typedef logic [TIME_BITS-1:0] time_t;

  localparam logic [1:0] PHASE_LOAD = 0, PHASE_PRECAST = 1, PHASE_TRACE = 2;

  // What every cell has latched from the viewer's message.
  typedef struct packed {
    logic [5:0] beyond;  // left, right, top, bottom, front, back: something of the scene is there
    logic signed [DEPTH_BITS-1:0] depth;
    logic [WORD-1:0] red;
    logic [WORD-1:0] green;
    logic [WORD-1:0] blue;
  } known_t;

  localparam logic [1:0] NEED_OUTPUT = 0, NEED_ANSWER = 1, NEED_NOTHING = 2, NEED_TEST = 3;

  // What a tested ray needs, and the ray as it goes on.
  typedef struct packed {
    logic [1:0] need;  // NEED_TEST: another test in its place, outside the cube now
    logic [1:0] side;
    logic lost;  // nothing is where it goes: its answer is the background
    logic [WORD-1:0] x;
    logic [WORD-1:0] y;
    logic [DEPTH_BITS-1:0] z;
    logic [WORD-1:0] reach;  // of a shadow ray; else the weight
    logic outside;
  } decision_t;

  function automatic ray_t as_ray(input logic [RAY_BITS-1:0] message);
    as_ray = ray_t'(message);
  endfunction
  // A shorter message stands in the upper bits.
  function automatic shadow_ray_t as_shadow_ray(input logic [RAY_BITS-1:0] message);
    as_shadow_ray = shadow_ray_t'(message[RAY_BITS-1-:SHADOW_RAY_BITS]);
  endfunction
  function automatic logic is_shadow(input logic [RAY_BITS-1:0] message);
    is_shadow = message[RAY_BITS-1-:TYPE_BITS] == TYPE_SHADOW_RAY;
  endfunction

  // A ray with a decision's place, way left and mark.
  function automatic logic [RAY_BITS-1:0] moved(input logic [RAY_BITS-1:0] message, input decision_t decision);
    ray_t ray;
    shadow_ray_t shadow;
    ray = as_ray(message);
    shadow = as_shadow_ray(message);
    ray.x = decision.x;
    ray.y = decision.y;
    ray.z = decision.z;
    ray.outside = decision.outside;
    shadow.x = decision.x;
    shadow.y = decision.y;
    shadow.z = decision.z;
    shadow.reach = decision.reach;
    shadow.outside = decision.outside;
    moved = is_shadow(message) ? {shadow, {(RAY_BITS - SHADOW_RAY_BITS) {1'b0}}} : ray;
  endfunction
endpackage
