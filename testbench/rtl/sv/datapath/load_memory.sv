// A memory of the loading unit: voxels, edges or the index table.
module load_memory #(
    parameter int WORDS = 1
) (
    input  logic                                      clock,
    input  logic                                      write,
    input  logic        [load::MEMORY_BITS-1:0]       address,
    input  logic signed [microcode::REGISTER_BITS-1:0] value,
    output logic signed [microcode::REGISTER_BITS-1:0] word,
    output logic                                      beyond  // the memory has no such word
);
  localparam int BITS = WORDS > 1 ? $clog2(WORDS) : 1;
  logic signed [microcode::REGISTER_BITS-1:0] words[0:WORDS-1];
  assign word = words[address[BITS-1:0]];
  assign beyond = address >= load::MEMORY_BITS'(WORDS);
  always_ff @(posedge clock) if (write && !beyond) words[address[BITS-1:0]] <= value;
endmodule
