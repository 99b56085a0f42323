// Which hits find a slot, and which slot is next: the one that became free last.
module slot_room
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_whole::*;
(
    input  logic clock,
    input  logic reset,
    input  logic [RAY_STORE-1:0] released,
    input  logic [RAY_STORE-1:0][5:0] generation,  // of the hits in the slots
    input  logic [RAY_STORE-1:0] empty,
    input  logic accept,
    output logic [SLOT_GROUPS-1:0] room_before,
    output logic [SLOT_GROUPS-1:0] room_now,  // those released in this cycle are free
    output slot_index_t next
);
  group_room free_before (
      .used(~empty),
      .generation,
      .room(room_before)
  );
  group_room free_now (
      .used(~empty & ~released),
      .generation,
      .room(room_now)
  );

  // Slots that were used and are free; behind them those never used.
  localparam int COUNT = $clog2(RAY_STORE + 1);
  logic [COUNT-1:0] touched, stacked, stacked_after;
  slot_index_t [RAY_STORE-1:0] stack, stack_after;
  logic untouched;  // the next one was never used
  always_comb begin
    stack_after = stack;
    stacked_after = stacked;
    for (int i = 0; i < RAY_STORE; i++)
      if (released[i]) begin
        stack_after[stacked_after[SLOT_INDEX_BITS-1:0]] = slot_index_t'(i);
        stacked_after = stacked_after + 1'b1;
      end
    untouched = stacked_after == '0 || (fault == FAULT_STACK && int'(touched) < RAY_STORE);
    next = untouched ? touched[SLOT_INDEX_BITS-1:0] : stack_after[SLOT_INDEX_BITS'(stacked_after - 1'b1)];
  end

  always_ff @(posedge clock) begin
    if (reset) begin
      touched <= '0;
      stacked <= '0;
      stack <= '0;
    end else begin
      stack <= stack_after;
      stacked <= stacked_after - COUNT'(accept && !untouched);
      touched <= touched + COUNT'(accept && untouched);
    end
  end
endmodule
