// A traversal unit of an empty cell: tests one ray at a time and holds it for the cycles of the test. What it
// finds is handed over at the end of the last cycle, so that the ray is decided in the cycle after it.
module traversal_unit
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  known_t known,
    input  logic precast,
    input  logic start,
    input  logic [PLACE_INDEX_BITS-1:0] start_place,
    input  logic [RAY_BITS-1:0] start_message,
    output logic busy,
    output logic done,  // in its last cycle
    output logic [PLACE_INDEX_BITS-1:0] place,
    output decision_t decision
);
  logic [RAY_BITS-1:0] message;
  time_t began;
  logic divides;

  walk step (
      .message,
      .x,
      .y,
      .known,
      .precast,
      .decision,
      .divides
  );

  // Where leaving costs nothing, neither does its reciprocal.
  localparam int LEAVING = COST_LEAVE_CUBE > 0 ? COST_LEAVE_CUBE + COST_RECIPROCAL : 0;
  time_t last;
  assign last = began + TIME_BITS'(COST_WALK_STEP) - 1'b1 + (divides ? TIME_BITS'(LEAVING) : '0);
  assign done = busy && now == last;

  always_ff @(posedge clock) begin
    if (reset) begin
      busy <= 1'b0;
      message <= '0;
      began <= '0;
      place <= '0;
    end else if (start) begin
      busy <= 1'b1;
      message <= start_message;
      began <= now;
      place <= start_place;
    end else if (done) begin
      busy <= 1'b0;
    end
  end
endmodule
