// Loading from spans: makes the voxel of a span that begins in this column, or has it join the one stored last,
// puts it in the index table, moves the span on to the next column; latches objects and sources. All numbers are
// computed by microprograms; their order is a script that is written with them. Objects and sources are written out
// as they come, voxels when the scene ends.
module loading
  import raycell_pkg::*;
(
    input  logic                                               clock,
    input  logic                                               reset,
    // Constants of the microprograms, written once.
    input  logic                                               register_write,
    input  logic        [microcode::REGISTER_ADDRESS_BITS-1:0] register_address,
    input  logic signed [microcode::REGISTER_BITS-1:0]         register_value,
    // A load message, the first bit sent in the highest; held while the unit is busy.
    input  logic        [X_BITS-1:0]                           column,
    input  logic                                               start,
    input  logic        [MESSAGE_BITS-1:0]                     message,
    input  logic                                               finish,    // instead: the scene ends, write out
    output logic                                               busy,
    output logic                                               done,      // in the last cycle
    output logic                                               failed,    // told what it can't do; for ever
    // What became of a span.
    output logic                                               made,      // a voxel, or a piece that joined one
    output logic        [load::MEMORY_BITS-1:0]                lines,     // of the index table that were read
    output logic                                               ends,      // here; else `advanced` goes on
    output logic        [MESSAGE_BITS-1:0]                     advanced,
    // The traversal units' store: the voxels in the order of the index table, then the edges.
    output logic                                               store_write,
    output logic        [load::PORT_BITS-1:0]                  store_address,
    output logic signed [microcode::REGISTER_BITS-1:0]         store_value,
    output logic        [load::PORT_BITS-1:0]                  lines_end, // behind the last voxel
    // The shading unit's words: 0 voxels by their numbers, 1 objects, 2 sources.
    output logic                                               memory_write,
    output logic        [1:0]                                  memory_space,
    output logic        [load::PORT_BITS-1:0]                  memory_address,
    output logic signed [microcode::REGISTER_BITS-1:0]         memory_value,
    output logic                                               stepping,
    output logic                                               computing,
    output logic                                               copying
);
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int ADDRESS = microcode::REGISTER_ADDRESS_BITS;
  localparam int FIELD = load::FIELD_BITS;
  localparam int MEMORY = load::MEMORY_BITS;

  // The script.
  logic        [load::OP_BITS-1:0]    op;
  logic        [FIELD-1:0]            a, b, c;
  logic signed [load::VALUE_BITS-1:0] value;
  logic        [load::COUNT_BITS-1:0] index;
  logic        [1:0]                  place;  // memory or port
  logic                               holds, call_done;
  load_sequencer sequence_of_steps (
      .clock(clock), .reset(reset), .start(start), .finish(finish), .busy(busy), .stepping(stepping), .op(op), .a(a),
      .b(b), .c(c), .value(value), .index(index), .holds(holds), .call_done(call_done));
  assign place = value[load::COUNT_BITS+:2];
  assign done = stepping && (op == load::DO_END || op == load::DO_FAIL);

  // Calls.
  logic signed [BITS-1:0]                         b_word;
  logic                                           starts, run, to_field;
  logic [1:0]                                     space;
  logic [load::SOURCE_BITS-1:0]                   from;
  logic [load::TO_BITS-1:0]                       to;
  logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] entry;
  logic signed [BITS-1:0]                         read_register;
  assign starts = stepping && op == load::DO_CALL;
  copier #(
      .CALLS(load::CALLS), .CALL(load::CALL_BITS), .COPIES(load::COPIES), .COPY(load::COPY_BITS),
      .FROM(load::SOURCE_BITS), .TO(load::TO_BITS), .COPY_FILE("load_copies.hex"), .CALL_FILE("load_calls.hex")
  ) caller (
      .clock(clock), .reset(reset), .start(starts), .call(load::CALL_BITS'(value)), .done(call_done),
      .copying(copying), .space(space), .from(from), .to_space(to_field), .to(to), .run(run), .entry(entry),
      .busy(computing));
  datapath #(
      .ACCUMULATOR_BITS(load::ACCUMULATOR_BITS), .REGISTERS(load::REGISTERS), .INSTRUCTIONS(load::INSTRUCTIONS),
      .LINES(load::LINES), .PROGRAM_FILE("load_programs.hex"), .TABLE_FILE("load_tables.hex"),
      .REGISTER_FILE("load_registers.hex")
  ) computer (
      .clock(clock), .reset(reset), .start(run), .entry(entry), .busy(computing),
      .write(busy ? copying && !to_field : register_write),
      .write_address(busy ? ADDRESS'(to) : register_address), .write_value(busy ? b_word : register_value),
      .read_address(ADDRESS'(from)), .read_value(read_register));

  // Fields: two are read, one is written.
  logic signed [BITS-1:0] fields[0:load::FIELDS-1];
  logic signed [BITS-1:0] c_word, part, memory_word, result;
  logic                   has_result;
  assign b_word = fields[copying ? FIELD'(from) : b];
  assign c_word = fields[c];
  always_comb begin
    has_result = stepping;
    case (op)
      load::DO_SET: result = BITS'(value);
      load::DO_ADD_NUMBER: result = b_word + BITS'(value);
      load::DO_ADD: result = b_word + c_word;
      load::DO_COPY: result = b_word;
      load::DO_GET: result = memory_word;
      load::DO_TAKE: result = part;
      default: begin
        result = b_word;
        has_result = 1'b0;
      end
    endcase
  end
  always_ff @(posedge clock)
    if (copying && to_field) fields[FIELD'(to)] <= space == 2'd3 ? read_register : b_word;
    else if (has_result) fields[a] <= result;
  assign holds = op == load::DO_JUMP || op == load::DO_JUMP_IS && b_word == BITS'({1'b0, c}) ||
      op == load::DO_JUMP_EQUAL && b_word == c_word;
  assign made = fields[load::F_MADE] != 0;
  assign ends = fields[load::F_ENDS] != 0;
  assign lines = MEMORY'(fields[load::F_LINES]);
  assign lines_end = load::PORT_BITS'(fields[load::F_LINES_END]);

  // Memories.
  logic        [MEMORY-1:0] memory_at;
  logic signed [BITS-1:0]   voxel_word, edge_word, line_word;
  logic        [2:0]        beyond;
  logic                     puts;
  assign puts = stepping && op == load::DO_PUT;
  assign memory_at = MEMORY'(b_word) + MEMORY'(index) + (op == load::DO_GET ? MEMORY'(c) : '0);
  assign memory_word = place == 2'd0 ? voxel_word : place == 2'd1 ? edge_word : line_word;
  load_memory #(.WORDS(load::VOXELS_WORDS)) voxels (
      .clock(clock), .write(puts && place == 2'd0), .address(memory_at), .value(c_word), .word(voxel_word),
      .beyond(beyond[0]));
  load_memory #(.WORDS(load::EDGES_WORDS)) edges (
      .clock(clock), .write(puts && place == 2'd1), .address(memory_at), .value(c_word), .word(edge_word),
      .beyond(beyond[1]));
  load_memory #(.WORDS(load::TABLE_WORDS)) index_table (
      .clock(clock), .write(puts && place == 2'd2), .address(memory_at), .value(c_word), .word(line_word),
      .beyond(beyond[2]));
  always_ff @(posedge clock)
    if (reset) failed <= 1'b0;
    else if (stepping && op == load::DO_FAIL || puts && |(beyond & (3'b1 << place))) failed <= 1'b1;

  // The message's parts, and the span that goes on.
  logic [MESSAGE_BITS-1:0] packed_message;
  load_parts parts (
      .message(message), .column(column), .part(a), .source(SOURCES_BITS'(fields[load::F_SOURCE])), .word(part));
  load_packer packer (.message(advanced), .part(b), .word(b_word), .packed_message(packed_message));
  always_ff @(posedge clock)
    if (start && !busy) advanced <= message;
    else if (stepping && op == load::DO_SEND) advanced <= packed_message;

  // Ports, each with its next address.
  logic [load::PORT_BITS-1:0] next_address[0:3];
  logic                       writes;
  assign writes = stepping && op == load::DO_WRITE;
  assign store_write = writes && place == 2'd0;
  assign store_address = next_address[0];
  assign store_value = b_word;
  assign memory_write = writes && place != 2'd0;
  assign memory_space = place - 2'd1;
  assign memory_address = next_address[place];
  assign memory_value = b_word;
  always_ff @(posedge clock)
    if (stepping && op == load::DO_REWIND) for (int i = 0; i < 4; ++i) next_address[i] <= '0;
    else if (writes) next_address[place] <= next_address[place] + 1'b1;
endmodule
