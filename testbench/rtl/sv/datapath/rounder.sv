// The accumulator / 2^distance, to the nearest (ties to even) or cut off, saturated to a number of bits.
module rounder #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int ACCUMULATOR_BITS = microcode::ACCUMULATOR_BITS,
    parameter int DISTANCE_BITS = 12,
    parameter int SIZE_BITS = microcode::EXTRA_BITS
) (
    input  logic signed [ACCUMULATOR_BITS-1:0] value,
    input  logic signed [DISTANCE_BITS-1:0]    distance,
    input  logic                               nearest,
    input  logic        [SIZE_BITS-1:0]        bits,
    output logic signed [REGISTER_BITS-1:0]    word
);
  `include "faults.svh"
  // Further than this, the sign alone is left; to the left, nothing but 0 fits a register.
  localparam int MOST_RIGHT = ACCUMULATOR_BITS + 1;
  localparam int MOST_LEFT = REGISTER_BITS;
  localparam int WIDE_BITS = ACCUMULATOR_BITS + REGISTER_BITS;
  localparam int RIGHT_BITS = $clog2(MOST_RIGHT + 1);
  localparam int LEFT_BITS = $clog2(MOST_LEFT + 1);

  logic                               to_left;
  logic signed [DISTANCE_BITS-1:0]    opposite;
  logic        [RIGHT_BITS-1:0]       right;
  logic        [LEFT_BITS-1:0]        left;
  logic signed [ACCUMULATOR_BITS:0]   guarded, cut;  // with the bit below the last one
  logic signed [ACCUMULATOR_BITS-1:0] down, rounded;
  logic                               half, rest, up;
  logic signed [WIDE_BITS-1:0]        wide, above;
  logic signed [REGISTER_BITS-1:0]    most;

  assign to_left = distance < 0;
  assign right = to_left ? '0 : 32'(distance) > MOST_RIGHT ? RIGHT_BITS'(MOST_RIGHT) : RIGHT_BITS'(distance);
  assign opposite = -distance;
  assign left = !to_left ? '0 : 32'(opposite) > MOST_LEFT ? LEFT_BITS'(MOST_LEFT) : LEFT_BITS'(opposite);

  assign guarded = {value, 1'b0};
  assign cut = guarded >>> right;
  assign down = cut[ACCUMULATOR_BITS:1];
  assign half = cut[0];
  assign rest = (guarded & ~({(ACCUMULATOR_BITS + 1) {1'b1}} << right)) != 0;
  assign up = nearest && fault != FIRST + 1 && half && (rest || down[0] || fault == FIRST + 2);
  assign rounded = up ? down + 1'b1 : down;

  assign wide = WIDE_BITS'(rounded) <<< left;
  assign above = wide >>> (bits - 1'b1);
  assign most = ~({REGISTER_BITS{1'b1}} << (bits - 1'b1));
  assign word = above == 0 || above == -1 || fault == FIRST + 3 ? REGISTER_BITS'(wide)
      : wide[WIDE_BITS-1] ? (fault == FIRST + 8 ? -most : ~most) : most;
endmodule
