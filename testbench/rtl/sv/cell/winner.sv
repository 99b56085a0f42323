// The message that an output takes from the winner of its arbiter.
module winner
  import raycell_pkg::*;
#(
    parameter int REQUESTERS = 4
) (
    input  logic [REQUESTERS-1:0] wins,
    input  logic [REQUESTERS-1:0][CLASS_BITS-1:0] classes,
    input  logic [REQUESTERS-1:0][15:0] cycles,
    input  logic [REQUESTERS-1:0][RAY_BITS-1:0] messages,
    input  logic [REQUESTERS-1:0][raycell_cell::ID_BITS-1:0] ids,
    output logic [CLASS_BITS-1:0] won_class,
    output logic [15:0] won_cycles,
    output logic [RAY_BITS-1:0] won_message,
    output logic [raycell_cell::ID_BITS-1:0] won_id
);
  always_comb begin
    won_class   = '0;
    won_cycles  = '0;
    won_message = '0;
    won_id = '0;
    for (int i = 0; i < REQUESTERS; i++) begin
      if (wins[i]) begin
        won_class   = classes[i];
        won_cycles  = cycles[i];
        won_message = messages[i];
        won_id = ids[i];
      end
    end
  end
endmodule
