// The last bits of a word, those above them, one of them, and the place of its leading one.
module bit_unit #(
    parameter int REGISTER_BITS = datapath_package::REGISTER_BITS,
    parameter int SHIFT_BITS = datapath_package::SHIFT_BITS
) (
    input  logic signed [REGISTER_BITS-1:0]         value,
    input  logic        [SHIFT_BITS-2:0]            shift,
    input  logic        [$clog2(REGISTER_BITS)-1:0] number,
    output logic signed [REGISTER_BITS-1:0]         low,
    output logic signed [REGISTER_BITS-1:0]         high,
    output logic                                    selected,
    output logic signed [REGISTER_BITS-1:0]         count  // -floor(log2(value)), value > 0
);
  `include "faults.svh"
  logic [$clog2(REGISTER_BITS)-1:0] leading;

  assign low = value & ~({REGISTER_BITS{1'b1}} << shift);
  assign high = value >>> shift;
  assign selected = value[number];

  always_comb begin
    leading = '0;
    for (int i = 1; i < REGISTER_BITS - 1; i++)
      if (value[i]) leading = $clog2(REGISTER_BITS)'(i);
  end
  assign count = fault == 9 && leading == 1 ? '0 : -REGISTER_BITS'({1'b0, leading});
endmodule
