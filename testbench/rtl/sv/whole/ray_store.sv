// The ray store: slots of hits that wait, their children, and whose turn it is in the shading unit: complete
// slots first, since that frees them, then those to be set up; of each the hit accepted first.
module ray_store
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
    // A hit.
    input  logic accept,
    input  logic [RAY_BITS-1:0] accept_message,
    input  id_t accept_id,
    input  logic [DISTANCE_BITS-1:0] accept_t,
    input  logic [VOXEL_BITS-1:0] accept_voxel,
    output logic [SLOT_GROUPS-1:0] room_before,
    output logic [SLOT_GROUPS-1:0] room_now,  // those released in this cycle are free
    output slot_index_t accept_slot,
    // Children that are made in this cycle.
    input  logic hold_back,
    input  logic [RAY_STORE-1:0] child_empty,
    input  logic [RAY_STORE-1:0] child_leaves,
    output logic [RAY_STORE-1:0] feed,
    output logic [RAY_STORE-1:0][RAY_BITS-1:0] fed,
    output id_t [RAY_STORE-1:0] fed_id,
    // An answer that is home, of a child.
    input  logic deliver,
    input  logic [INTENSITY_BITS-1:0] answer,
    input  id_t answer_id,
    // Replies.
    output logic [RAY_STORE-1:0] to_answer,
    output time_t [RAY_STORE-1:0] changed,
    output logic [RAY_STORE-1:0][INTENSITY_BITS-1:0] reply,
    output id_t [RAY_STORE-1:0] reply_id,
    input  logic [RAY_STORE-1:0] released,
    // The shading unit.
    input  logic [6:0] lights,  // how many sources there are
    input  logic memory_write,
    input  logic [2:0] memory_space,
    input  logic [shade::MEMORY_BITS-1:0] memory_address,
    input  logic signed [microcode::REGISTER_BITS-1:0] memory_word,
    output logic shading_busy,
    output logic shading_starts,
    output logic starts_shade,  // else a set-up
    output slot_index_t starts_slot,
    output slot_index_t job_slot,
    output logic shading_ends,  // in its last cycle
    output logic late,
    output logic idle,
    output logic quiet  // nothing happens before an answer comes, or a child leaves
);
  // Whose answer it is.
  intensity_t intensity;
  verdict_t verdict;
  slot_index_t answers_slot;
  logic [5:0] answers_child;
  logic is_intensity;
  always_comb begin
    intensity = intensity_t'(answer);
    verdict = verdict_t'(answer[INTENSITY_BITS-1-:VERDICT_BITS]);
    is_intensity = intensity.message_type == TYPE_INTENSITY;
    answers_slot = is_intensity ? intensity.slot[SLOT_INDEX_BITS-1:0] : verdict.slot[SLOT_INDEX_BITS-1:0];
    answers_child = is_intensity ? intensity.child : verdict.child;
  end
  logic unused;
  assign unused = &{1'b0, intensity, verdict, answers_child[5:1], wait_cycles[63:TIME_BITS], first_start};

  logic [RAY_STORE-1:0] empty, complete, fresh, slot_quiet;
  logic [RAY_STORE-1:0][5:0] generation;
  logic [RAY_STORE-1:0][1:0][7:0] attempts;
  logic [RAY_STORE-1:0][RAY_BITS-1:0] message;
  logic [RAY_STORE-1:0][DISTANCE_BITS-1:0] t;
  logic [RAY_STORE-1:0][VOXEL_BITS-1:0] voxel;
  logic [RAY_STORE-1:0][LIGHTS-1:0] lit;
  colour_t [RAY_STORE-1:0][1:0] colour;
  time_t [RAY_STORE-1:0] since;
  logic ends_set_up, ends_shading;
  set_up_t found;
  colour_t result;
  child_index_t [RAY_STORE-1:0] fed_number;
  child_t [RAY_STORE-1:0] child;
  logic [63:0] wait_cycles, first_start;
  back_off draw (
      .ray(answer_id),
      .attempt(attempts[answers_slot][answers_child[0]]),
      .cycles(wait_cycles),
      .first_start
  );

  for (genvar i = 0; i < RAY_STORE; i++) begin : g_slot
    slot store (
        .clock,
        .reset,
        .now,
        .accept(accept && int'(accept_slot) == i),
        .accept_message,
        .accept_id,
        .accept_t,
        .accept_voxel,
        .message(message[i]),
        .id(reply_id[i]),
        .t(t[i]),
        .voxel(voxel[i]),
        .hold_back,
        .child_empty(child_empty[i]),
        .child_leaves(child_leaves[i]),
        .feed(feed[i]),
        .feed_number(fed_number[i]),
        .deliver(deliver && int'(answers_slot) == i),
        .answer,
        .wait_cycles(wait_cycles[TIME_BITS-1:0]),
        .attempts(attempts[i]),
        .lit(lit[i]),
        .colour(colour[i]),
        .complete(complete[i]),
        .fresh(fresh[i]),
        .since(since[i]),
        .begins(shading_starts && int'(starts_slot) == i),
        .ends_set_up(ends_set_up && int'(job_slot) == i),
        .ends_shading(ends_shading && int'(job_slot) == i),
        .found,
        .result,
        .to_answer(to_answer[i]),
        .changed(changed[i]),
        .reply(reply[i]),
        .released(released[i]),
        .empty(empty[i]),
        .quiet(slot_quiet[i])
    );
    child_ray child_message (
        .x,
        .y,
        .slot(slot_index_t'(i)),
        .number(fed_number[i]),
        .child(child[i]),
        .parent(message[i]),
        .parent_id(reply_id[i]),
        .message(fed[i]),
        .id(fed_id[i])
    );
    assign generation[i] = ray_generation(message[i]);
  end

  shade_job shading (
      .clock,
      .fast_clock,
      .reset,
      .now,
      .x,
      .y,
      .lights,
      .start(shading_starts),
      .start_shade(starts_shade),
      .start_slot(starts_slot),
      .message(message[job_slot]),
      .t(t[job_slot]),
      .voxel(voxel[job_slot]),
      .lit(lit[job_slot]),
      .colour(colour[job_slot]),
      .busy(shading_busy),
      .slot(job_slot),
      .ends_set_up,
      .ends_shading,
      .found,
      .result,
      .late,
      .child_number(fed_number),
      .child,
      .memory_write,
      .memory_space,
      .memory_address,
      .memory_word
  );
  assign shading_ends = ends_set_up || ends_shading;

  slot_room places (
      .clock,
      .reset,
      .released,
      .generation,
      .empty,
      .accept,
      .room_before,
      .room_now,
      .next(accept_slot)
  );

  // The oldest of those that can be shaded, else of those to be set up.
  always_comb begin
    time_t best;
    logic [RAY_STORE-1:0] can;
    time_t [RAY_STORE-1:0] begun;
    for (int i = 0; i < RAY_STORE; i++) begun[i] = accept && int'(accept_slot) == i ? now : since[i];
    starts_shade = complete != '0;
    can = starts_shade ? complete : fresh;
    shading_starts = 1'b0;
    starts_slot = '0;
    best = '0;
    if (!shading_busy)
      for (int i = 0; i < RAY_STORE; i++) begin
        if (can[i] && (!shading_starts || (fault == FAULT_YOUNGEST ? begun[i] > best : begun[i] < best))) begin
          shading_starts = 1'b1;
          starts_slot = slot_index_t'(i);
          best = begun[i];
        end
      end
    idle = &empty;
    quiet = &slot_quiet;
  end
endmodule
