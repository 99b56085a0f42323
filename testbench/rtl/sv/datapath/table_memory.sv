// The operators' tables: where each line starts, and how much it rises.
module table_memory #(
    parameter int LINES = microcode::LINES,
    parameter int ADDRESS_BITS = microcode::LINE_ADDRESS_BITS,
    parameter int BITS = microcode::LINE_BITS,
    parameter FILE = "tables.hex"
) (
    // verilator lint_off UNUSEDSIGNAL
    input  logic        [ADDRESS_BITS-1:0] address,  // wide enough for the largest memory in this encoding
    // verilator lint_on UNUSEDSIGNAL
    output logic signed [BITS-1:0]         start,
    output logic signed [BITS-1:0]         rise
);
  localparam int PLACE = LINES > 1 ? $clog2(LINES) : 1;

  logic [2*BITS-1:0] lines[0:LINES-1];
  initial $readmemh(FILE, lines);
  assign {start, rise} = lines[PLACE'(address)];
endmodule
