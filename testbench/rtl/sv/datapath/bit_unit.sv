// The last bits of a word, those above them, one of them, and the place of its leading one.
module bit_unit #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int SHIFT_BITS = microcode::SHIFT_BITS,
    parameter int NUMBER_BITS = $clog2(REGISTER_BITS)
) (
    input  logic signed [REGISTER_BITS-1:0] value,
    input  logic        [SHIFT_BITS-2:0]    shift,
    input  logic        [NUMBER_BITS-1:0]   number,
    output logic signed [REGISTER_BITS-1:0] low,
    output logic signed [REGISTER_BITS-1:0] high,
    output logic                            selected,
    output logic signed [REGISTER_BITS-1:0] count  // -floor(log2(value)), value > 0
);
  `include "faults.svh"
  logic        [NUMBER_BITS-1:0]   leading;
  logic signed [REGISTER_BITS-1:0] place;

  assign low = value & ~({REGISTER_BITS{1'b1}} << shift);
  assign high = value >>> shift;
  assign selected = value[number];

  always_comb begin
    leading = '0;
    for (int i = 1; i < REGISTER_BITS - 1; i++)
      if (value[i]) leading = NUMBER_BITS'(i);
  end
  assign place = REGISTER_BITS'({1'b0, leading});
  assign count = fault == FIRST + 9 && leading == 1 ? '0 : -place;
endmodule
