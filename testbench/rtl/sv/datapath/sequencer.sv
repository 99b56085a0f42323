// Fetches instructions. The next one is fetched while one runs, so that `end` takes no cycle.
module sequencer #(
    parameter int ADDRESS_BITS = microcode::INSTRUCTION_ADDRESS_BITS,
    parameter int BITS = microcode::INSTRUCTION_BITS,
    parameter int WORDS = microcode::INSTRUCTIONS,
    parameter FILE = "programs.hex"
) (
    input  logic                    clock,
    input  logic                    reset,
    input  logic                    start,
    input  logic [ADDRESS_BITS-1:0] entry,
    input  logic                    taken,
    input  logic [ADDRESS_BITS-1:0] target,
    output logic [BITS-1:0]         instruction,
    output logic                    busy
);
  logic [ADDRESS_BITS-1:0] place, next;
  logic [BITS-1:0]         fetched;

  program_memory #(.WORDS(WORDS), .ADDRESS_BITS(ADDRESS_BITS), .BITS(BITS), .FILE(FILE)) memory (.address(next), .word(fetched));
  assign next = !busy ? entry : taken ? target : place + 1'b1;

  always_ff @(posedge clock)
    if (reset) begin
      busy <= 1'b0;
    end else if (start || busy) begin
      instruction <= fetched;
      place <= next;
      busy <= fetched[microcode::OPERATION_LOW+:microcode::OPERATION_BITS] != microcode::END;
    end
endmodule
