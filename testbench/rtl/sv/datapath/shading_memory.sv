// What the shading unit reads: the cell's voxels, the objects' features, the sources; and its slots, where a hit's
// words are kept from its set-up to its shading. A word is `from` behind the beginning of the thing that is meant.
module shading_memory #(
    parameter int BITS = microcode::REGISTER_BITS,
    parameter int NUMBER = shade::NUMBER_BITS,
    parameter int ADDRESS = shade::MEMORY_BITS,
    parameter int SLOT = shade::SLOT_BITS,
    parameter int VOXEL = shade::VOXEL_BITS,
    parameter int OBJECT = shade::OBJECT_BITS,
    parameter int LIGHT = shade::LIGHT_BITS,
    parameter int KEEP = $clog2(shade::SLOT_WORDS)
) (
    input  logic                      clock,
    // From outside: voxels, objects, sources. The largest of them needs all bits of the address.
    input  logic                      write,
    input  logic        [2:0]         write_space,
    input  logic        [ADDRESS-1:0] write_address,
    input  logic signed [BITS-1:0]    write_value,
    input  logic        [SLOT-1:0]    slot,
    input  logic        [VOXEL-1:0]   voxel,
    input  logic        [OBJECT-1:0]  object,
    input  logic        [LIGHT-1:0]   light,
    input  logic        [2:0]         space,
    // verilator lint_off UNUSEDSIGNAL
    input  logic        [NUMBER-1:0]  from,  // as wide as a register's number
    // verilator lint_on UNUSEDSIGNAL
    output logic signed [BITS-1:0]    value,
    input  logic                      keep,   // writes a slot's word
    input  logic        [KEEP-1:0]    keep_number,
    input  logic signed [BITS-1:0]    keep_value
);
  localparam int VOXEL_WORDS = shade::VOXELS_MOST * shade::VOXEL_WORDS;
  localparam int OBJECT_WORDS = shade::OBJECTS_MOST * shade::OBJECT_WORDS;
  localparam int SOURCE_WORDS = shade::SOURCES_MOST * shade::SOURCE_WORDS;
  localparam int SLOT_WORDS = shade::SLOTS * shade::SLOT_WORDS;
  localparam int VOXEL_PLACE = $clog2(VOXEL_WORDS);
  localparam int OBJECT_PLACE = $clog2(OBJECT_WORDS);
  localparam int SOURCE_PLACE = $clog2(SOURCE_WORDS);
  localparam int SLOT_PLACE = $clog2(SLOT_WORDS);

  logic signed [BITS-1:0] voxels [0:VOXEL_WORDS-1];
  logic signed [BITS-1:0] objects[0:OBJECT_WORDS-1];
  logic signed [BITS-1:0] sources[0:SOURCE_WORDS-1];
  logic signed [BITS-1:0] slots  [0:SLOT_WORDS-1];
  logic [VOXEL_PLACE-1:0]  voxel_place;
  logic [OBJECT_PLACE-1:0] object_place;
  logic [SOURCE_PLACE-1:0] source_place;
  logic [SLOT_PLACE-1:0]   slot_first, slot_place;

  assign voxel_place = VOXEL_PLACE'(voxel) * VOXEL_PLACE'(shade::VOXEL_WORDS) + VOXEL_PLACE'(from);
  assign object_place = OBJECT_PLACE'(object) * OBJECT_PLACE'(shade::OBJECT_WORDS) + OBJECT_PLACE'(from);
  assign source_place = SOURCE_PLACE'(light) * SOURCE_PLACE'(shade::SOURCE_WORDS) + SOURCE_PLACE'(from);
  assign slot_first = SLOT_PLACE'(slot) * SLOT_PLACE'(shade::SLOT_WORDS);
  assign slot_place = slot_first + SLOT_PLACE'(from);

  always_comb
    case (space)
      3'(shade::SPACE_VOXEL): value = voxels[voxel_place];
      3'(shade::SPACE_OBJECT): value = objects[object_place];
      3'(shade::SPACE_SOURCE): value = sources[source_place];
      default: value = slots[slot_place];
    endcase

  always_ff @(posedge clock) begin
    if (write && write_space == 3'(shade::SPACE_VOXEL)) voxels[VOXEL_PLACE'(write_address)] <= write_value;
    if (write && write_space == 3'(shade::SPACE_OBJECT)) objects[OBJECT_PLACE'(write_address)] <= write_value;
    if (write && write_space == 3'(shade::SPACE_SOURCE)) sources[SOURCE_PLACE'(write_address)] <= write_value;
    if (keep) slots[slot_first+SLOT_PLACE'(keep_number)] <= keep_value;
  end
endmodule
