// The message of a child, and its number in the run, which follows from its parent's.
module child_ray
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
  import raycell_whole::*;
(
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  slot_index_t slot,
    input  child_index_t number,
    input  child_t child,
    input  logic [RAY_BITS-1:0] parent,
    input  id_t parent_id,
    output logic [RAY_BITS-1:0] message,
    output id_t id
);
  localparam logic [31:0] REFLECTED = 1, SHADOW = 3;  // kinds of rays, as ids are made from them

  function automatic logic [31:0] mixed(input logic [31:0] word);
    logic [31:0] h;
    h = (word ^ (word >> 16)) * 32'h85ebca6b;
    h = (h ^ (h >> 13)) * 32'hc2b2ae35;
    mixed = h ^ (h >> 16);
  endfunction

  logic shadow;
  logic [31:0] kind, place;
  logic [5:0] told;
  ray_t hit, ray;
  shadow_ray_t shadow_ray;
  always_comb begin
    hit = ray_t'(parent);
    shadow = int'(number) < LIGHTS;
    place = shadow ? 32'(number) : 32'(number) - 32'(LIGHTS);
    told = 6'(place) ^ 6'(fault == FAULT_CHILD);
    kind = shadow ? SHADOW : REFLECTED + place;
    id = {parent_id[63:32], mixed(parent_id[31:0] * 32'd31 + (kind << 8) + place + 32'd1)};
    ray = '{
        message_type: TYPE_RAY,
        x: child.x, y: child.y, z: child.z,
        dx: child.dx, dy: child.dy, dz: child.dz,
        inverse_dx_mantissa: child.mx, inverse_dx_exponent: child.ex,
        inverse_dy_mantissa: child.my, inverse_dy_exponent: child.ey,
        weight: child.share,
        polygon_left: child.polygon,
        generation: hit.generation + 1'b1,
        outside: 1'b0,
        home_x: x, home_y: y,
        slot: SLOT_BITS'(slot),
        child: told
    };
    shadow_ray = '{
        message_type: TYPE_SHADOW_RAY,
        x: child.x, y: child.y, z: child.z,
        dx: child.dx, dy: child.dy, dz: child.dz,
        inverse_dx_mantissa: child.mx, inverse_dx_exponent: child.ex,
        inverse_dy_mantissa: child.my, inverse_dy_exponent: child.ey,
        reach: child.share,
        polygon_left: child.polygon,
        outside: 1'b0,
        home_x: x, home_y: y,
        slot: SLOT_BITS'(slot),
        child: told
    };
    message = shadow ? {shadow_ray, {(RAY_BITS - SHADOW_RAY_BITS) {1'b0}}} : ray;
  end
  logic unused;
  assign unused = &{1'b0, hit};
endmodule
