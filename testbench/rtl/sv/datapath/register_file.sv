// Registers: two are read, and two written, in a cycle. The second is written by table lines alone.
module register_file #(
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int REGISTERS = microcode::REGISTERS,
    parameter int ADDRESS_BITS = microcode::REGISTER_ADDRESS_BITS,
    parameter FILE = ""  // of what they hold at the beginning
) (
    input  logic                            clock,
    // Addresses are wide enough for the most registers in this encoding.
    // verilator lint_off UNUSEDSIGNAL
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
    // verilator lint_on UNUSEDSIGNAL
);
  localparam int PLACE = REGISTERS > 1 ? $clog2(REGISTERS) : 1;

  logic signed [REGISTER_BITS-1:0] words[0:REGISTERS-1];
  if (FILE != "") begin : g_constants
    initial $readmemh(FILE, words);
  end

  assign a = words[PLACE'(a_address)];
  assign b = words[PLACE'(b_address)];

  always_ff @(posedge clock) begin
    if (write) words[PLACE'(write_address)] <= write_value;
    if (write_second) words[PLACE'(second_address)] <= second_value;
  end
endmodule
