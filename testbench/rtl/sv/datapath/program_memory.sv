// The microprograms, a word an instruction.
module program_memory #(
    parameter int WORDS = microcode::INSTRUCTIONS,
    parameter int ADDRESS_BITS = microcode::INSTRUCTION_ADDRESS_BITS,
    parameter int BITS = microcode::INSTRUCTION_BITS,
    parameter FILE = "programs.hex"
) (
    // verilator lint_off UNUSEDSIGNAL
    input  logic [ADDRESS_BITS-1:0] address,  // wide enough for the largest memory in this encoding
    // verilator lint_on UNUSEDSIGNAL
    output logic [BITS-1:0]         word
);
  localparam int PLACE = WORDS > 1 ? $clog2(WORDS) : 1;

  logic [BITS-1:0] words[0:WORDS-1];
  initial $readmemh(FILE, words);
  assign word = words[PLACE'(address)];
endmodule
