// Replays a record with the cell in a simulator of Verilog alone: drives it with NAME.in.hex and compares all
// that it does with NAME.out.hex, cycle by cycle. One record a run, up to its first cycle with a difference.
//   +stem=NAME +x=COLUMN +y=ROW +viewer=DIGITS (of rtl_kit --setup, filled with zeros) [+fault=N]
module cell_tb;
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;

  localparam int LINE_BITS = 48 + 4 + 4 + 4 + 32 + 16 + MESSAGE_BITS;
  localparam int LINES = 65536;
  localparam logic [3:0] IN = 0, FREE = 1, PHASE = 2, DRAIN = 3, OUT = 4, TAKE = 5, PIXEL = 6, END = 15;

  logic [LINE_BITS-1:0] told[LINES];
  logic [LINE_BITS-1:0] expected[LINES];

  logic clock = 1'b0, reset = 1'b1, phase_begins = 1'b0, draining = 1'b0, preset = 1'b0;
  time_t now = '0;
  logic [X_BITS-1:0] x;
  logic [Y_BITS-1:0] y;
  logic [1:0] phase = PHASE_LOAD;
  logic [MESSAGE_BITS-1:0] viewer;
  logic [SIDES:0] in_valid = '0;
  logic [SIDES:0][CLASS_BITS-1:0] in_class = '0;
  logic [SIDES:0][15:0] in_cycles = '0;
  logic [SIDES:0][MESSAGE_BITS-1:0] in_message = '0;
  logic [SIDES:0][CLASSES-1:0] take;
  logic [SIDES-1:0] out_valid;
  logic [SIDES-1:0][CLASS_BITS-1:0] out_class;
  logic [SIDES-1:0][15:0] out_cycles;
  logic [SIDES-1:0][MESSAGE_BITS-1:0] out_message;
  logic [SIDES-1:0][CLASSES-1:0] free = '0;
  logic pixel_valid, makes_voxel, idle;
  logic [3*WORD-1:0] pixel;

  empty_cell cell_under_test (
      .clock,
      .reset,
      .now,
      .x,
      .y,
      .phase,
      .phase_begins,
      .draining,
      .preset,
      .preset_viewer(viewer[MESSAGE_BITS-1-:SETUP_BITS]),
      .in_valid,
      .in_class,
      .in_cycles,
      .in_message,
      .take,
      .out_valid,
      .out_class,
      .out_cycles,
      .out_message,
      .free,
      .pixel_valid,
      .pixel,
      .makes_voxel,
      .idle,
      .asks(),
      .goes(),
      .stalls_full(),
      .stalls_wires(),
      .overdue(),
      .untested(),
      .goal(),
      .asks_since(),
      .ends(),
      .silent(),
      .again(),
      .postponed()
  );

  // A line's fields.
  logic [47:0] at;
  logic [3:0] what, side, index;
  logic [31:0] link;
  logic [15:0] bits;
  logic [MESSAGE_BITS-1:0] message;

  int next = 0, first = 0, pixel_line, last, compared = 0, cycles = 0, differences = 0;
  logic [LINES-1:0] seen = '0;

  task read_told(input int number);
    {at, what, side, index, link, bits, message} = told[number];
  endtask
  task read_expected(input int number);
    {at, what, side, index, link, bits, message} = expected[number];
  endtask

  function automatic logic [39:0] name_of(input int its_side);
    case (its_side)
      EAST: name_of = "east";
      SOUTH: name_of = "south";
      WEST: name_of = "west";
      NORTH: name_of = "north";
      default: name_of = "load";
    endcase
  endfunction
  function automatic logic [31:0] doing(input logic [3:0] its_what);
    doing = its_what == OUT ? "out" : "take";
  endfunction

  task tick;
    #1 clock = 1'b1;
    #1 clock = 1'b0;
    cycles = cycles + 1;
  endtask

  task begin_cycle;
    in_valid = '0;
    free = '0;
    phase_begins = 1'b0;
  endtask

  task tell;
    logic [CLASSES-1:0] freed;
    read_told(next);
    while (what != END && at <= now) begin
      case (what)
        IN: begin
          in_valid[side] = 1'b1;
          in_class[side] = index[CLASS_BITS-1:0];
          in_cycles[side] = link[15:0];
          in_message[side] = message;
        end
        FREE: begin
          freed = free[side];
          freed[index] = 1'b1;
          free[side] = freed;
        end
        PHASE: begin
          phase = index[1:0];
          phase_begins = 1'b1;
        end
        default: draining = index[0];
      endcase
      next = next + 1;
      read_told(next);
    end
  endtask

  // Something that the cell does: it has to be in the lines of this cycle, each of which counts once.
  task did(input logic [3:0] its_what, input int its_side, input int its_index, input logic [31:0] its_link,
           input logic [MESSAGE_BITS-1:0] its_message);
    int line;
    line = first;
    read_expected(line);
    while (what < PIXEL && !(!seen[line] && what == its_what && int'(side) == its_side && int'(index) == its_index)) begin
      line = line + 1;
      read_expected(line);
    end
    if (what >= PIXEL) begin
      $display("cycle %0d: %0s %0s %0d: nothing more is expected of it", now, doing(its_what), name_of(its_side), its_index);
      differences = differences + 1;
    end else if (at != now) begin
      $display("cycle %0d: %0s %0s %0d: expected in cycle %0d", now, doing(its_what), name_of(its_side), its_index, at);
      differences = differences + 1;
    end else begin
      seen[line] = 1'b1;
      compared = compared + 1;
      if (its_what == OUT && (its_link !== link || its_message !== message)) begin
        $display("cycle %0d: %0s %0s %0d: sent %0d %h, expected %0d %h", now, doing(its_what), name_of(its_side), its_index,
                 its_link, its_message, link, message);
        differences = differences + 1;
      end
    end
  endtask

  task compare;
    logic [CLASSES-1:0] taken;
    if (makes_voxel) begin
      $display("cycle %0d: a span begins in this cell, which can't make voxels", now);
      differences = differences + 1;
    end
    for (int s = 0; s <= SIDES; s++) begin
      taken = take[s];
      for (int c = 0; c < CLASSES; c++) if (taken[c] !== 1'b0) did(TAKE, s, c, 0, '0);
    end
    for (int s = 0; s < SIDES; s++)
      if (out_valid[s] !== 1'b0) did(OUT, s, int'(out_class[s]), {16'd0, out_cycles[s]}, out_message[s]);
    if (pixel_valid !== 1'b0) begin
      read_expected(pixel_line);
      if (what != PIXEL || at != now || message !== {pixel, {(MESSAGE_BITS - 3 * WORD) {1'b0}}}) begin
        $display("cycle %0d: pixel %h, expected in cycle %0d %h", now, pixel, at, message);
        differences = differences + 1;
      end
      compared = compared + 1;
      pixel_line = pixel_line + 1;
    end
    // The lines up to this cycle that it did not do.
    read_expected(first);
    while (what < PIXEL && at <= now) begin
      if (!seen[first]) begin
        $display("cycle %0d: %0s %0s %0d: it did not do what was expected in cycle %0d", now, doing(what), name_of(int'(side)),
                 index, at);
        differences = differences + 1;
      end
      first = first + 1;
      read_expected(first);
    end
  endtask

  string stem;
  int argument;
  initial begin
    if (!$value$plusargs("stem=%s", stem)) stem = "";
    $readmemh({stem, ".in.hex"}, told);
    $readmemh({stem, ".out.hex"}, expected);
    if (!$value$plusargs("x=%d", argument)) argument = 0;
    x = argument[X_BITS-1:0];
    if (!$value$plusargs("y=%d", argument)) argument = 0;
    y = argument[Y_BITS-1:0];
    if (!$value$plusargs("viewer=%h", viewer)) viewer = '0;
`ifdef RTL_FAULTS
    if ($value$plusargs("fault=%d", argument)) fault = argument;
`endif
    pixel_line = 0;
    read_expected(0);
    while (what < PIXEL) begin
      pixel_line = pixel_line + 1;
      read_expected(pixel_line);
    end
    last = 0;
    read_told(0);
    while (what < END) begin
      last = last + 1;
      read_told(last);
    end
    if (what !== END) begin
      $display("cycle 0: the record has more than %0d lines, or is not whole", LINES);
      differences = 1;
    end
    last = int'(at);

    tick;
    reset = 1'b0;
    // The viewer's message comes with the record, or the cell is told it in reset.
    read_told(0);
    if (!(what == IN && message[MESSAGE_BITS-1-:3] % 7 == 0 && int'(bits) > SETUP_BITS)) begin
      preset = 1'b1;
      tick;
      preset = 1'b0;
      for (int i = 0; i < 8; i++) tick;
    end
    cycles = 0;

    now = 1;
    argument = 1;  // goes on
    while (argument == 1 && int'(now) <= last && differences == 0) begin
      read_told(next);
      if (idle === 1'b1 && what == END) argument = 0;
      else begin
        if (idle === 1'b1 && at > now) now = at;  // nothing happens before it
        begin_cycle;
        tell;
        #1 compare;
        tick;
        now = now + 1;
        begin_cycle;
        #1;
      end
    end
    if (differences == 0) begin
      read_expected(first);
      if (what < PIXEL) begin
        $display("cycle %0d: %0s %0s %0d: it never did what was expected in cycle %0d", last, doing(what), name_of(int'(side)),
                 index, at);
        differences = differences + 1;
      end
      read_expected(pixel_line);
      if (what == PIXEL) begin
        $display("cycle %0d: its pixel was never complete, expected in cycle %0d", last, at);
        differences = differences + 1;
      end
    end
    $display("%0d differences, %0d events compared, %0d cycles", differences, compared, cycles);
    $finish(0);
  end
endmodule
