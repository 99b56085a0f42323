// Load messages pass, and a span that begins in this column becomes a voxel. It goes on, advanced, while a copy
// waits for the unit that runs the microprograms, on a clock of its own. The cell is loaded when the scene has
// ended and the cycles of the cost table are over for all its voxels.
module span_unit
  import raycell_pkg::*;
  import raycell_cell::*;
#(
    parameter int KEPT_MOST = 256  // messages that wait for the unit
) (
    input  logic clock,
    input  logic fast_clock,
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
    output setup_t viewer,
    output logic loaded,  // in the cycle in which the last voxel is in order
    output logic idle,
    output logic computes,  // fast_clock is needed
    output logic failed,  // more than the memories hold
    // What the other units keep.
    output logic store_write,
    output logic [load::PORT_BITS-1:0] store_address,
    output logic signed [microcode::REGISTER_BITS-1:0] store_value,
    output logic [load::PORT_BITS-1:0] lines_end,
    output logic memory_write,
    output logic [1:0] memory_space,
    output logic [load::PORT_BITS-1:0] memory_address,
    output logic signed [microcode::REGISTER_BITS-1:0] memory_value
);
  // A message's length follows from what it holds.
  function automatic logic [15:0] link_cycles(input int bits);
    link_cycles = 16'((bits + LINK_BITS - 1) / LINK_BITS);
  endfunction

  localparam int BITS = MESSAGE_BITS + 16;
  localparam int COUNT = $clog2(BUFFER + 1);
  logic [COUNT-1:0] count;
  logic [BITS-1:0] head, second;
  time_t arrival, done_at, done_time;
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
      .replacement('0),
      .count,
      .head,
      .arrival,
      .second
  );

  span_head_t span;
  logic [EDGES_BITS-1:0] edges;
  logic [15:0] came;
  logic [TYPE_BITS-1:0] kind;
  logic ends, there, makes;
  logic [MESSAGE_BITS-1:0] as_it_came, advanced;
  span_advance to_next_column (
      .message (as_it_came),
      .advanced
  );
  assign {came, as_it_came} = head;
  always_comb begin
    viewer = setup_t'(as_it_came[MESSAGE_BITS-1-:SETUP_BITS]);
    edges = as_it_came[MESSAGE_BITS-1-EDGES_AT-:EDGES_BITS];
    span = span_head_t'(as_it_came[MESSAGE_BITS-1-:SPAN_HEAD_BITS]);
    kind = span.message_type;
    unique case (kind)
      LOAD_SETUP: send_cycles = link_cycles(LOAD_VIEWER_BITS + int'(viewer.sources) * LOAD_POINT_BITS);
      LOAD_FEATURES: send_cycles = link_cycles(LOAD_FEATURES_BITS);
      LOAD_SPAN: send_cycles = link_cycles(LOAD_SPAN_BITS + int'(edges) * LOAD_EDGE_BITS);
      LOAD_END_OF_SCENE: send_cycles = link_cycles(LOAD_END_BITS);
      default: send_cycles = came;
    endcase
    there = enable && count != '0;
    is_setup = there && kind == LOAD_SETUP;
    makes = kind == LOAD_SPAN && span.X1 == x;
    ends = kind == LOAD_SPAN ? span.Xr == x : int'(x) == COLUMNS - 1;
    done_time = waiting ? done_at : now + (makes ? TIME_BITS'(COST_LOAD_ADVANCE) : TIME_BITS'(COST_LOAD_FORWARD));
    take = there && now >= done_time && (ends || room);
    send = take && !ends;
    message = makes ? advanced : as_it_came;
  end
  logic unused;
  assign unused = &{1'b0, arrival, second, span.polygon, viewer, made, unit_ends, unit_advanced, stepping, computing, copying};

  // Kept: what the unit has to look at, in the order in which it came, and by when a voxel is made.
  localparam int PLACE = $clog2(KEPT_MOST);
  logic [MESSAGE_BITS-1:0] kept[0:KEPT_MOST-1];
  time_t made_at[0:KEPT_MOST-1];
  logic [PLACE:0] written, read;
  logic keep;
  assign keep = take && (makes || kind == LOAD_SETUP || kind == LOAD_FEATURES || kind == LOAD_END_OF_SCENE);

  time_t [LOADING_UNITS-1:0] made_by;  // the first is that whose turn it is
  time_t next_made, last_made;
  always_comb begin
    next_made = (made_by[0] > now ? made_by[0] : now) + TIME_BITS'(LOAD_VOXEL_CYCLES);
    last_made = '0;
    for (int i = 0; i < LOADING_UNITS; i++) if (made_by[i] > last_made) last_made = made_by[i];
  end
  logic closing;
  always_ff @(posedge clock) begin
    if (reset) begin
      waiting <= 1'b0;
      done_at <= '0;
      written <= '0;
      made_by <= '0;
      closing <= 1'b0;
    end else begin
      waiting <= there && !take;
      done_at <= done_time;
      if (keep) begin
        kept[written[PLACE-1:0]] <= as_it_came;
        made_at[written[PLACE-1:0]] <= next_made;
        written <= written + 1'b1;
      end
      if (take && makes) begin
        made_by[LOADING_UNITS-1] <= next_made;
        for (int i = 1; i < LOADING_UNITS; i++) made_by[i-1] <= made_by[i];
      end
      if (loaded) closing <= 1'b0;
      else if (ending) closing <= 1'b1;
    end
  end

  // The unit, one message after the other.
  logic [MESSAGE_BITS-1:0] present, unit_advanced;
  logic full, start, unit_busy, unit_done, made, unit_ends, stepping, computing, copying, unit_failed, finishing;
  logic [load::MEMORY_BITS-1:0] lines;
  time_t ordered;
  span_head_t present_head;
  assign present = kept[read[PLACE-1:0]];
  assign present_head = span_head_t'(present[MESSAGE_BITS-1-:SPAN_HEAD_BITS]);
  assign finishing = present_head.message_type == LOAD_END_OF_SCENE;
  assign start = written != read && !unit_busy;
  loading unit (
      .clock(fast_clock),
      .reset,
      .register_write(1'b0),  // its memory begins with the constants
      .register_address('0),
      .register_value('0),
      .column(x),
      .start(start && !finishing),
      .message(present),
      .finish(start && finishing),
      .busy(unit_busy),
      .done(unit_done),
      .failed(unit_failed),
      .made,
      .lines,
      .ends(unit_ends),
      .advanced(unit_advanced),
      .store_write,
      .store_address,
      .store_value,
      .lines_end,
      .memory_write,
      .memory_space,
      .memory_address,
      .memory_value,
      .stepping,
      .computing,
      .copying
  );
  logic is_span, at_work;
  assign is_span = present_head.message_type == LOAD_SPAN;
  always_ff @(posedge fast_clock) begin
    if (reset) begin
      read <= '0;
      ordered <= '0;
      full <= 1'b0;
      at_work <= 1'b0;
    end else begin
      if (start) at_work <= 1'b1;  // after a reset it is busy without a message
      else if (unit_done) at_work <= 1'b0;
      if (at_work && unit_done) begin
        read <= read + 1'b1;
        if (is_span && lines != '0)
          ordered <= (ordered > made_at[read[PLACE-1:0]] ? ordered : made_at[read[PLACE-1:0]]) +
              TIME_BITS'(lines) * TIME_BITS'(COST_LOAD_ORDER);
      end
      if ((PLACE + 1)'(written - read) > (PLACE + 1)'(KEPT_MOST)) full <= 1'b1;
    end
  end
  assign computes = written != read || unit_busy;
  assign failed = unit_failed || full;
  // The mark itself, which has the voxels written out, is not waited for.
  logic all_made, ending;
  always_comb begin
    ending = take && kind == LOAD_END_OF_SCENE;
    all_made = written == read || (closing && finishing && written == read + 1'b1);
    loaded = (closing || ending) && all_made && now >= last_made && now >= ordered;
  end
  assign idle = count == '0 && !computes && !closing;
  logic unused_head;
  assign unused_head = &{1'b0, present_head};
endmodule
