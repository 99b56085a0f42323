// The receiving end of a link: a message is there `cycles` cycles after it began to come. The wires carry one
// at a time.
module receiver
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic valid,  // a message begins
    input  logic [CLASS_BITS-1:0] in_class,
    input  logic [15:0] in_cycles,
    input  logic [MESSAGE_BITS-1:0] in_message,
    input  id_t in_id,
    output logic arrives,  // it can be seen from the next cycle on
    output logic [CLASS_BITS-1:0] arrives_class,
    output logic [15:0] arrives_cycles,  // that it took
    output logic [MESSAGE_BITS-1:0] arrives_message,
    output id_t arrives_id,
    output logic idle
);
  logic pending;
  time_t visible;
  logic [CLASS_BITS-1:0] held_class;
  logic [15:0] held_cycles;
  logic [MESSAGE_BITS-1:0] held_message;
  id_t held_id;

  logic at_once;
  assign at_once = valid && in_cycles == 16'd1;
  assign arrives = at_once || (pending && now + 1'b1 == visible);
  assign arrives_class = at_once ? in_class : held_class;
  assign arrives_cycles = at_once ? in_cycles : held_cycles;
  assign arrives_message = at_once ? in_message : held_message;
  assign arrives_id = at_once ? in_id : held_id;
  assign idle = !pending;

  always_ff @(posedge clock) begin
    if (reset) begin
      pending <= 1'b0;
      visible <= '0;
      held_class <= '0;
      held_cycles <= '0;
      held_message <= '0;
      held_id <= '0;
    end else if (valid && !at_once) begin
      pending <= 1'b1;
      visible <= now + TIME_BITS'(in_cycles);
      held_class <= in_class;
      held_cycles <= in_cycles;
      held_message <= in_message;
      held_id <= in_id;
    end else if (arrives && !at_once) begin
      pending <= 1'b0;
    end
  end
endmodule
