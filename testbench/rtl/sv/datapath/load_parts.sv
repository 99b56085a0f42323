// A part of a load message as a word, by the number of the unit's field that takes it.
module load_parts
  import raycell_pkg::*;
(
    input  logic        [MESSAGE_BITS-1:0]             message,
    input  logic        [X_BITS-1:0]                   column,  // of the cell
    input  logic        [load::FIELD_BITS-1:0]         part,
    input  logic        [SOURCES_BITS-1:0]             source,  // which of the viewer's message
    output logic signed [microcode::REGISTER_BITS-1:0] word
);
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int FIELD = load::FIELD_BITS;
  localparam int AT_BITS = $clog2(MESSAGE_BITS + 1) + SOURCES_BITS;

  span_t                   span;
  span_edge_t [3:0]        edges;  // the first in the highest bits
  features_t               features;
  setup_t                  viewer;
  point_t                  point;
  logic [AT_BITS-1:0]      source_at;
  logic [MESSAGE_BITS-1:0] from_source;
  assign span = message[MESSAGE_BITS-1-:SPAN_BITS];
  assign edges = message[MESSAGE_BITS-1-SPAN_BITS-:4*SPAN_EDGE_BITS];
  assign features = message[MESSAGE_BITS-1-:FEATURES_BITS];
  assign viewer = message[MESSAGE_BITS-1-:SETUP_BITS];
  assign source_at = AT_BITS'(SETUP_BITS) + AT_BITS'(POINT_BITS) * AT_BITS'(source);
  assign from_source = message << source_at;
  assign point = from_source[MESSAGE_BITS-1-:POINT_BITS];
  logic unused;
  assign unused = &{1'b0, viewer, features.message_type, from_source};

  always_comb
    case (part)
      FIELD'(load::F_TYPE): word = BITS'(span.message_type);
      FIELD'(load::F_POLYGON): word = BITS'(span.polygon);
      FIELD'(load::F_X): word = BITS'(span.X1);
      FIELD'(load::F_LAST): word = BITS'(span.Xr);
      FIELD'(load::F_AXIS): word = BITS'(span.axis);
      FIELD'(load::F_NEGATIVE): word = BITS'(span.sign);
      FIELD'(load::F_NU): word = BITS'($signed(span.slope_u));
      FIELD'(load::F_NV): word = BITS'($signed(span.slope_v));
      FIELD'(load::F_C): word = BITS'($signed(span.offset));
      FIELD'(load::F_SLACK): word = BITS'($signed(span.slack));
      FIELD'(load::F_BX): word = BITS'($signed(span.n_x));
      FIELD'(load::F_BY): word = BITS'($signed(span.n_y));
      FIELD'(load::F_BZ): word = BITS'($signed(span.n_z));
      FIELD'(load::F_UX): word = BITS'($signed(span.nu_x));
      FIELD'(load::F_UY): word = BITS'($signed(span.nu_y));
      FIELD'(load::F_UZ): word = BITS'($signed(span.nu_z));
      FIELD'(load::F_VX): word = BITS'($signed(span.nv_x));
      FIELD'(load::F_VY): word = BITS'($signed(span.nv_y));
      FIELD'(load::F_VZ): word = BITS'($signed(span.nv_z));
      FIELD'(load::F_EDGES): word = BITS'(span.edges);
      FIELD'(load::F_EDGE_A_0): word = BITS'($signed(edges[3].edge_a));
      FIELD'(load::F_EDGE_B_0): word = BITS'($signed(edges[3].edge_b));
      FIELD'(load::F_EDGE_C_0): word = BITS'($signed(edges[3].edge_c));
      FIELD'(load::F_EDGE_A_1): word = BITS'($signed(edges[2].edge_a));
      FIELD'(load::F_EDGE_B_1): word = BITS'($signed(edges[2].edge_b));
      FIELD'(load::F_EDGE_C_1): word = BITS'($signed(edges[2].edge_c));
      FIELD'(load::F_EDGE_A_2): word = BITS'($signed(edges[1].edge_a));
      FIELD'(load::F_EDGE_B_2): word = BITS'($signed(edges[1].edge_b));
      FIELD'(load::F_EDGE_C_2): word = BITS'($signed(edges[1].edge_c));
      FIELD'(load::F_EDGE_A_3): word = BITS'($signed(edges[0].edge_a));
      FIELD'(load::F_EDGE_B_3): word = BITS'($signed(edges[0].edge_b));
      FIELD'(load::F_EDGE_C_3): word = BITS'($signed(edges[0].edge_c));
      FIELD'(load::F_CX): word = BITS'(features.red);
      FIELD'(load::F_CY): word = BITS'(features.green);
      FIELD'(load::F_CZ): word = BITS'(features.blue);
      FIELD'(load::F_KD): word = BITS'(features.Kd);
      FIELD'(load::F_KS): word = BITS'(features.Ks);
      FIELD'(load::F_TRANSMIT): word = BITS'(features.T);
      FIELD'(load::F_SHINE_EXPONENT): word = BITS'(features.Shine_exponent);
      FIELD'(load::F_SHINE_FRACTION): word = BITS'(features.Shine_fraction);
      FIELD'(load::F_IOR): word = BITS'(features.index);
      FIELD'(load::F_MIRRORS): word = BITS'(features.mirror);
      FIELD'(load::F_SOURCES): word = BITS'(viewer.sources);
      FIELD'(load::F_SX): word = BITS'($signed(point.place_x));
      FIELD'(load::F_SY): word = BITS'($signed(point.place_y));
      FIELD'(load::F_SZ): word = BITS'($signed(point.place_z));
      FIELD'(load::F_SOURCE_EXPONENT): word = BITS'($signed(point.place_exponent));
      FIELD'(load::F_IX): word = BITS'($signed(point.red));
      FIELD'(load::F_IY): word = BITS'($signed(point.green));
      FIELD'(load::F_IZ): word = BITS'($signed(point.blue));
      default: word = BITS'(column);
    endcase
endmodule
