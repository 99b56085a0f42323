// The places of rays that came over a link: the buffers by side and class.
module input_places
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic tracing,
    input  logic [SIDES:0] arrives,
    input  logic [SIDES:0][CLASS_BITS-1:0] arrives_class,
    input  logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message,
    input  logic [SIDES:0][ID_BITS-1:0] arrives_id,
    input  logic [OWN-1:0] leaves,
    input  logic [OWN-1:0] test_starts,
    input  logic [OWN-1:0] test_ends,
    input  logic [OWN-1:0][DECISION_BITS-1:0] found,
    output logic [OWN-1:0] untested,
    output logic [OWN-1:0][RAY_BITS-1:0] to_test,
    output logic [OWN-1:0] decided,
    output logic [OWN-1:0][TIME_BITS-1:0] since,
    output logic [OWN-1:0][DECISION_BITS-1:0] decision,
    output logic [OWN-1:0][RAY_BITS-1:0] message,
    output logic [OWN-1:0][ID_BITS-1:0] id,
    output logic [OWN-1:0] empty
);
  for (genvar p = 0; p < OWN; p++) begin : g_place
    localparam int SIDE = p / RAY_CLASSES;
    localparam int CLASS = p % RAY_CLASSES;
    logic [MESSAGE_BITS-1:0] arriving;
    assign arriving = arrives_message[SIDE];
    logic unused;
    assign unused = &{1'b0, arriving};
    if (CARRIES[CLASSES*SIDE+CLASS]) begin : g_used
      ray_place place (
          .clock,
          .reset,
          .now,
          .arrives(tracing && arrives[SIDE] && int'(arrives_class[SIDE]) == CLASS),
          .arrives_message(arriving[MESSAGE_BITS-1-:RAY_BITS]),
          .arrives_id(arrives_id[SIDE]),
          .leaves(leaves[p]),
          .test_starts(test_starts[p]),
          .test_ends(test_ends[p]),
          .found(found[p]),
          .untested(untested[p]),
          .to_test(to_test[p]),
          .decided(decided[p]),
          .since(since[p]),
          .decision(decision[p]),
          .message(message[p]),
          .id(id[p]),
          .empty(empty[p])
      );
    end else begin : g_none  // no ray of this class comes over this side
      assign untested[p] = 1'b0;
      assign decided[p] = 1'b0;
      assign empty[p] = 1'b1;
      assign to_test[p] = '0;
      assign message[p] = '0;
      assign id[p] = '0;
      assign since[p] = '0;
      assign decision[p] = '0;
    end
  end
  // Nor does the load link have one.
  logic unused_link;
  assign unused_link = &{1'b0, leaves, test_starts, test_ends, found, arrives[LOAD_LINK], arrives_class[LOAD_LINK], arrives_message[LOAD_LINK], arrives_id[LOAD_LINK]};
endmodule
