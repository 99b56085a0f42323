// The primary ray of the cell's own pixel, made once when the viewer is known: one operation a cycle. It is
// ready long before the trace begins, since the scene still has to pass.
module primary_ray
  import raycell_pkg::*;
  import raycell_numbers::*;
(
    input  logic clock,
    input  logic reset,
    input  logic start,
    input  setup_t viewer,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    output logic ready,
    output logic making,
    output logic [RAY_BITS-1:0] message
);
  localparam int PLACE_F = PLACE_BITS - 1;
  localparam logic [2:0] IDLE = 0, SCALE = 1, SQUARE = 2, ROOT = 3, DIRECT = 4, INVERT_X = 5, INVERT_Y = 6, READY = 7;

  // From the viewer to a point of the array: the point is rounded to the last bit of the place's mantissas.
  function automatic acc_t way(input acc_t point, input logic [PLACE_BITS-1:0] place, input int exponent);
    way = hold(point, 1 + exponent - PLACE_F, PLACE_F + 4) - acc_t'($signed(place));
  endfunction

  logic [2:0] step;
  acc_t vx, vy, vz, squared;
  floating_t root;
  logic [WORD-1:0] dx, dy, dz;
  floating_t inverse_x, inverse_y;

  acc_t larger, largest;
  int drop;
  always_comb begin
    larger = magnitude(vx) > magnitude(vy) ? magnitude(vx) : magnitude(vy);
    largest = magnitude(vz) > larger ? magnitude(vz) : larger;
    drop = bit_length(largest) - MF;
  end

  // On the wires a mantissa of 2^MF is half of it, with an exponent of one more; of a 0 both are 0.
  function automatic logic [WORD+7:0] carried(input logic [WORD-1:0] word);
    logic [WORD-1:0] mantissa;
    logic [7:0] exponent;
    {mantissa, exponent} = reciprocal(acc_t'($signed(word)));
    if (word == '0) carried = '0;
    else carried = mantissa[MF] ? {mantissa >> 1, exponent + 8'd1} : {mantissa, exponent};
  endfunction

  ray_t ray;
  always_comb begin
    ray = '0;
    ray.message_type = TYPE_RAY;
    ray.x = WORD'(ONE >>> 1);
    ray.y = WORD'(ONE >>> 1);
    ray.dx = dx;
    ray.dy = dy;
    ray.dz = dz;
    ray.inverse_dx_mantissa = inverse_x.mantissa;
    ray.inverse_dx_exponent = EXPONENT_BITS'(inverse_x.exponent);
    ray.inverse_dy_mantissa = inverse_y.mantissa;
    ray.inverse_dy_exponent = EXPONENT_BITS'(inverse_y.exponent);
    ray.weight = WORD'(ONE);
    ray.polygon_left = '1;  // none
    ray.home_x = x;
    ray.home_y = y;
    ray.slot = '1;  // the pixel
  end
  assign message = ray;
  assign ready   = step == READY;
  assign making  = step != READY && step != IDLE;

  always_ff @(posedge clock) begin
    if (reset) begin
      step <= IDLE;
      vx <= '0;
      vy <= '0;
      vz <= '0;
      squared <= '0;
      root <= '0;
      dx <= '0;
      dy <= '0;
      dz <= '0;
      inverse_x <= '0;
      inverse_y <= '0;
    end else begin
      unique case (step)
        IDLE, READY:
        if (start) begin
          vx   <= way(acc_t'({x, 1'b1}), viewer.place_x, int'($signed(viewer.place_exponent)));
          vy   <= way(acc_t'({y, 1'b1}), viewer.place_y, int'($signed(viewer.place_exponent)));
          vz   <= way('0, viewer.place_z, int'($signed(viewer.place_exponent)));
          dx   <= '0;
          dy   <= '0;
          dz   <= WORD'(ONE);
          step <= viewer.at_infinity ? INVERT_X : SCALE;
        end
        SCALE: begin
          vx   <= hold(vx, drop, WORD);
          vy   <= hold(vy, drop, WORD);
          vz   <= hold(vz, drop, WORD);
          step <= SQUARE;
        end
        SQUARE: begin
          squared <= hold(vx * vx + vy * vy + vz * vz, 2 * MF - FIELD_F, FIELD_BITS);
          step <= ROOT;
        end
        ROOT: begin
          root <= inverse_root(squared);
          step <= DIRECT;
        end
        DIRECT: begin
          dx   <= WORD'(hold(vx * acc_t'(root.mantissa), 2 * MF - int'(root.exponent) - UNIT_F, WORD));
          dy   <= WORD'(hold(vy * acc_t'(root.mantissa), 2 * MF - int'(root.exponent) - UNIT_F, WORD));
          dz   <= WORD'(hold(vz * acc_t'(root.mantissa), 2 * MF - int'(root.exponent) - UNIT_F, WORD));
          step <= INVERT_X;
        end
        INVERT_X: begin
          inverse_x <= carried(dx);
          step <= INVERT_Y;
        end
        default: begin
          inverse_y <= carried(dy);
          step <= READY;
        end
      endcase
    end
  end
endmodule
