// A traversal unit of a cell with voxels: the ray's words go into the unit that runs the microprograms, on a
// clock of its own, and its decision is held until the cycles of the cost table are over.
module visit_unit
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
  import raycell_whole::*;
(
    input  logic clock,
    input  logic fast_clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  known_t known,
    input  logic start,
    input  logic [ALL_INDEX_BITS-1:0] start_place,
    input  logic [RAY_BITS-1:0] start_message,
    input  logic start_fresh,  // it has not left this cell yet
    output logic busy,
    output logic done,  // in its last cycle
    output logic [ALL_INDEX_BITS-1:0] place,
    output decision_t decision,
    output logic late,  // the microprograms took longer than the cost table says
    // The voxels, written while nothing is tested.
    input  logic store_write,
    input  logic [visit::STORE_BITS-1:0] store_address,
    input  logic signed [microcode::REGISTER_BITS-1:0] store_value,
    input  logic [visit::STORE_BITS-1:0] lines_end
);
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int FIELD = visit::FIELD_BITS;
  localparam logic [WORD-1:0] REACH_MOST = {1'b0, {(WORD - 1) {1'b1}}};  // infinite

  typedef logic signed [BITS-1:0] word_t;

  // The ray under test.
  logic [RAY_BITS-1:0] message;
  logic fresh, shadow, outside, finite;
  time_t began;
  ray_t ray;
  shadow_ray_t shadow_ray;
  logic [19:0] polygon_left;
  always_comb begin
    ray = ray_t'(message);
    shadow_ray = shadow_ray_t'(message[RAY_BITS-1-:SHADOW_RAY_BITS]);
    shadow = ray.message_type == TYPE_SHADOW_RAY;
    outside = shadow ? shadow_ray.outside : ray.outside;
    finite = shadow && shadow_ray.reach != REACH_MOST;
    polygon_left = shadow ? shadow_ray.polygon_left : ray.polygon_left;
  end

  // Its words, one a cycle of the fast clock, then the test, then what the test has found.
  localparam logic [2:0] WAIT = 0, WRITE = 1, TEST = 2, RUN = 3, READ = 4, OVER = 5;
  localparam int WORDS_IN = 13;
  localparam int WORDS_OUT = 7;
  logic [2:0] step;
  logic [3:0] count;
  logic [FIELD-1:0] field_address;
  word_t field_value, field;
  logic field_write, unit_start, unit_busy, in_test;
  logic [1:0] what;
  word_t voxel;

  function automatic word_t signed_word(input logic [WORD-1:0] word);
    signed_word = word_t'($signed(word));
  endfunction

  always_comb begin
    field_write = step == WRITE;
    unit_start = step == TEST;
    field_value = '0;
    field_address = '0;
    if (step == WRITE)
      unique case (int'(count))
        0: {field_address, field_value} = {FIELD'(visit::F_X), signed_word(ray.x)};
        1: {field_address, field_value} = {FIELD'(visit::F_Y), signed_word(ray.y)};
        2: {field_address, field_value} = {FIELD'(visit::F_Z), word_t'($signed(ray.z))};
        3: {field_address, field_value} = {FIELD'(visit::F_DX), signed_word(ray.dx)};
        4: {field_address, field_value} = {FIELD'(visit::F_DY), signed_word(ray.dy)};
        5: {field_address, field_value} = {FIELD'(visit::F_DZ), signed_word(ray.dz)};
        6: {field_address, field_value} = {FIELD'(visit::F_MX), word_t'({1'b0, ray.inverse_dx_mantissa})};
        7: {field_address, field_value} = {FIELD'(visit::F_EX), word_t'($signed(ray.inverse_dx_exponent))};
        8: {field_address, field_value} = {FIELD'(visit::F_MY), word_t'({1'b0, ray.inverse_dy_mantissa})};
        9: {field_address, field_value} = {FIELD'(visit::F_EY), word_t'($signed(ray.inverse_dy_exponent))};
        10: {field_address, field_value} = {FIELD'(visit::F_REACH), signed_word(shadow ? shadow_ray.reach : REACH_MOST)};
        11: {field_address, field_value} =
            {FIELD'(visit::F_POLYGON_LEFT), &polygon_left ? -word_t'(1) : word_t'({1'b0, polygon_left})};
        default: {field_address, field_value} = {FIELD'(visit::F_LEAVES), word_t'({1'b0, fresh && !(&polygon_left) && fault != FAULT_LEFT})};
      endcase
    else if (step == READ)
      unique case (int'(count))
        0: field_address = FIELD'(visit::F_SIDE);
        1: field_address = FIELD'(visit::F_FLAGS);
        2: field_address = FIELD'(visit::F_NEXT_X);
        3: field_address = FIELD'(visit::F_NEXT_Y);
        4: field_address = FIELD'(visit::F_Z1);
        5: field_address = FIELD'(visit::F_NEXT_REACH);
        default: field_address = FIELD'(visit::F_BEST);
      endcase
  end

  logic counts_run, counts_test, counts_edge, counts_leave, computing, copying;
  logic [7:0] edges_of_test;
  traversal unit (
      .clock(fast_clock),
      .reset,
      .store_write,
      .store_address,
      .store_value,
      .lines_end,
      .register_write(1'b0),  // its memory begins with the constants
      .register_address('0),
      .register_value('0),
      .field_write,
      .field_address,
      .field_value,
      .field,
      .start(unit_start),
      .shadow,
      .finite,
      .outside,
      .busy(unit_busy),
      .what,
      .voxel,
      .counts_run,
      .counts_test,
      .counts_edge,
      .counts_leave,
      .edges_of_test,
      .computing,
      .copying
  );
  logic unused;
  assign unused = &{1'b0, counts_edge, computing, copying, voxel, field};

  // What is found, and the cycles that it is charged for.
  logic [1:0] side;
  logic axial, leaves;
  logic [WORD-1:0] next_x, next_y, next_reach;
  logic [DEPTH_BITS-1:0] next_z;
  logic [DISTANCE_BITS-1:0] hit_t;
  logic [15:0] runs, tests, edges;
  localparam int TEST_COST = (visit::HAS_EDGES != 0 ? COST_COMPARE_EDGE : COST_ENTER_RUN) + COST_RECIPROCAL;
  localparam int LEAVING = COST_LEAVE_CUBE > 0 ? COST_LEAVE_CUBE + COST_RECIPROCAL : 0;

  always_ff @(posedge fast_clock) begin
    if (reset) begin
      step <= WAIT;
      count <= '0;
      side <= '0;
      axial <= 1'b0;
      leaves <= 1'b0;
      {next_x, next_y, next_z, next_reach, hit_t} <= '0;
      {runs, tests, edges} <= '0;
    end else begin
      count <= '0;
      unique case (step)
        WAIT: begin
          if (in_test) step <= WRITE;
          leaves <= 1'b0;
          {runs, tests, edges} <= '0;
        end
        WRITE: begin
          count <= count + 1'b1;
          if (int'(count) == (visit::HAS_EDGES != 0 ? WORDS_IN : WORDS_IN - 1) - 1) step <= TEST;
        end
        TEST: step <= RUN;
        RUN: if (!unit_busy) step <= READ;
        READ: begin
          count <= count + 1'b1;
          unique case (int'(count))
            0: side <= field[1:0];
            1: axial <= field[1:0] == 2'd2;
            2: next_x <= field[WORD-1:0];
            3: next_y <= field[WORD-1:0];
            4: next_z <= field[DEPTH_BITS-1:0];
            5: next_reach <= field[WORD-1:0];
            default: hit_t <= field[DISTANCE_BITS-1:0];
          endcase
          if (int'(count) == WORDS_OUT - 1) step <= OVER;
        end
        default: if (!in_test) step <= WAIT;
      endcase
      if (step == TEST || step == RUN) begin
        if (counts_leave) leaves <= 1'b1;
        runs <= runs + 16'(counts_run);
        tests <= tests + 16'(counts_test);
        edges <= edges + 16'(edges_of_test);
      end
    end
  end

  time_t last;
  always_comb begin
    last = began + TIME_BITS'(COST_WALK_STEP) - 1'b1 + (leaves ? TIME_BITS'(LEAVING) : '0) +
        TIME_BITS'(runs) * TIME_BITS'(COST_COMPARE_INTERVAL) + TIME_BITS'(tests) * TIME_BITS'(TEST_COST) +
        TIME_BITS'(edges) * TIME_BITS'(COST_PER_EDGE);
    done = busy && step == OVER && now >= last;
    late = done && now != last;
  end

  // Where it goes then.
  localparam logic [1:0] HIT = 2'd1, LEAVES = 2'd2, SOURCE = 2'd3;
  logic over_border, nothing_there, dz_positive;
  logic [1:0] way;
  logic [2:0] face;
  always_comb begin
    way = axial ? 2'(EAST) : side;
    dz_positive = !ray.dz[WORD-1] && ray.dz != '0;
    unique case (int'(way))
      EAST: over_border = int'(x) == COLUMNS - 1;
      SOUTH: over_border = int'(y) == ROWS - 1;
      WEST: over_border = x == 0;
      default: over_border = y == 0;
    endcase
    if (outside || what == LEAVES) face = dz_positive ? 3'd0 : 3'd1;
    else
      unique case (int'(way))  // bit of `beyond`, whose first field is in the highest one
        EAST: face = 3'd4;
        SOUTH: face = 3'd2;
        WEST: face = 3'd5;
        default: face = 3'd3;
      endcase
    nothing_there = !(EXTERIOR && known.beyond[face]);

    decision = '0;
    decision.side = way;
    decision.outside = outside;
    decision.x = ray.x;
    decision.y = ray.y;
    decision.z = ray.z;
    decision.reach = shadow_ray.reach;
    decision.t = hit_t;
    decision.voxel = voxel[VOXEL_BITS-1:0];
    unique case (what)
      HIT: begin
        decision.need = shadow ? NEED_ANSWER : NEED_SLOT;
        decision.blocked = shadow;
      end
      SOURCE: decision.need = NEED_ANSWER;
      default: begin
        decision.lost = (what == LEAVES || over_border) && nothing_there;
        decision.need = decision.lost ? NEED_ANSWER : what == LEAVES ? NEED_TEST : NEED_OUTPUT;
        if (what == LEAVES) decision.outside = 1'b1;
        if (decision.need == NEED_TEST || (decision.need == NEED_OUTPUT && !over_border && !axial)) begin
          decision.x = next_x;
          decision.y = next_y;
          decision.z = next_z;
          if (finite) decision.reach = next_reach;
        end
      end
    endcase
  end

  always_ff @(posedge clock) begin
    if (reset) begin
      busy <= 1'b0;
      in_test <= 1'b0;
      message <= '0;
      fresh <= 1'b0;
      began <= '0;
      place <= '0;
    end else if (start) begin
      busy <= 1'b1;
      in_test <= 1'b1;
      message <= start_message;
      fresh <= start_fresh;
      began <= now;
      place <= start_place;
    end else if (done) begin
      busy <= 1'b0;
      in_test <= 1'b0;
    end
  end
endmodule
