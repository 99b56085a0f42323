// Adds, subtracts, compares.
module adder #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS
) (
    input  logic signed [REGISTER_BITS-1:0] a,
    input  logic signed [REGISTER_BITS-1:0] b,
    output logic signed [REGISTER_BITS-1:0] sum,
    output logic signed [REGISTER_BITS-1:0] difference,
    output logic signed [REGISTER_BITS-1:0] absolute,
    output logic                            less,
    output logic                            zero
);
  `include "faults.svh"
  logic signed [REGISTER_BITS:0] wide;

  assign sum = a + b;
  assign wide = {a[REGISTER_BITS-1], a} - {b[REGISTER_BITS-1], b};
  assign difference = wide[REGISTER_BITS-1:0];
  assign absolute = a < 0 ? -a : a;
  assign less = wide[REGISTER_BITS] || (fault == FIRST + 7 && wide == 0);
  assign zero = a == 0;
endmodule
