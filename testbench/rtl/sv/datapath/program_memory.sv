// The microprograms, a word an instruction.
module program_memory #(
    parameter int WORDS = microcode::INSTRUCTIONS,
    parameter int ADDRESS_BITS = microcode::INSTRUCTION_ADDRESS_BITS,
    parameter int BITS = microcode::INSTRUCTION_BITS
) (
    input  logic [ADDRESS_BITS-1:0] address,
    output logic [BITS-1:0]         word
);
  logic [BITS-1:0] words[0:WORDS-1];
  initial $readmemh("programs.hex", words);
  assign word = words[address];
endmodule
