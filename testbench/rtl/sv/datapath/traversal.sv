// A traversal unit: for a ray in a cell it walks, compares the depth runs of the cell's voxels in the order of the
// index table, makes the rung's test (`interval` or `edge`), and decides. All numbers are computed by microprograms;
// here is only their order. While it is idle the ray is written into its fields, and fields are read.
module traversal (
    input  logic                                              clock,
    input  logic                                              reset,
    // The store: the voxels in the order of the index table, then their edges.
    input  logic                                              store_write,
    input  logic        [visit::STORE_BITS-1:0]               store_address,
    input  logic signed [microcode::REGISTER_BITS-1:0]        store_value,
    input  logic        [visit::STORE_BITS-1:0]               lines_end,  // behind the last voxel
    // Constants of the microprograms, written once.
    input  logic                                              register_write,
    input  logic        [microcode::REGISTER_ADDRESS_BITS-1:0] register_address,
    input  logic signed [microcode::REGISTER_BITS-1:0]        register_value,
    // A ray.
    input  logic                                              field_write,
    input  logic        [visit::FIELD_BITS-1:0]               field_address,
    input  logic signed [microcode::REGISTER_BITS-1:0]        field_value,
    output logic signed [microcode::REGISTER_BITS-1:0]        field,
    input  logic                                              start,
    input  logic                                              shadow,
    input  logic                                              finite,   // its reach
    input  logic                                              outside,  // it has left the cube
    // What becomes of it.
    output logic                                              busy,
    output logic        [1:0]                                 what,     // 0 goes on, 1 hit, 2 leaves, 3 source
    output logic signed [microcode::REGISTER_BITS-1:0]        voxel,
    output logic                                              counts_run,
    output logic                                              counts_test,
    output logic                                              counts_edge,
    output logic                                              counts_leave,
    output logic        [7:0]                                 edges_of_test,  // of the voxel, whether computed or not
    output logic                                              computing,
    output logic                                              copying
);
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int ADDRESS = microcode::REGISTER_ADDRESS_BITS;
  localparam int PLACE = visit::STORE_BITS;
  localparam int FIELD = visit::FIELD_BITS;
  localparam int CALL = visit::CALL_BITS;
  localparam logic [PLACE-1:0] VOXEL_WORDS = PLACE'(visit::VOXEL_WORDS);
  localparam logic [PLACE-1:0] EDGE_WORDS = PLACE'(visit::EDGE_WORDS);
  localparam logic [PLACE-1:0] PIECE = PLACE'(visit::EDGE_WORDS - 1);
  localparam logic [1:0] FORWARD = 2'd0, HIT = 2'd1, LEAVES = 2'd2, SOURCE = 2'd3;
  localparam logic [3:0] IDLE = 4'd0, CALLS = 4'd1, WALKED = 4'd2, REACH = 4'd3, RANGE = 4'd4, LINE = 4'd5,
      MEETS = 4'd6, TESTED = 4'd7, EDGE = 4'd8, EDGE_DONE = 4'd9, CLOSER = 4'd10, COMPARED = 4'd11, KEEP = 4'd12,
      NEXT = 4'd13, LAST = 4'd14, DECIDE = 4'd15;

  logic signed [BITS-1:0] fields[0:visit::FIELDS-1];
  logic signed [BITS-1:0] store [0:visit::STORE_WORDS-1];
  logic [3:0]             state, after, next;
  logic [PLACE-1:0]       line, passed, edge_place, read_place, edges_left;
  logic signed [BITS-1:0] piece, piece_now, best_polygon, read_register, copied, set_value;
  logic                   encloses, begins, other_piece, found, inwards, no_more, starts, call_done, run, to_field, sets;
  logic [CALL-1:0]        call;
  logic [FIELD-1:0]       set_field;
  logic [1:0]             space;
  logic [visit::SOURCE_BITS-1:0] from;
  logic [visit::TO_BITS-1:0]     to;
  logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] entry;

  assign field = fields[field_address];
  assign busy = state != IDLE;
  assign inwards = fields[visit::F_DZ] >= 0;
  assign no_more = passed == lines_end;
  assign piece_now = store[edge_place+PIECE];
  assign other_piece = !begins && piece_now != piece;
  assign counts_run = state == LINE && starts;
  assign counts_test = state == MEETS && starts;
  assign counts_edge = state == EDGE && starts;
  assign counts_leave = state == WALKED && starts;
  assign edges_of_test = visit::HAS_EDGES != 0 && state == TESTED ? 8'(fields[visit::F_EDGES]) : '0;

  copier #(
      .CALLS(visit::CALLS), .CALL(visit::CALL_BITS), .COPIES(visit::COPIES), .COPY(visit::COPY_BITS),
      .FROM(visit::SOURCE_BITS), .TO(visit::TO_BITS)
  ) caller (
      .clock(clock), .reset(reset), .start(starts), .call(call), .done(call_done), .copying(copying), .space(space),
      .from(from), .to_space(to_field), .to(to), .run(run), .entry(entry), .busy(computing));

  assign read_place = (space == 2'd1 ? line : edge_place) + PLACE'(from);
  assign copied = space == 2'd0 ? fields[FIELD'(from)] : space == 2'd3 ? read_register : store[read_place];

  datapath #(
      .ACCUMULATOR_BITS(visit::ACCUMULATOR_BITS), .REGISTERS(visit::REGISTERS), .INSTRUCTIONS(visit::INSTRUCTIONS),
      .LINES(visit::LINES), .REGISTER_FILE("registers.hex")
  ) computer (
      .clock(clock), .reset(reset), .start(run), .entry(entry), .busy(computing),
      .write(busy ? copying && !to_field : register_write),
      .write_address(busy ? ADDRESS'(to) : register_address), .write_value(busy ? copied : register_value),
      .read_address(ADDRESS'(from)), .read_value(read_register));

  // Fields are copies, but for three.
  always_comb begin
    sets = 1'b1;
    set_field = field_address;
    set_value = field_value;
    case (state)
      IDLE: sets = field_write;
      WALKED: begin
        set_field = FIELD'(visit::F_AXIAL);
        set_value = BITS'({1'b0, fields[visit::F_FLAGS] == 2});
      end
      CLOSER: begin
        set_field = FIELD'(visit::F_LOWER);
        set_value = BITS'({1'b0, found && fields[visit::F_POLYGON] < best_polygon});
      end
      KEEP: begin
        set_field = FIELD'(visit::F_BEST);
        set_value = fields[visit::F_HIT_T];
      end
      default: sets = 1'b0;
    endcase
  end

  always_ff @(posedge clock) begin
    if (copying && to_field) fields[FIELD'(to)] <= copied;
    else if (sets) fields[set_field] <= set_value;
    if (store_write) store[store_address] <= store_value;
  end

  // What is called in a state, and the state after it.
  always_comb begin
    starts = 1'b0;
    call = '0;
    next = IDLE;
    case (state)
      IDLE: begin
        starts = start;
        call = CALL'(visit::CALL_WALK);
        next = start ? WALKED : IDLE;
      end
      CALLS: next = call_done ? after : CALLS;
      WALKED: begin
        starts = !outside && fields[visit::F_FLAGS] != 0;
        call = CALL'(visit::CALL_LEAVE);
        next = outside ? IDLE : REACH;
      end
      REACH: begin
        starts = finite && fields[visit::F_LEFT] <= 0;
        call = CALL'(visit::CALL_REACHED);
        next = RANGE;
      end
      RANGE: begin
        starts = 1'b1;
        call = CALL'(visit::CALL_RANGE);
        next = LINE;
      end
      LINE: begin
        starts = !no_more;
        call = inwards ? CALL'(visit::CALL_RUN) : CALL'(visit::CALL_RUN_OUTWARDS);
        next = no_more ? LAST : MEETS;
      end
      MEETS: begin
        starts = fields[visit::F_MEETS] == 1 && fields[visit::F_POLYGON] != fields[visit::F_POLYGON_LEFT];
        call = CALL'(visit::CALL_TEST);
        next = fields[visit::F_MEETS] == 2 ? LAST : starts ? TESTED : NEXT;
      end
      TESTED: begin
        starts = visit::HAS_EDGES != 0 && fields[visit::F_HIT] != 0 && fields[visit::F_EDGES] != 0;
        call = CALL'(visit::CALL_PROJECTION);
        next = starts ? EDGE : fields[visit::F_HIT] != 0 ? CLOSER : NEXT;
      end
      EDGE: begin  // inside all edges of one piece; no more are computed than it takes to know
        starts = edges_left != 0 && !other_piece && encloses;
        call = CALL'(visit::CALL_EDGE);
        next = starts ? EDGE_DONE : encloses && (edges_left == 0 || other_piece) ? CLOSER : edges_left == 0 ? NEXT : EDGE;
      end
      EDGE_DONE: next = EDGE;
      CLOSER: begin
        starts = found;
        call = CALL'(visit::CALL_NEARER);
        next = found ? COMPARED : KEEP;
      end
      COMPARED: next = fields[visit::F_NEARER] != 0 ? KEEP : NEXT;
      KEEP: begin
        starts = 1'b1;
        call = CALL'(visit::CALL_NARROW);
        next = NEXT;
      end
      NEXT: next = LINE;
      LAST: begin
        starts = found && shadow && finite;
        call = CALL'(visit::CALL_AT_SOURCE);
        next = starts ? DECIDE : IDLE;
      end
      default: next = IDLE;
    endcase
  end

  always_ff @(posedge clock)
    if (reset) begin
      state <= IDLE;
    end else begin
      state <= starts ? CALLS : next;
      if (starts) after <= next;
      case (state)
        IDLE: begin
          found <= 1'b0;
          passed <= '0;
          if (start) what <= FORWARD;
        end
        WALKED: if (starts) what <= LEAVES;
        REACH: if (starts) what <= SOURCE;
        RANGE: line <= inwards ? '0 : lines_end - VOXEL_WORDS;
        TESTED: begin
          edge_place <= PLACE'(fields[visit::F_FIRST]);
          edges_left <= PLACE'(fields[visit::F_EDGES]);
          encloses <= 1'b1;
          begins <= 1'b1;
        end
        EDGE: begin
          begins <= other_piece;
          if (starts) piece <= piece_now;
          else if (other_piece) encloses <= 1'b1;
          else begin  // the point is outside of this piece
            edge_place <= edge_place + EDGE_WORDS;
            edges_left <= edges_left - 1'b1;
          end
        end
        EDGE_DONE: begin
          encloses <= fields[visit::F_INSIDE] != 0;
          edge_place <= edge_place + EDGE_WORDS;
          edges_left <= edges_left - 1'b1;
        end
        KEEP: begin
          found <= 1'b1;
          best_polygon <= fields[visit::F_POLYGON];
          voxel <= fields[visit::F_NUMBER];
        end
        NEXT: begin
          line <= inwards ? line + VOXEL_WORDS : line - VOXEL_WORDS;
          passed <= passed + VOXEL_WORDS;
        end
        LAST: if (found && !starts) what <= HIT;
        DECIDE: if (fields[visit::F_THERE] == 0) what <= HIT;
        default: ;
      endcase
    end
endmodule
