// The operators' tables: where each line starts, and how much it rises.
module table_memory #(
    parameter int LINES = microcode::LINES,
    parameter int ADDRESS_BITS = microcode::LINE_ADDRESS_BITS,
    parameter int BITS = microcode::LINE_BITS
) (
    input  logic        [ADDRESS_BITS-1:0] address,
    output logic signed [BITS-1:0]         start,
    output logic signed [BITS-1:0]         rise
);
  logic [2*BITS-1:0] lines[0:LINES-1];
  initial $readmemh("tables.hex", lines);
  assign {start, rise} = lines[address];
endmodule
