// The part of a register that a multiplier's operand takes: all parts but the last have no sign.
module operand_part #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int OPERAND_BITS = microcode::OPERAND_BITS,
    parameter int PART_BITS = microcode::A_PART_BITS
) (
    input  logic signed [REGISTER_BITS-1:0] value,
    input  logic        [PART_BITS-1:0]     part,
    input  logic                            last,
    output logic signed [OPERAND_BITS-1:0]  operand
);
  `include "faults.svh"
  logic signed [OPERAND_BITS-1:0] low;

  always_comb begin
    low = OPERAND_BITS'(value);
    for (int i = 1; i < (1 << PART_BITS); i++)
      if (32'(part) == i) low = OPERAND_BITS'(value >>> (i * (OPERAND_BITS - 1)));
  end

  assign operand = last || fault == FIRST + 6 ? low : {1'b0, low[OPERAND_BITS-2:0]};
endmodule
