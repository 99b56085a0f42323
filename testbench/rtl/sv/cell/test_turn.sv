// Whose turn it is to be tested: round robin over the places, from the one behind the last that was tested
// on, for as many units as are free.
module test_turn
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
#(
    parameter int PLACE_COUNT = raycell_cell::PLACES,
    parameter int INDEX_BITS = $clog2(PLACE_COUNT + 1)
) (
    input  logic clock,
    input  logic reset,
    input  logic enable,
    input  logic [PLACE_COUNT-1:0] untested,
    input  logic [TRAVERSAL_UNITS-1:0] busy,
    output logic [TRAVERSAL_UNITS-1:0] start,
    output logic [TRAVERSAL_UNITS-1:0][INDEX_BITS-1:0] place,
    output logic [PLACE_COUNT-1:0] started
);
  logic [INDEX_BITS-1:0] next, next_after;

  always_comb begin
    logic [PLACE_COUNT-1:0] left;
    logic found;
    logic [INDEX_BITS-1:0] after, tested;
    left = enable ? untested : '0;
    after = next;
    start = '0;
    place = '0;
    for (int u = 0; u < TRAVERSAL_UNITS; u++) begin
      found = 1'b0;
      tested = '0;
      if (!busy[u]) begin
        for (int round = 0; round < 2; round++)
          for (int p = 0; p < PLACE_COUNT; p++)
            if (!found && left[p] && (round == 1 || p >= int'(after))) begin
              found = 1'b1;
              start[u] = 1'b1;
              tested = INDEX_BITS'(p);
            end
        if (found) begin
          left[tested] = 1'b0;
          after = fault == FAULT_TURN ? next : tested + 1'b1;
          place[u] = tested;
        end
      end
    end
    next_after = after;
    started = enable ? untested & ~left : '0;
  end

  always_ff @(posedge clock) begin
    if (reset) next <= '0;
    else next <= next_after;
  end
endmodule
