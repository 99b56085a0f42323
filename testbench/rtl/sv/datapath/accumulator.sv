// The multiplier and the accumulator: it is loaded, or a word or a product is added to it.
module accumulator #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int OPERAND_BITS = microcode::OPERAND_BITS,
    parameter int ACCUMULATOR_BITS = microcode::ACCUMULATOR_BITS,
    parameter int PART_BITS = microcode::A_PART_BITS,
    parameter int SHIFT_BITS = microcode::SHIFT_BITS
) (
    input  logic                               clock,
    input  logic                               enable,
    input  logic                               afresh,    // from 0
    input  logic                               multiply,  // else adds a
    input  logic                               nothing,   // adds 0
    input  logic                               negative,
    input  logic signed [REGISTER_BITS-1:0]    a,
    input  logic signed [REGISTER_BITS-1:0]    b,
    input  logic        [PART_BITS-1:0]        a_part,
    input  logic        [PART_BITS-1:0]        b_part,
    input  logic                               a_last,
    input  logic                               b_last,
    input  logic        [SHIFT_BITS-2:0]       shift,
    output logic signed [ACCUMULATOR_BITS-1:0] value
);
  `include "faults.svh"
  localparam int HALF = ACCUMULATOR_BITS / 2;
  logic signed [OPERAND_BITS-1:0]     first, second;
  logic signed [2*OPERAND_BITS-1:0]   product;
  logic signed [ACCUMULATOR_BITS-1:0] addend, shifted, term, held, sum;
  logic        [SHIFT_BITS-2:0]       by;

  operand_part #(REGISTER_BITS, OPERAND_BITS, PART_BITS) first_part (
      .value(a), .part(a_part), .last(a_last), .operand(first));
  operand_part #(REGISTER_BITS, OPERAND_BITS, PART_BITS) second_part (
      .value(b), .part(b_part), .last(b_last), .operand(second));

  assign product = first * second;
  assign addend = multiply ? ACCUMULATOR_BITS'(product) : ACCUMULATOR_BITS'(a);
  assign by = fault == FIRST + 5 ? shift & {(SHIFT_BITS - 1) {shift < 8}} : shift;
  assign shifted = nothing ? '0 : addend <<< by;
  assign term = negative ? -shifted : shifted;
  assign held = afresh ? '0 : value;
  assign sum = held + term;

  always_ff @(posedge clock)
    if (enable)
      if (fault == FIRST + 4) value <= {held[ACCUMULATOR_BITS-1:HALF] + term[ACCUMULATOR_BITS-1:HALF], sum[HALF-1:0]};
      else value <= sum;
endmodule
