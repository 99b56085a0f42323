// The arbiter of one output, or of the ray store's port: the least key wins, of equal ones the lower number.
// A message without room at the far end does not ask, so it holds up no other.
module oldest_first
  import raycell_numbers::*;
#(
    parameter int REQUESTERS = 4,
    parameter int KEY_BITS   = 8
) (
    input  logic [REQUESTERS-1:0] asks,
    input  logic [REQUESTERS-1:0][KEY_BITS-1:0] key,
    output logic [REQUESTERS-1:0] wins
);
  always_comb begin
    logic found;
    logic [KEY_BITS-1:0] best;
    found = 1'b0;
    best  = '0;
    wins  = '0;
    for (int i = 0; i < REQUESTERS; i++) begin
      if (asks[i] && (!found || key[i] < best || (fault == FAULT_EQUALS && key[i] == best))) begin
        found = 1'b1;
        best = key[i];
        wins = '0;
        wins[i] = 1'b1;
      end
    end
  end
endmodule
