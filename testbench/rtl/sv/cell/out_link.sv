// The sending end of a link: places taken at the far end, by class, and the cycle from which the wires are
// free. A place that is freed in a cycle can be used from the next one on.
module out_link
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic send,
    input  logic [CLASS_BITS-1:0] send_class,
    input  logic [15:0] send_cycles,
    input  logic [CLASSES-1:0] free,
    output logic [CLASSES-1:0] room,  // a message of the class can start now
    output logic [CLASSES-1:0] full,
    output logic wires_busy
);
  localparam int HELD_BITS = $clog2(BUFFER + 2);
  logic [CLASSES-1:0][HELD_BITS-1:0] held;
  time_t wires_free;

  always_comb begin
    wires_busy = wires_free > now && fault != FAULT_WIRES;
    for (int i = 0; i < CLASSES; i++) begin
      full[i] = int'(held[i]) >= BUFFER + (fault == FAULT_CREDIT ? 1 : 0);
      room[i] = !full[i] && !wires_busy;
    end
  end

  always_ff @(posedge clock) begin
    if (reset) begin
      held <= '0;
      wires_free <= '0;
    end else begin
      for (int i = 0; i < CLASSES; i++)
        held[i] <= held[i] + HELD_BITS'(send && int'(send_class) == i) - HELD_BITS'(free[i]);
      if (send) wires_free <= now + TIME_BITS'(send_cycles);
    end
  end
endmodule
