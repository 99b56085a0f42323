// The slots' child registers: places of rays that the cell's own hits send. A child can be tested in the cycle in which
// it comes there.
module child_places
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [RAY_STORE-1:0] feed,
    input  logic [RAY_STORE-1:0][RAY_BITS-1:0] fed,
    input  logic [RAY_STORE-1:0][ID_BITS-1:0] fed_id,
    input  logic [RAY_STORE-1:0] leaves,
    input  logic [RAY_STORE-1:0] test_starts,
    input  logic [RAY_STORE-1:0] test_ends,
    input  logic [RAY_STORE-1:0][DECISION_BITS-1:0] found,
    output logic [RAY_STORE-1:0] untested,
    output logic [RAY_STORE-1:0][RAY_BITS-1:0] to_test,
    output logic [RAY_STORE-1:0] decided,
    output logic [RAY_STORE-1:0][TIME_BITS-1:0] since,
    output logic [RAY_STORE-1:0][DECISION_BITS-1:0] decision,
    output logic [RAY_STORE-1:0][RAY_BITS-1:0] message,
    output logic [RAY_STORE-1:0][ID_BITS-1:0] id,
    output logic [RAY_STORE-1:0] empty
);
  for (genvar i = 0; i < RAY_STORE; i++) begin : g_child
    logic register_untested;
    logic [RAY_BITS-1:0] register_to_test;
    ray_place #(
        .DEPTH(1)
    ) place (
        .clock,
        .reset,
        .now,
        .arrives(feed[i]),
        .arrives_message(fed[i]),
        .arrives_id(fed_id[i]),
        .leaves(leaves[i]),
        .test_starts(test_starts[i]),
        .test_ends(test_ends[i]),
        .found(found[i]),
        .untested(register_untested),
        .to_test(register_to_test),
        .decided(decided[i]),
        .since(since[i]),
        .decision(decision[i]),
        .message(message[i]),
        .id(id[i]),
        .empty(empty[i])
    );
    assign untested[i] = feed[i] || register_untested;
    assign to_test[i]  = feed[i] ? fed[i] : register_to_test;
  end
endmodule
