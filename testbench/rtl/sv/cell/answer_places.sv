// The places of answers that came over a link, by side, and what the oldest of each asks for.
module answer_places
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  logic tracing,
    input  logic [SIDES:0] arrives,
    input  logic [SIDES:0][CLASS_BITS-1:0] arrives_class,
    input  logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message,
    input  logic [SIDES:0][ID_BITS-1:0] arrives_id,
    input  logic [SIDES-1:0] leaves,
    output logic [SIDES-1:0] ready,
    output logic [SIDES-1:0][TIME_BITS-1:0] since,
    output logic [SIDES-1:0] home,
    output logic [SIDES-1:0][1:0] side,
    output logic [SIDES-1:0][15:0] cycles,
    output logic [SIDES-1:0][RAY_BITS-1:0] message,
    output logic [SIDES-1:0][ID_BITS-1:0] id,
    output logic idle,
    output logic waits  // none needs more time
);
  logic [SIDES-1:0] empty;
  for (genvar s = 0; s < SIDES; s++) begin : g_answers
    logic [MESSAGE_BITS-1:0] arriving;
    logic [INTENSITY_BITS-1:0] answer;
    assign arriving = arrives_message[s];
    logic unused;
    assign unused = &{1'b0, arriving};
    answer_place place (
        .clock,
        .reset,
        .now,
        .x,
        .y,
        .arrives(tracing && arrives[s] && int'(arrives_class[s]) == ANSWERS),
        .arrives_message(arriving[MESSAGE_BITS-1-:INTENSITY_BITS]),
        .arrives_id(arrives_id[s]),
        .leaves(leaves[s]),
        .ready(ready[s]),
        .since(since[s]),
        .home(home[s]),
        .side(side[s]),
        .cycles(cycles[s]),
        .message(answer),
        .id(id[s]),
        .empty(empty[s])
    );
    assign message[s] = {answer, {(RAY_BITS - INTENSITY_BITS) {1'b0}}};
  end
  assign idle  = &empty;
  assign waits = &(empty | ready);
  logic unused_link;
  assign unused_link = &{1'b0, arrives[LOAD_LINK], arrives_class[LOAD_LINK], arrives_message[LOAD_LINK], arrives_id[LOAD_LINK]};
endmodule
