// Jobs of the shading unit: the hit's words go into the unit that runs the microprograms, on a clock of its
// own; its children are kept until they are sent, and the job lasts for the cycles of the cost table.
module shade_job
  import raycell_pkg::*;
  import raycell_cell::*;
  import raycell_whole::*;
(
    input  logic clock,
    input  logic fast_clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  logic [6:0] lights,  // how many sources there are
    input  logic start,
    input  logic start_shade,  // else a set-up
    input  slot_index_t start_slot,
    // Of the slot whose job it is.
    input  logic [RAY_BITS-1:0] message,
    input  logic [DISTANCE_BITS-1:0] t,
    input  logic [VOXEL_BITS-1:0] voxel,
    input  logic [LIGHTS-1:0] lit,
    input  colour_t [1:0] colour,
    output logic busy,
    output slot_index_t slot,
    output logic ends_set_up,  // in its last cycle
    output logic ends_shading,
    output set_up_t found,
    output colour_t result,
    output logic late,  // the microprograms took longer than the cost table says
    // The children that were made for each slot.
    input  child_index_t [RAY_STORE-1:0] child_number,
    output child_t [RAY_STORE-1:0] child,
    // Memories of the unit.
    input  logic memory_write,
    input  logic [2:0] memory_space,
    input  logic [shade::MEMORY_BITS-1:0] memory_address,
    input  logic signed [microcode::REGISTER_BITS-1:0] memory_word
);
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int ADDRESS = microcode::REGISTER_ADDRESS_BITS;
  localparam logic [2:0] WAIT = 0, WRITE = 1, GO = 2, RUN = 3, OVER = 4;
  localparam int RAY_WORDS = 9;

  typedef logic signed [BITS-1:0] word_t;
  function automatic word_t signed_word(input logic [WORD-1:0] word);
    signed_word = word_t'($signed(word));
  endfunction

  logic shades, in_job;
  time_t began;
  logic [2:0] step;
  logic [3:0] count;
  ray_t ray;
  assign ray = ray_t'(message);

  logic [ADDRESS-1:0] field_address;
  word_t field_value;
  always_comb begin
    unique case (int'(count))
      0: {field_address, field_value} = {ADDRESS'(shade::F_X), signed_word(ray.x)};
      1: {field_address, field_value} = {ADDRESS'(shade::F_Y), signed_word(ray.y)};
      2: {field_address, field_value} = {ADDRESS'(shade::F_Z), word_t'($signed(ray.z))};
      3: {field_address, field_value} = {ADDRESS'(shade::F_DX), signed_word(ray.dx)};
      4: {field_address, field_value} = {ADDRESS'(shade::F_DY), signed_word(ray.dy)};
      5: {field_address, field_value} = {ADDRESS'(shade::F_DZ), signed_word(ray.dz)};
      6: {field_address, field_value} = {ADDRESS'(shade::F_WEIGHT), signed_word(ray.weight)};
      7: {field_address, field_value} = {ADDRESS'(shade::F_GENERATION), word_t'({1'b0, ray.generation})};
      default: {field_address, field_value} = {ADDRESS'(shade::F_T), word_t'($signed(t))};
    endcase
  end

  logic unit_busy, child_valid, computing, copying;
  logic [shade::CHILD_BITS-1:0] made_number;
  logic [shade::SOURCES_MOST-1:0] facing;
  logic [shade::CHARGE_BITS-1:0] charge;
  word_t made_x, made_y, made_z, made_dx, made_dy, made_dz, made_mx, made_ex, made_my, made_ey, made_weight, made_reach,
      made_front, reflects, refracts, polygon, object, red, green, blue;
  shading unit (
      .clock(fast_clock),
      .reset,
      .memory_write,
      .memory_space,
      .memory_address,
      .memory_value(memory_word),
      .field_write(step == WRITE),
      .field_address,
      .field_value,
      .lights(shade::LIGHT_BITS'(lights)),
      .cell_x(shade::CELL_BITS'(x)),
      .cell_y(shade::CELL_BITS'(y)),
      .start(step == GO),
      .job({1'b0, shades}),
      .slot(shade::SLOT_BITS'(slot)),
      .voxel(shade::VOXEL_BITS'(voxel)),
      .lit(shade::SOURCES_MOST'(lit)),
      .reflected_red(signed_word(colour[0].red)),
      .reflected_green(signed_word(colour[0].green)),
      .reflected_blue(signed_word(colour[0].blue)),
      .refracted_red(signed_word(colour[1].red)),
      .refracted_green(signed_word(colour[1].green)),
      .refracted_blue(signed_word(colour[1].blue)),
      .busy(unit_busy),
      .child_valid,
      .child_number(made_number),
      .child_x(made_x),
      .child_y(made_y),
      .child_z(made_z),
      .child_dx(made_dx),
      .child_dy(made_dy),
      .child_dz(made_dz),
      .child_mx(made_mx),
      .child_ex(made_ex),
      .child_my(made_my),
      .child_ey(made_ey),
      .child_weight(made_weight),
      .child_reach(made_reach),
      .child_front(made_front),
      .facing,
      .reflects,
      .refracts,
      .polygon,
      .object,
      .red,
      .green,
      .blue,
      .charge,
      .computing,
      .copying
  );
  logic unused;
  assign unused = &{1'b0, made_x, made_y, made_z, made_dx, made_dy, made_dz, made_mx, made_ex, made_my, made_ey, made_weight,
                    made_reach, made_front, polygon, object, red, green, blue, computing, copying, ray, lights, voxel};

  // Children wait in their slot's memory until it is their turn.
  child_t made;
  logic of_light;
  always_comb begin
    of_light = int'(made_number) < shade::SOURCES_MOST;
    made.x = made_x[WORD-1:0];
    made.y = made_y[WORD-1:0];
    made.z = made_z[DEPTH_BITS-1:0];
    made.dx = made_dx[WORD-1:0];
    made.dy = made_dy[WORD-1:0];
    made.dz = made_dz[WORD-1:0];
    made.mx = made_mx[WORD-1:0];
    made.ex = made_ex[EXPONENT_BITS-1:0];
    made.my = made_my[WORD-1:0];
    made.ey = made_ey[EXPONENT_BITS-1:0];
    made.share = of_light ? made_reach[WORD-1:0] : made_weight[WORD-1:0];
    made.polygon = polygon[19:0];
  end
  for (genvar i = 0; i < RAY_STORE; i++) begin : g_children
    child_t children[0:CHILDREN-1];
    assign child[i] = children[child_number[i]];
    always_ff @(posedge fast_clock)
      if (child_valid && int'(slot) == i)
        children[of_light ? child_index_t'(made_number) : child_index_t'(LIGHTS + int'(made_number) - shade::SOURCES_MOST)] <= made;
  end

  always_ff @(posedge fast_clock) begin
    if (reset) begin
      step <= WAIT;
      count <= '0;
    end else begin
      unique case (step)
        WAIT: begin
          count <= '0;
          if (in_job) step <= shades ? GO : WRITE;
        end
        WRITE: begin
          count <= count + 1'b1;
          if (int'(count) == RAY_WORDS - 1) step <= GO;
        end
        GO: step <= RUN;
        RUN: if (!unit_busy) step <= OVER;
        default: if (!in_job) step <= WAIT;
      endcase
    end
  end

  time_t last;
  logic ends;
  always_comb begin
    last = began + TIME_BITS'(charge) - 1'b1;
    ends = busy && step == OVER && now >= last;
    ends_set_up = ends && !shades;
    ends_shading = ends && shades;
    late = ends && now != last;
    found.facing = LIGHTS'(facing);
    found.reflects = reflects != 0;
    found.refracts = refracts != 0;
    result = '{red: red[WORD-1:0], green: green[WORD-1:0], blue: blue[WORD-1:0]};
  end

  always_ff @(posedge clock) begin
    if (reset) begin
      busy <= 1'b0;
      in_job <= 1'b0;
      shades <= 1'b0;
      began <= '0;
      slot <= '0;
    end else if (start) begin
      busy <= 1'b1;
      in_job <= 1'b1;
      shades <= start_shade;
      began <= now;
      slot <= start_slot;
    end else if (ends) begin
      busy <= 1'b0;
      in_job <= 1'b0;
    end
  end
endmodule
