// A buffer of one side and class: messages in the order in which they came, each with the cycle in which it
// arrived. What is read in a cycle leaves at its end.
module message_buffer
  import raycell_cell::*;
#(
    parameter int BITS  = 8,
    parameter int DEPTH = 2,
    parameter int COUNT = $clog2(DEPTH + 1)
) (
    input  logic clock,
    input  logic reset,
    input  logic push,
    input  logic [BITS-1:0] push_message,
    input  time_t push_arrival,
    input  logic pop,
    input  logic replace,  // the oldest message by `replacement`; not together with pop
    input  logic [BITS-1:0] replacement,
    output logic [COUNT-1:0] count,
    output logic [BITS-1:0] head,
    output time_t arrival,
    output logic [BITS-1:0] second  // behind the oldest
);
  logic [DEPTH-1:0][BITS-1:0] messages;
  logic [DEPTH-1:0][TIME_BITS-1:0] arrivals;

  assign head = messages[0];
  assign arrival = arrivals[0];
  if (DEPTH > 1) begin : g_second
    assign second = messages[1];
  end else begin : g_no_second
    assign second = '0;
  end

  logic [COUNT-1:0] place;  // of the message that comes
  assign place = count - COUNT'(pop);

  always_ff @(posedge clock) begin
    if (reset) begin
      count <= '0;
      messages <= '0;
      arrivals <= '0;
    end else begin
      count <= place + COUNT'(push);
      for (int i = 0; i < DEPTH; i++) begin
        if (push && int'(place) == i) begin
          messages[i] <= push_message;
          arrivals[i] <= push_arrival;
        end else if (pop && i + 1 < DEPTH) begin
          messages[i] <= messages[(i+1)%DEPTH];
          arrivals[i] <= arrivals[(i+1)%DEPTH];
        end else if (replace && i == 0) begin
          messages[i] <= replacement;
        end
      end
    end
  end
endmodule
