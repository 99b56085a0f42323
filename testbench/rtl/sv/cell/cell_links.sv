// The ends of a cell's links: receivers by side and of the load link, and what is known of the far ends.
module cell_links
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [SIDES:0] in_valid,
    input  logic [SIDES:0][CLASS_BITS-1:0] in_class,
    input  logic [SIDES:0][15:0] in_cycles,
    input  logic [SIDES:0][MESSAGE_BITS-1:0] in_message,
    input  logic [SIDES:0][ID_BITS-1:0] in_id,
    output logic [SIDES:0] arrives,
    output logic [SIDES:0][CLASS_BITS-1:0] arrives_class,
    output logic [SIDES:0][15:0] arrives_cycles,
    output logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message,
    output logic [SIDES:0][ID_BITS-1:0] arrives_id,
    output logic idle,
    input  logic [SIDES-1:0] out_valid,
    input  logic [SIDES-1:0][CLASS_BITS-1:0] out_class,
    input  logic [SIDES-1:0][15:0] out_cycles,
    input  logic [SIDES-1:0][CLASSES-1:0] free,
    output logic [SIDES-1:0][CLASSES-1:0] room,
    output logic [SIDES-1:0][CLASSES-1:0] full,
    output logic [SIDES-1:0] wires_busy
);
  logic [SIDES:0] receiver_idle;
  assign idle = &receiver_idle;
  for (genvar s = 0; s <= SIDES; s++) begin : g_receiver
    receiver from (
        .clock,
        .reset,
        .now,
        .valid(in_valid[s]),
        .in_class(in_class[s]),
        .in_cycles(in_cycles[s]),
        .in_message(in_message[s]),
        .in_id(in_id[s]),
        .arrives(arrives[s]),
        .arrives_class(arrives_class[s]),
        .arrives_cycles(arrives_cycles[s]),
        .arrives_message(arrives_message[s]),
        .arrives_id(arrives_id[s]),
        .idle(receiver_idle[s])
    );
  end
  for (genvar s = 0; s < SIDES; s++) begin : g_out
    out_link to (
        .clock,
        .reset,
        .now,
        .send(out_valid[s]),
        .send_class(out_class[s]),
        .send_cycles(out_cycles[s]),
        .free(free[s]),
        .room(room[s]),
        .full(full[s]),
        .wires_busy(wires_busy[s])
    );
  end
endmodule
