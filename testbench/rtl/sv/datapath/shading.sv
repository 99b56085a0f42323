// A shading unit: sets up a hit and makes its children (job 0), computes a hit's intensity when its answers are in
// (1), or both for a hit that waits for nothing and has no children (2). All numbers are computed by microprograms,
// in the order of a script. Inputs are held while `busy`; outputs hold until the next start.
module shading #(
    parameter int BITS = microcode::REGISTER_BITS,
    parameter int ADDRESS = microcode::REGISTER_ADDRESS_BITS
) (
    input  logic                                clock,
    input  logic                                reset,
    // Written while it is idle: voxels by their numbers, objects, sources; constants of the microprograms, once; the
    // words of a ray that hit (shade::F_X and so on).
    input  logic                                memory_write,
    input  logic        [2:0]                   memory_space,
    input  logic        [shade::MEMORY_BITS-1:0] memory_address,
    input  logic signed [BITS-1:0]              memory_value,
    input  logic                                field_write,
    input  logic        [ADDRESS-1:0]           field_address,
    input  logic signed [BITS-1:0]              field_value,
    input  logic        [shade::LIGHT_BITS-1:0] lights,  // how many sources there are
    input  logic        [shade::CELL_BITS-1:0]  cell_x,
    input  logic        [shade::CELL_BITS-1:0]  cell_y,
    // A job.
    input  logic                                start,
    input  logic        [1:0]                   job,
    input  logic        [shade::SLOT_BITS-1:0]  slot,
    input  logic        [shade::VOXEL_BITS-1:0] voxel,
    input  logic        [shade::SOURCES_MOST-1:0] lit,
    input  logic signed [BITS-1:0]              reflected_red,
    input  logic signed [BITS-1:0]              reflected_green,
    input  logic signed [BITS-1:0]              reflected_blue,
    input  logic signed [BITS-1:0]              refracted_red,
    input  logic signed [BITS-1:0]              refracted_green,
    input  logic signed [BITS-1:0]              refracted_blue,
    output logic                                busy,
    // A child: light k, the reflected (SOURCES_MOST) or the refracted ray (SOURCES_MOST + 1).
    output logic                                child_valid,
    output logic        [shade::CHILD_BITS-1:0] child_number,
    output logic signed [BITS-1:0]              child_x,
    output logic signed [BITS-1:0]              child_y,
    output logic signed [BITS-1:0]              child_z,
    output logic signed [BITS-1:0]              child_dx,
    output logic signed [BITS-1:0]              child_dy,
    output logic signed [BITS-1:0]              child_dz,
    output logic signed [BITS-1:0]              child_mx,
    output logic signed [BITS-1:0]              child_ex,
    output logic signed [BITS-1:0]              child_my,
    output logic signed [BITS-1:0]              child_ey,
    output logic signed [BITS-1:0]              child_weight,  // of reflected and refracted rays
    output logic signed [BITS-1:0]              child_reach,   // of shadow rays
    output logic signed [BITS-1:0]              child_front,
    // When it is done.
    output logic        [shade::SOURCES_MOST-1:0] facing,
    output logic signed [BITS-1:0]              reflects,
    output logic signed [BITS-1:0]              refracts,
    output logic signed [BITS-1:0]              polygon,
    output logic signed [BITS-1:0]              object,
    output logic signed [BITS-1:0]              red,
    output logic signed [BITS-1:0]              green,
    output logic signed [BITS-1:0]              blue,
    output logic        [shade::CHARGE_BITS-1:0] charge,  // what the cost table says of the job
    output logic                                computing,
    output logic                                copying
);
  localparam int NUMBER = shade::NUMBER_BITS;
  localparam int OUT = $clog2(shade::OUTS);
  localparam int KEEP = $clog2(shade::SLOT_WORDS);
  localparam logic [1:0] SHADE = 2'd1, DIRECT = 2'd2;

  logic signed [BITS-1:0] outs[0:shade::OUTS-1];
  logic signed [BITS-1:0] copied, read_register, read_memory, port;
  logic [NUMBER-1:0]      from, to;
  logic [2:0]             space;
  logic [1:0]             to_space;
  logic                   call_start, call_done, run, emits;
  logic [shade::CALL_BITS-1:0]  call;
  logic [shade::LIGHT_BITS-1:0] light;
  logic [OUT-1:0]               asked;
  logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] entry;

  shading_script order (
      .clock(clock), .reset(reset), .start(start), .shades(job == SHADE), .goes_on(job == DIRECT), .lights(lights),
      .lit(job == SHADE ? lit : '0), .busy(busy), .call_start(call_start), .call(call), .call_done(call_done),
      .light(light), .asked(asked), .answer(outs[asked]), .emits(emits), .child(child_number), .facing(facing),
      .charge(charge));

  copier #(
      .COPIES(shade::COPIES), .COPY(shade::COPY_BITS), .CALLS(shade::CALLS), .CALL(shade::CALL_BITS), .SPACE(3),
      .FROM(NUMBER), .TO_SPACE(2), .TO(NUMBER), .COPY_FILE("shading_copies.hex"), .CALL_FILE("shading_calls.hex")
  ) caller (
      .clock(clock), .reset(reset), .start(call_start), .call(call), .done(call_done), .copying(copying),
      .space(space), .from(from), .to_space(to_space), .to(to), .run(run), .entry(entry), .busy(computing));

  shading_memory memory (
      .clock(clock), .write(memory_write), .write_space(memory_space), .write_address(memory_address),
      .write_value(memory_value), .slot(slot), .voxel(voxel),
      .object(shade::OBJECT_BITS'(outs[shade::OUT_OBJECT])), .light(light), .space(space), .from(from),
      .value(read_memory), .keep(copying && to_space == 2'd1), .keep_number(KEEP'(to)), .keep_value(copied));

  datapath #(
      .ACCUMULATOR_BITS(shade::ACCUMULATOR_BITS), .REGISTERS(shade::REGISTERS), .INSTRUCTIONS(shade::INSTRUCTIONS),
      .LINES(shade::LINES), .PROGRAM_FILE("shading_programs.hex"), .TABLE_FILE("shading_tables.hex"),
      .REGISTER_FILE("shading_registers.hex")
  ) computer (
      .clock(clock), .reset(reset), .start(run), .entry(entry), .busy(computing),
      .write(busy ? copying && to_space == 2'd0 : field_write),
      .write_address(busy ? ADDRESS'(to) : field_address), .write_value(busy ? copied : field_value),
      .read_address(ADDRESS'(from)), .read_value(read_register));

  // Children of a hit that waits for nothing answer black.
  always_comb begin
    port = '0;
    case (from)
      NUMBER'(shade::PORT_X): port = BITS'({1'b0, cell_x});
      NUMBER'(shade::PORT_Y): port = BITS'({1'b0, cell_y});
      NUMBER'(shade::PORT_REFLECTED_X): if (job == SHADE) port = reflected_red;
      NUMBER'(shade::PORT_REFLECTED_Y): if (job == SHADE) port = reflected_green;
      NUMBER'(shade::PORT_REFLECTED_Z): if (job == SHADE) port = reflected_blue;
      NUMBER'(shade::PORT_REFRACTED_X): if (job == SHADE) port = refracted_red;
      NUMBER'(shade::PORT_REFRACTED_Y): if (job == SHADE) port = refracted_green;
      default: if (job == SHADE) port = refracted_blue;
    endcase
  end
  assign copied = space == 3'(shade::SPACE_OWN) ? read_register : space == 3'(shade::SPACE_PORT) ? port : read_memory;

  always_ff @(posedge clock) if (copying && to_space == 2'd2) outs[OUT'(to)] <= copied;

  assign child_valid = emits && job != DIRECT;
  assign child_x = outs[shade::OUT_X];
  assign child_y = outs[shade::OUT_Y];
  assign child_z = outs[shade::OUT_Z];
  assign child_dx = outs[shade::OUT_DX];
  assign child_dy = outs[shade::OUT_DY];
  assign child_dz = outs[shade::OUT_DZ];
  assign child_mx = outs[shade::OUT_MX];
  assign child_ex = outs[shade::OUT_EX];
  assign child_my = outs[shade::OUT_MY];
  assign child_ey = outs[shade::OUT_EY];
  assign child_weight = outs[shade::OUT_WEIGHT];
  assign child_reach = outs[shade::OUT_REACH];
  assign child_front = outs[shade::OUT_FRONT];
  assign reflects = outs[shade::OUT_REFLECTS];
  assign refracts = outs[shade::OUT_REFRACTS];
  assign polygon = outs[shade::OUT_POLYGON];
  assign object = outs[shade::OUT_OBJECT];
  assign red = outs[shade::OUT_RED];
  assign green = outs[shade::OUT_GREEN];
  assign blue = outs[shade::OUT_BLUE];
endmodule
