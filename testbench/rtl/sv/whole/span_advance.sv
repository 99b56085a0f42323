// A span as the next column has it: its plane, normals and edges from that column's corner. The sums are exact, so
// adders do it.
module span_advance
  import raycell_pkg::*;
  import raycell_numbers::*;
(
    input  logic [MESSAGE_BITS-1:0] message,
    output logic [MESSAGE_BITS-1:0] advanced
);
  localparam int BITS = $bits(span_edge_t) / 3;  // of a loading word
  localparam int EDGES = 4;
  typedef logic [BITS-1:0] loading_t;
  localparam loading_t ONE_CELL = loading_t'(1) << LOADING_F;

  span_t span;
  span_edge_t [EDGES-1:0] edges;  // the first in the highest bits
  loading_t n_x;
  always_comb begin
    advanced = message;
    span = message[MESSAGE_BITS-1-:SPAN_BITS];
    edges = message[MESSAGE_BITS-1-SPAN_BITS-:EDGES*SPAN_EDGE_BITS];
    n_x = span.axis != 0 ? span.slope_u : span.sign ? -ONE_CELL : ONE_CELL;
    span.X1 = span.X1 + 1'b1;
    span.offset = fault == FAULT_OFFSET ? span.offset + n_x : span.offset - n_x;
    if (span.axis != 0) begin  // else x is not among the coordinates that are left
      span.n_x = span.n_x + span.nu_x;
      span.n_y = span.n_y + span.nu_y;
      span.n_z = span.n_z + span.nu_z;
      for (int i = 0; i < EDGES; i++)
        if (int'(span.edges) > i) edges[EDGES-1-i].edge_c = edges[EDGES-1-i].edge_c + edges[EDGES-1-i].edge_a;
    end
    advanced[MESSAGE_BITS-1-:SPAN_BITS] = span;
    advanced[MESSAGE_BITS-1-SPAN_BITS-:EDGES*SPAN_EDGE_BITS] = edges;
  end
endmodule
