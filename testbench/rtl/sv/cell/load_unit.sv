// Load messages pass: each is looked at for some cycles and goes on over the east. A span that begins in this
// column would have to become a voxel, which this cell can't make: it says so.
module load_unit
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic enable,
    input  logic [X_BITS-1:0] x,
    input  logic arrives,
    input  logic [15:0] arrives_cycles,
    input  logic [MESSAGE_BITS-1:0] arrives_message,
    input  logic room,  // over the east
    output logic take,
    output logic send,
    output logic [15:0] send_cycles,
    output logic [MESSAGE_BITS-1:0] message,
    output logic is_setup,
    output logic makes_voxel,
    output logic idle
);
  // A message's length follows from what it holds. Where sources have kinds it would take a look at each, so
  // that message goes on as long as it came. All lengths are constants, so that nothing is divided.
  function automatic logic [15:0] link_cycles(input int bits);
    link_cycles = 16'((bits + LINK_BITS - 1) / LINK_BITS);
  endfunction

  localparam int MOST_SOURCES = 128;  // the field has 7 bits
  localparam int BITS = MESSAGE_BITS + 16;
  localparam int COUNT = $clog2(BUFFER + 1);
  logic [COUNT-1:0] count;
  logic [BITS-1:0] head, second;
  time_t arrival, done_at, done;
  logic waiting;  // looked at before this cycle

  message_buffer #(
      .BITS (BITS),
      .DEPTH(BUFFER)
  ) buffer (
      .clock,
      .reset,
      .push(arrives),
      .push_message({arrives_cycles, arrives_message}),
      .push_arrival(now + 1'b1),
      .pop(take),
      .replace(1'b0),
      .replacement({BITS{1'b0}}),
      .count,
      .head,
      .arrival,
      .second
  );
  logic unused;
  assign unused = &{1'b0, arrival, second};

  span_head_t span;
  setup_t viewer;
  logic [EDGES_BITS-1:0] edges;
  logic [15:0] came, viewer_cycles, span_cycles;
  logic [TYPE_BITS-1:0] kind;
  logic ends, there;
  always_comb begin
    {came, message} = head;
    viewer = message[MESSAGE_BITS-1-:SETUP_BITS];
    edges = LOAD_EDGE_BITS > 0 ? message[MESSAGE_BITS-1-EDGES_AT-:EDGES_BITS] : '0;
    span = message[MESSAGE_BITS-1-:SPAN_HEAD_BITS];
    kind = span.message_type;
    viewer_cycles = '0;
    for (int i = 0; i < MOST_SOURCES; i++)
      if (int'(viewer.sources) == i) viewer_cycles = link_cycles(LOAD_VIEWER_BITS + i * LOAD_POINT_BITS);
    span_cycles = '0;
    for (int i = 0; i < 1 << EDGES_BITS; i++)
      if (int'(edges) == i) span_cycles = link_cycles(LOAD_SPAN_BITS + i * LOAD_EDGE_BITS);
  end

  always_comb begin
    unique case (kind)
      LOAD_SETUP: send_cycles = viewer_cycles;
      LOAD_FEATURES: send_cycles = link_cycles(LOAD_FEATURES_BITS);
      LOAD_SPAN: send_cycles = span_cycles;
      LOAD_END_OF_SCENE: send_cycles = link_cycles(LOAD_END_BITS);
      default: send_cycles = came;
    endcase
    there = enable && count != '0;
    is_setup = there && (kind == LOAD_SETUP || kind == LOAD_SETUP_OF_KINDS);
    makes_voxel = there && kind == LOAD_SPAN && span.X1 == x;
    ends = kind == LOAD_SPAN ? span.Xr == x : int'(x) == COLUMNS - 1;
    done = waiting ? done_at : now + TIME_BITS'(COST_LOAD_FORWARD);
    take = there && !makes_voxel && now >= done && (ends || room);
    send = take && !ends;
    idle = count == '0;
  end
  logic unused_fields;
  assign unused_fields = &{1'b0, span.polygon, viewer};

  always_ff @(posedge clock) begin
    if (reset) begin
      waiting <= 1'b0;
      done_at <= '0;
    end else begin
      waiting <= there && !take;
      done_at <= done;
    end
  end
endmodule
