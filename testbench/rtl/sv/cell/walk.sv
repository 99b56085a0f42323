// One step of the walk: where a ray leaves an empty cell, and what it needs there. Without registers; the
// traversal unit gives it its time.
module walk
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  logic [RAY_BITS-1:0] message,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  known_t known,
    input  logic precast,
    output decision_t decision,
    output logic divides  // it leaves through front or back before the side, which takes a reciprocal
);
  localparam acc_t REACH_MOST = (acc_t'(1) <<< (WORD - 1)) - 1;  // infinite
  localparam int FINER = DISTANCE_F - REACH_F;

  ray_t ray;
  shadow_ray_t shadow_ray;
  logic shadow, outside;
  acc_t px, py, pz, dx, dy, dz, reach;
  always_comb begin
    ray = message;
    shadow_ray = message[RAY_BITS-1-:SHADOW_RAY_BITS];  // a shorter message stands in the upper bits
    shadow = ray.message_type == TYPE_SHADOW_RAY;
    outside = shadow ? shadow_ray.outside : ray.outside;
    px = acc_t'($signed(ray.x));
    py = acc_t'($signed(ray.y));
    pz = acc_t'($signed(ray.z));
    dx = acc_t'($signed(ray.dx));
    dy = acc_t'($signed(ray.dy));
    dz = acc_t'($signed(ray.dz));
    reach = acc_t'($signed(shadow_ray.reach));
  end

  // Way to a side over the direction: the reciprocal's sign is the direction's.
  function automatic acc_t crossing(input acc_t p, input acc_t d, input logic [WORD-1:0] mantissa,
                                    input logic [EXPONENT_BITS-1:0] exponent);
    acc_t way;
    way = d > 0 ? ONE - p : p;  // the way and d have the same sign, or the way is 0
    crossing = hold(way * acc_t'(mantissa), UNIT_F + WORD - 1 - int'($signed(exponent)) - DISTANCE_F,
                    DISTANCE_BITS);
  endfunction

  logic axial, over_y;
  acc_t tx, ty, t_side;
  logic [1:0] side;
  always_comb begin
    tx = crossing(px, dx, ray.inverse_dx_mantissa, ray.inverse_dx_exponent);
    ty = crossing(py, dy, ray.inverse_dy_mantissa, ray.inverse_dy_exponent);
    axial = dx == 0 && dy == 0;
    over_y = dy != 0 && (dx == 0 || ty < tx || (ty == tx && fault == FAULT_TIE));  // x wins ties
    t_side = over_y ? ty : tx;
    side = over_y ? (dy > 0 ? 2'(SOUTH) : 2'(NORTH)) : (dx < 0 ? 2'(WEST) : 2'(EAST));
  end

  // Front and back.
  acc_t bound, z_side, way_to_face, t_face, t_leave;
  logic leaves;
  floating_t inverse_dz;
  always_comb begin
    bound = dz > 0 ? acc_t'(known.depth) : '0;
    z_side = hold((pz <<< (DISTANCE_F + UNIT_F - DEPTH_F)) + t_side * dz, DISTANCE_F + UNIT_F - DEPTH_F,
                  DEPTH_BITS);
    leaves = !outside && (axial || (dz > 0 ? z_side > bound || (z_side == bound && fault == FAULT_LEAVING) : z_side < bound));
    inverse_dz = reciprocal(dz);
    if (dz == 0)  // 1/0 is so large that its product saturates
      way_to_face = bound > pz ? (acc_t'(1) <<< (DISTANCE_BITS - 1)) - 1 : '0;
    else
      way_to_face = hold((dz > 0 ? bound - pz : pz - bound) * acc_t'(inverse_dz.mantissa),
                    DEPTH_F + WORD - 1 - int'(inverse_dz.exponent) - DISTANCE_F, DISTANCE_BITS);
    t_face = way_to_face < 0 ? '0 : way_to_face;  // it may start slightly outside the cube
    t_leave = axial || t_face < t_side ? t_face : t_side;
  end

  logic finite, arrives;
  assign finite  = shadow && reach < REACH_MOST;
  assign arrives = !outside && finite && (reach <<< FINER) <= (leaves ? t_leave : t_side);

  // The next cell, and the face of the cube that counts if there is none.
  logic over_border, front_or_back, nothing_there;
  logic [5:0] beyond;
  assign beyond = known.beyond;
  logic [2:0] face;
  always_comb begin
    unique case (int'(side))
      EAST: over_border = int'(x) == COLUMNS - 1;
      SOUTH: over_border = int'(y) == ROWS - 1;
      WEST: over_border = x == 0;
      default: over_border = y == 0;
    endcase
    front_or_back = outside || leaves;
    if (front_or_back) face = dz > 0 ? 3'd0 : 3'd1;
    else
      unique case (int'(side))  // bit of `beyond`, whose first field is in the highest one
        EAST: face = 3'd4;
        SOUTH: face = 3'd2;
        WEST: face = 3'd5;
        default: face = 3'd3;
      endcase
    nothing_there = !(EXTERIOR && beyond[face]);
  end

  acc_t t, mx, my, mz, rest;
  logic crosses, moves, lost;
  logic [2:0] need;
  always_comb begin
    divides = leaves;
    t = leaves ? t_leave : t_side;
    crosses = !leaves && !arrives && !over_border && !axial;
    if (crosses && !over_y) mx = side == 2'(EAST) ? '0 : ONE;
    else mx = clamp_to_cell(hold((px <<< DISTANCE_F) + t * dx, DISTANCE_F, WORD));
    if (crosses && over_y) my = side == 2'(SOUTH) ? '0 : ONE;
    else my = clamp_to_cell(hold((py <<< DISTANCE_F) + t * dy, DISTANCE_F, WORD));
    mz = hold((pz <<< (DISTANCE_F + UNIT_F - DEPTH_F)) + t * dz, DISTANCE_F + UNIT_F - DEPTH_F, DEPTH_BITS);
    rest = hold((reach <<< FINER) - t, FINER, WORD);

    lost = !arrives && (leaves || over_border) && nothing_there;
    if (arrives || lost) need = shadow && precast ? NEED_NOTHING : NEED_ANSWER;  // silence is lit
    else need = leaves ? NEED_TEST : NEED_OUTPUT;
    moves = crosses || need == NEED_TEST;  // else it goes on as it stands
  end

  always_comb begin
    decision.need = need;
    decision.side = side;
    decision.lost = lost;
    decision.blocked = 1'b0;
    decision.t = '0;
    decision.voxel = '0;
    decision.x = moves ? WORD'(mx) : ray.x;
    decision.y = moves ? WORD'(my) : ray.y;
    decision.z = moves ? DEPTH_BITS'(mz) : ray.z;
    decision.reach = moves && finite ? WORD'(rest) : shadow_ray.reach;
    decision.outside = outside || need == NEED_TEST;
  end
endmodule
