// Puts a word into the part of a span that moves on to the next column.
module load_packer
  import raycell_pkg::*;
(
    input  logic        [MESSAGE_BITS-1:0]             message,
    input  logic        [load::FIELD_BITS-1:0]         part,
    input  logic signed [microcode::REGISTER_BITS-1:0] word,
    output logic        [MESSAGE_BITS-1:0]             packed_message
);
  localparam int FIELD = load::FIELD_BITS;
  localparam int BITS = $bits(span_edge_t) / 3;  // of a loading word

  span_t            span;
  span_edge_t [3:0] edges;  // the first in the highest bits
  logic [BITS-1:0]  value;
  assign value = word[BITS-1:0];
  logic unused;
  assign unused = &{1'b0, word};

  always_comb begin
    packed_message = message;
    span = message[MESSAGE_BITS-1-:SPAN_BITS];
    edges = message[MESSAGE_BITS-1-SPAN_BITS-:4*SPAN_EDGE_BITS];
    case (part)
      FIELD'(load::F_X): span.X1 = value[X_BITS-1:0];
      FIELD'(load::F_C): span.offset = value;
      FIELD'(load::F_BX): span.n_x = value;
      FIELD'(load::F_BY): span.n_y = value;
      FIELD'(load::F_BZ): span.n_z = value;
      FIELD'(load::F_EDGE_C_0): edges[3].edge_c = value;
      FIELD'(load::F_EDGE_C_1): edges[2].edge_c = value;
      FIELD'(load::F_EDGE_C_2): edges[1].edge_c = value;
      default: edges[0].edge_c = value;
    endcase
    packed_message[MESSAGE_BITS-1-:SPAN_BITS] = span;
    packed_message[MESSAGE_BITS-1-SPAN_BITS-:4*SPAN_EDGE_BITS] = edges;
  end
endmodule
