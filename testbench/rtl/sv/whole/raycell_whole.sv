// What the units of a cell with voxels pass to each other, beside what every cell has.
package raycell_whole;
  import raycell_pkg::*;

  localparam int ALL_PLACES = raycell_cell::PLACES + RAY_STORE;  // of rays: the slots' child registers, too
  localparam int ALL_INDEX_BITS = $clog2(ALL_PLACES + 1);

  localparam int SLOT_INDEX_BITS = RAY_STORE > 1 ? $clog2(RAY_STORE) : 1;
  localparam int GROUP_BITS = SLOT_GROUPS > 1 ? $clog2(SLOT_GROUPS) : 1;
  typedef logic [SLOT_INDEX_BITS-1:0] slot_index_t;
  typedef logic [(LIGHTS > 1 ? $clog2(LIGHTS) : 1)-1:0] light_index_t;  // of one light, too

  // A child of a hit: a shadow ray's number is that of its light, then the reflected and the refracted ray.
  localparam int CHILDREN = LIGHTS + 2;
  localparam int CHILD_BITS = $clog2(CHILDREN);
  typedef logic [CHILD_BITS-1:0] child_index_t;

  typedef struct packed {
    logic [WORD-1:0] x;
    logic [WORD-1:0] y;
    logic [DEPTH_BITS-1:0] z;
    logic [WORD-1:0] dx;
    logic [WORD-1:0] dy;
    logic [WORD-1:0] dz;
    logic [WORD-1:0] mx;  // the reciprocals
    logic [EXPONENT_BITS-1:0] ex;
    logic [WORD-1:0] my;
    logic [EXPONENT_BITS-1:0] ey;
    logic [WORD-1:0] share;  // its weight, of a shadow ray its reach
    logic [19:0] polygon;  // that it leaves
  } child_t;

  typedef struct packed {
    logic [WORD-1:0] red;
    logic [WORD-1:0] green;
    logic [WORD-1:0] blue;
  } colour_t;

  // What the set-up of a hit has found.
  typedef struct packed {
    logic [LIGHTS-1:0] facing;
    logic reflects;
    logic refracts;
  } set_up_t;

  function automatic logic [5:0] ray_generation(input logic [RAY_BITS-1:0] message);
    ray_t ray;
    ray = ray_t'(message);
    ray_generation = ray.generation;
  endfunction
  function automatic logic [GROUP_BITS-1:0] group_of(input logic [5:0] generation);
    group_of = int'(generation) < SLOT_GROUPS - 1 ? GROUP_BITS'(generation) : GROUP_BITS'(SLOT_GROUPS - 1);
  endfunction
endpackage
