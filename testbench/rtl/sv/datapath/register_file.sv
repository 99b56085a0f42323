// Registers: two are read, and two written, in a cycle. The second is written by table lines alone.
module register_file #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int REGISTERS = microcode::REGISTERS,
    parameter int ADDRESS_BITS = microcode::REGISTER_ADDRESS_BITS
) (
    input  logic                            clock,
    input  logic        [ADDRESS_BITS-1:0]  a_address,
    input  logic        [ADDRESS_BITS-1:0]  b_address,
    output logic signed [REGISTER_BITS-1:0] a,
    output logic signed [REGISTER_BITS-1:0] b,
    input  logic                            write,
    input  logic        [ADDRESS_BITS-1:0]  write_address,
    input  logic signed [REGISTER_BITS-1:0] write_value,
    input  logic                            write_second,
    input  logic        [ADDRESS_BITS-1:0]  second_address,
    input  logic signed [REGISTER_BITS-1:0] second_value
);
  logic signed [REGISTER_BITS-1:0] words[0:REGISTERS-1];

  assign a = words[a_address];
  assign b = words[b_address];

  always_ff @(posedge clock) begin
    if (write) words[write_address] <= write_value;
    if (write_second) words[second_address] <= second_value;
  end
endmodule
