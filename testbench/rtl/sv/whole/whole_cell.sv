// A cell with voxels, while rays are traced: tests them by the microprograms, keeps hits in the ray store, sends
// their children, shades, answers. Its loading is another unit's. `fast_clock` has several edges to one of
// `clock`, which are for the microprograms alone.
module whole_cell
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
    input  logic [1:0] phase,
    input  logic phase_begins,  // in its first cycle
    input  logic draining,  // no new rays
    input  logic preset,  // for records that begin behind the viewer's message: it, at reset
    input  logic [SETUP_BITS-1:0] preset_viewer,
    input  logic [SIDES:0] in_valid,  // by side, then the load link
    input  logic [SIDES:0][CLASS_BITS-1:0] in_class,
    input  logic [SIDES:0][15:0] in_cycles,
    input  logic [SIDES:0][MESSAGE_BITS-1:0] in_message,
    input  id_t [SIDES:0] in_id,  // beside the wires
    output logic [SIDES:0][CLASSES-1:0] take,  // the oldest message leaves the buffer
    output logic [SIDES-1:0] out_valid,
    output logic [SIDES-1:0][CLASS_BITS-1:0] out_class,
    output logic [SIDES-1:0][15:0] out_cycles,
    output logic [SIDES-1:0][MESSAGE_BITS-1:0] out_message,
    output id_t [SIDES-1:0] out_id,
    input  logic [SIDES-1:0][CLASSES-1:0] free,  // a place at the far end
    output logic pixel_valid,
    output logic [3*WORD-1:0] pixel,
    output logic failed,  // more voxels than its memories hold
    output logic loaded,  // its last voxel is in order
    output logic computes,  // fast_clock is needed
    output logic late,  // the microprograms took longer than the cost table says
    output logic idle,  // nothing happens before something comes
    // What happens inside, for coverage.
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0] asks,
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0] goes,
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0] stalls_full,
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0] stalls_wires,
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0] overdue,
    output logic [ALL_PLACES-1:0] untested,
    output logic [SIDES+RAY_STORE+ALL_PLACES-1:0][2:0] goal,  // side, or 4: home
    output time_t [SIDES+RAY_STORE+ALL_PLACES-1:0] asks_since,
    output logic [ALL_PLACES-1:0] ends,  // a ray, with an answer
    output logic silent,  // a ray ended without one
    output logic again,  // a ray has left the cube and is to be tested again
    output logic postponed,  // the own ray, says a notice
    output logic [ALL_PLACES-1:0] hits,  // rays that have hit
    output logic takes_slot,
    output logic slots_full,
    output logic child_postponed,
    output logic replies_lead,  // they go before answers, and both ask
    output logic [RAY_STORE-1:0] feeds,  // children that are made
    // And for the books of an array.
    output logic still,  // nothing happens before something comes or a place at a far end is freed
    output logic feed,  // the own ray comes into its register
    output logic replies_first,  // they go before answers
    output logic [ALL_PLACES-1:0] ends_silently,  // a ray, without an answer
    output logic [TRAVERSAL_UNITS-1:0] test_starts,
    output logic [TRAVERSAL_UNITS-1:0][ALL_INDEX_BITS-1:0] test_place,
    output slot_index_t takes,  // the slot that a hit takes
    output logic [ALL_INDEX_BITS-1:0] takes_place,  // where the hit stands
    output logic shading_starts,
    output logic starts_shade,  // else a set-up
    output slot_index_t starts_slot,
    output logic shading_ends,  // in its last cycle
    output slot_index_t job_slot
);
  localparam int RAYS = SIDES + RAY_STORE;  // the first ray among the requesters: answers by side, replies, rays by place
  localparam int REQUESTERS = RAYS + ALL_PLACES;
  localparam int FIRST_CHILD = raycell_cell::PLACES;
  localparam int PORT = SIDES;  // of the ray store, beside the outputs

  logic loading, tracing;
  assign loading = phase == PHASE_LOAD;
  assign tracing = !loading;

  logic [SIDES:0] arrives;
  logic links_idle;
  logic [SIDES:0][CLASS_BITS-1:0] arrives_class;
  logic [SIDES:0][15:0] arrives_cycles;
  logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message;
  id_t [SIDES:0] arrives_id;
  logic [SIDES-1:0][CLASSES-1:0] room, full;
  logic [SIDES-1:0] wires_busy;
  cell_links links (
      .clock,
      .reset,
      .now,
      .in_valid,
      .in_class,
      .in_cycles,
      .in_message,
      .in_id,
      .arrives,
      .arrives_class,
      .arrives_cycles,
      .arrives_message,
      .arrives_id,
      .idle(links_idle),
      .out_valid,
      .out_class,
      .out_cycles,
      .free,
      .room,
      .full,
      .wires_busy
  );

  // Loading: from the distributor in the first column, else from the west.
  logic load_take, load_send, load_is_setup, load_idle, first_column;
  logic [15:0] load_cycles;
  logic [MESSAGE_BITS-1:0] load_message;
  assign first_column = x == '0;
  logic load_computes, store_write, memory_write;
  logic [load::PORT_BITS-1:0] store_address, lines_end, memory_address;
  logic signed [microcode::REGISTER_BITS-1:0] store_value, memory_value;
  logic [1:0] memory_space;  // voxels, objects, sources
  span_unit loader (
      .clock,
      .fast_clock,
      .reset,
      .now,
      .enable(loading),
      .x,
      .arrives(loading && (first_column ? arrives[LOAD_LINK] : arrives[WEST])),
      .arrives_cycles(first_column ? arrives_cycles[LOAD_LINK] : arrives_cycles[WEST]),
      .arrives_message(first_column ? arrives_message[LOAD_LINK] : arrives_message[WEST]),
      .room(room[EAST][0]),
      .take(load_take),
      .send(load_send),
      .send_cycles(load_cycles),
      .message(load_message),
      .viewer(load_viewer),
      .is_setup(load_is_setup),
      .loaded,
      .idle(load_idle),
      .computes(load_computes),
      .failed,
      .store_write,
      .store_address,
      .store_value,
      .lines_end,
      .memory_write,
      .memory_space,
      .memory_address,
      .memory_value
  );

  logic latch;
  setup_t viewer, load_viewer;
  known_t known;
  assign latch  = preset || (load_is_setup && load_take);
  assign viewer = preset ? setup_t'(preset_viewer) : load_viewer;
  viewer_latch latched (
      .clock,
      .reset,
      .latch,
      .viewer,
      .known
  );

  logic primary_ready, making;
  logic [RAY_BITS-1:0] primary;
  primary_ray maker (
      .clock,
      .reset,
      .start(latch),
      .viewer,
      .x,
      .y,
      .ready(primary_ready),
      .making,
      .message(primary)
  );

  // Places of rays, and who is tested.
  logic [ALL_PLACES-1:0] leaves, decided, place_empty, started, test_ends;
  logic [ALL_PLACES-1:0][RAY_BITS-1:0] to_test, message;
  id_t [ALL_PLACES-1:0] id;
  time_t [ALL_PLACES-1:0] since;
  decision_t [ALL_PLACES-1:0] decision, found;
  logic [TRAVERSAL_UNITS-1:0] unit_busy, unit_start, unit_done, unit_late;
  logic [TRAVERSAL_UNITS-1:0][ALL_INDEX_BITS-1:0] unit_takes, unit_place;
  decision_t [TRAVERSAL_UNITS-1:0] unit_found;

  logic [RAY_STORE-1:0] child_fed;
  logic [RAY_STORE-1:0][RAY_BITS-1:0] fed;
  id_t [RAY_STORE-1:0] fed_id;
  input_places inputs (
      .clock,
      .reset,
      .now,
      .tracing,
      .arrives,
      .arrives_class,
      .arrives_message,
      .arrives_id,
      .leaves(leaves[OWN-1:0]),
      .test_starts(started[OWN-1:0]),
      .test_ends(test_ends[OWN-1:0]),
      .found(found[OWN-1:0]),
      .untested(untested[OWN-1:0]),
      .to_test(to_test[OWN-1:0]),
      .decided(decided[OWN-1:0]),
      .since(since[OWN-1:0]),
      .decision(decision[OWN-1:0]),
      .message(message[OWN-1:0]),
      .id(id[OWN-1:0]),
      .empty(place_empty[OWN-1:0])
  );

  // The own ray's register: a ray can be tested in the cycle in which it comes there.
  logic own_untested, delivered, pixel_idle;
  logic [RAY_BITS-1:0] own_to_test;
  logic [INTENSITY_BITS-1:0] delivered_answer;
  own_pixel own (
      .clock,
      .reset,
      .now,
      .x,
      .y,
      .begins(phase_begins && phase == PHASE_TRACE),
      .other_phase(phase_begins && phase != PHASE_TRACE),
      .hold_back(draining || !primary_ready || phase != PHASE_TRACE),
      .register_free(place_empty[OWN]),
      .delivered,
      .answer(delivered_answer),
      .send(feed),
      .pixel_valid,
      .pixel,
      .idle(pixel_idle)
  );
  ray_place #(
      .DEPTH(1)
  ) own_place (
      .clock,
      .reset,
      .now,
      .arrives(feed),
      .arrives_message(primary),
      .arrives_id({32'(y) * 32'(COLUMNS) + 32'(x), 32'd0}),
      .leaves(leaves[OWN]),
      .test_starts(started[OWN]),
      .test_ends(test_ends[OWN]),
      .found(found[OWN]),
      .untested(own_untested),
      .to_test(own_to_test),
      .decided(decided[OWN]),
      .since(since[OWN]),
      .decision(decision[OWN]),
      .message(message[OWN]),
      .id(id[OWN]),
      .empty(place_empty[OWN])
  );
  assign untested[OWN] = feed || own_untested;
  assign to_test[OWN]  = feed ? primary : own_to_test;

  // The slots' child registers, too.
  child_places children (
      .clock,
      .reset,
      .now,
      .feed(child_fed),
      .fed,
      .fed_id,
      .leaves(leaves[ALL_PLACES-1:FIRST_CHILD]),
      .test_starts(started[ALL_PLACES-1:FIRST_CHILD]),
      .test_ends(test_ends[ALL_PLACES-1:FIRST_CHILD]),
      .found(found[ALL_PLACES-1:FIRST_CHILD]),
      .untested(untested[ALL_PLACES-1:FIRST_CHILD]),
      .to_test(to_test[ALL_PLACES-1:FIRST_CHILD]),
      .decided(decided[ALL_PLACES-1:FIRST_CHILD]),
      .since(since[ALL_PLACES-1:FIRST_CHILD]),
      .decision(decision[ALL_PLACES-1:FIRST_CHILD]),
      .message(message[ALL_PLACES-1:FIRST_CHILD]),
      .id(id[ALL_PLACES-1:FIRST_CHILD]),
      .empty(place_empty[ALL_PLACES-1:FIRST_CHILD])
  );

  test_turn #(
      .PLACE_COUNT(ALL_PLACES)
  ) turn (
      .clock,
      .reset,
      .enable(tracing),
      .untested,
      .busy(unit_busy),
      .start(unit_start),
      .place(unit_takes),
      .started
  );
  for (genvar u = 0; u < TRAVERSAL_UNITS; u++) begin : g_unit
    visit_unit traversal (
        .clock,
        .fast_clock,
        .reset,
        .now,
        .x,
        .y,
        .known,
        .start(unit_start[u]),
        .start_place(unit_takes[u]),
        .start_message(to_test[unit_takes[u]]),
        .start_fresh(int'(unit_takes[u]) >= OWN),
        .busy(unit_busy[u]),
        .done(unit_done[u]),
        .place(unit_place[u]),
        .decision(unit_found[u]),
        .late(unit_late[u]),
        .store_write,
        .store_address(visit::STORE_BITS'(store_address)),
        .store_value,
        .lines_end(visit::STORE_BITS'(lines_end))
    );
  end
  always_comb begin
    test_ends = '0;
    found = '0;
    for (int u = 0; u < TRAVERSAL_UNITS; u++)
      if (unit_done[u]) begin
        test_ends[unit_place[u]] = 1'b1;
        found[unit_place[u]] = unit_found[u];
      end
  end

  // What asks for an output or the port.
  logic [REQUESTERS-1:0] ready, nothing, home;
  logic [REQUESTERS-1:0][1:0] side;
  logic [REQUESTERS-1:0][CLASS_BITS-1:0] wanted_class;
  logic [REQUESTERS-1:0][15:0] wanted_cycles;
  logic [REQUESTERS-1:0][RAY_BITS-1:0] wanted_message;
  id_t [REQUESTERS-1:0] wanted_id;
  time_t [REQUESTERS-1:0] ready_since;

  logic answers_idle, answers_wait;
  answer_places answers (
      .clock,
      .reset,
      .now,
      .x,
      .y,
      .tracing,
      .arrives,
      .arrives_class,
      .arrives_message,
      .arrives_id,
      .leaves(goes[SIDES-1:0]),
      .ready(ready[SIDES-1:0]),
      .since(ready_since[SIDES-1:0]),
      .home(home[SIDES-1:0]),
      .side(side[SIDES-1:0]),
      .cycles(wanted_cycles[SIDES-1:0]),
      .message(wanted_message[SIDES-1:0]),
      .id(wanted_id[SIDES-1:0]),
      .idle(answers_idle),
      .waits(answers_wait)
  );
  assign wanted_class[SIDES-1:0] = {SIDES{CLASS_BITS'(ANSWERS)}};
  assign nothing[SIDES-1:0] = '0;
  // The cell's own replies.
  logic [RAY_STORE-1:0] to_answer, released, replies_went, replies_wait;
  time_t [RAY_STORE-1:0] changed;
  logic [RAY_STORE-1:0][INTENSITY_BITS-1:0] reply;
  for (genvar i = 0; i < RAY_STORE; i++) begin : g_reply
    intensity_t answer;
    assign answer = intensity_t'(reply[i]);
    way_home route (
        .x,
        .y,
        .home_x(answer.home_x),
        .home_y(answer.home_y),
        .home(home[SIDES+i]),
        .side(side[SIDES+i])
    );
    logic unused_fields;
    assign unused_fields = &{1'b0, answer};
    assign ready[SIDES+i] = to_answer[i];
    assign ready_since[SIDES+i] = changed[i];
    assign nothing[SIDES+i] = 1'b0;
    assign wanted_class[SIDES+i] = CLASS_BITS'(ANSWERS);
    assign wanted_cycles[SIDES+i] = 16'(INTENSITY_CYCLES);
    assign wanted_message[SIDES+i] = {reply[i], {(RAY_BITS - INTENSITY_BITS) {1'b0}}};
  end

  logic [ALL_PLACES-1:0] hit, room_before, room_now;
  logic [SLOT_GROUPS-1:0] group_room_before, group_room_now;
  for (genvar p = 0; p < ALL_PLACES; p++) begin : g_request
    assign ready[RAYS+p] = decided[p];
    assign ready_since[RAYS+p] = since[p];
    assign wanted_id[RAYS+p] = id[p];
    assign hit[p] = decision[p].need == NEED_SLOT;
    assign room_before[p] = group_room_before[group_of(ray_generation(message[p]))];
    assign room_now[p] = group_room_now[group_of(ray_generation(message[p]))];
    ray_request request (
        .x,
        .y,
        .known,
        .decision(decision[p]),
        .message(message[p]),
        .nothing(nothing[RAYS+p]),
        .home(home[RAYS+p]),
        .side(side[RAYS+p]),
        .out_class(wanted_class[RAYS+p]),
        .cycles(wanted_cycles[RAYS+p]),
        .sent(wanted_message[RAYS+p])
    );
  end

  logic [REQUESTERS-1:0] can_send;
  logic [SIDES:0][REQUESTERS-1:0] resource_wins;
  always_comb begin
    asks = tracing ? ready : '0;
    for (int i = 0; i < REQUESTERS; i++) can_send[i] = room[side[i]][wanted_class[i]];
  end
  whole_turns turns (
      .now,
      .asks,
      .nothing,
      .hit,
      .room_before,
      .room_now,
      .since(ready_since),
      .home,
      .side,
      .can_send,
      .replies_first,
      .overdue,
      .wins(resource_wins),
      .released
  );

  // Replies and answers take turns, if both want to go.
  logic answer_moved;
  always_comb begin
    replies_went = released;
    replies_wait = tracing ? to_answer & ~released : '0;
    answer_moved = 1'b0;
    for (int s = 0; s < SIDES; s++) answer_moved |= goes[s];
  end
  always_ff @(posedge clock) begin
    if (reset) replies_first <= 1'b0;
    else if (replies_went != '0) replies_first <= 1'b0;
    else if (replies_wait != '0 && answer_moved) replies_first <= 1'b1;
  end

  // The winner's message; one bit of a resource is set at most.
  logic [SIDES:0][CLASS_BITS-1:0] won_class;
  logic [SIDES:0][15:0] won_cycles;
  logic [SIDES:0][RAY_BITS-1:0] won_message;
  id_t [SIDES:0] won_id;
  for (genvar r = 0; r <= SIDES; r++) begin : g_winner
    winner #(
        .REQUESTERS(REQUESTERS)
    ) of (
        .wins(resource_wins[r]),
        .classes(wanted_class),
        .cycles(wanted_cycles),
        .messages(wanted_message),
        .ids(wanted_id),
        .won_class(won_class[r]),
        .won_cycles(won_cycles[r]),
        .won_message(won_message[r]),
        .won_id(won_id[r])
    );
  end
  logic unused;
  assign unused = &{1'b0, won_class[PORT], won_cycles[PORT], arrives_id[LOAD_LINK], accept_slot, store_address, lines_end, memory_address};
  assign delivered_answer = won_message[PORT][RAY_BITS-1-:INTENSITY_BITS];

  logic accept, to_slot;
  logic [ALL_INDEX_BITS-1:0] accepted;
  home_port arrived (
      .hit_wins(resource_wins[PORT][REQUESTERS-1:RAYS] & hit & room_now),
      .wins(resource_wins[PORT] != '0),
      .answer(delivered_answer),
      .accept,
      .accepted,
      .to_slot,
      .to_pixel(delivered),
      .child_postponed
  );

  logic shading_busy, store_idle, store_quiet, shading_late;
  slot_index_t accept_slot;
  ray_store slots (
      .clock,
      .fast_clock,
      .reset,
      .now,
      .x,
      .y,
      .accept,
      .accept_message(message[accepted]),
      .accept_id(id[accepted]),
      .accept_t(decision[accepted].t),
      .accept_voxel(decision[accepted].voxel),
      .room_before(group_room_before),
      .room_now(group_room_now),
      .accept_slot,
      .hold_back(draining || !tracing),
      .child_empty(place_empty[ALL_PLACES-1:FIRST_CHILD]),
      .child_leaves(leaves[ALL_PLACES-1:FIRST_CHILD]),
      .feed(child_fed),
      .fed,
      .fed_id,
      .deliver(to_slot),
      .answer(delivered_answer),
      .answer_id(won_id[PORT]),
      .to_answer,
      .changed,
      .reply,
      .reply_id(wanted_id[RAYS-1:SIDES]),
      .released,
      .lights(known.sources),
      .memory_write,
      .memory_space(3'(shade::SPACE_VOXEL) + {1'b0, memory_space}),
      .memory_address(shade::MEMORY_BITS'(memory_address)),
      .memory_word(memory_value),
      .shading_busy,
      .shading_starts,
      .starts_shade,
      .starts_slot,
      .job_slot,
      .shading_ends,
      .late(shading_late),
      .idle(store_idle),
      .quiet(store_quiet)
  );
  assign late = shading_late || unit_late != '0 || (tracing && load_computes);
  assign computes = load_computes || shading_busy || unit_busy != '0 || shading_busy_before || unit_busy_before;
  logic shading_busy_before, unit_busy_before;  // a cycle more, for the units to see that it is over
  always_ff @(posedge clock) begin
    shading_busy_before <= !reset && shading_busy;
    unit_busy_before <= !reset && unit_busy != '0;
  end
  for (genvar s = 0; s < SIDES; s++) begin : g_sent
    localparam logic LOADS = s == EAST;
    assign out_valid[s] = |resource_wins[s] || (LOADS && load_send);
    assign out_class[s] = won_class[s];  // 0 while loading
    assign out_cycles[s] = LOADS && loading ? load_cycles : won_cycles[s];
    assign out_id[s] = won_id[s];
    assign out_message[s] = LOADS && loading ? load_message : {won_message[s], {(MESSAGE_BITS - RAY_BITS) {1'b0}}};
  end

  always_comb begin
    goes = asks & nothing;  // none where shadow rays are sent by hits
    for (int r = 0; r <= SIDES; r++) goes |= resource_wins[r];
    leaves = goes[REQUESTERS-1:RAYS];
    take = '0;
    for (int s = 0; s < SIDES; s++) begin
      take[s][ANSWERS] = goes[s];
      for (int c = 0; c < RAY_CLASSES; c++) take[s][c] = leaves[RAY_CLASSES*s+c];
    end
    if (load_take) begin
      if (first_column) take[LOAD_LINK][0] = 1'b1;
      else take[WEST][0] = 1'b1;
    end
    idle = links_idle && load_idle && &place_empty && answers_idle && pixel_idle && store_idle && !latch && !making;
    still = links_idle && load_idle && (pixel_idle || draining) && !latch && !making && untested == '0 && unit_busy == '0 &&
        !shading_busy && store_quiet && to_answer == '0 && (hits & asks[REQUESTERS-1:RAYS]) == '0 &&
        answers_wait && (asks & ~stalls_full) == '0;
  end

  // What coverage counts; nothing else reads it.
  always_comb begin
    asks_since = ready_since;
    stalls_full = '0;
    stalls_wires = '0;
    goal = '0;
    for (int i = 0; i < REQUESTERS; i++)
      if (asks[i]) begin
        goal[i] = home[i] ? 3'(PORT) : {1'b0, side[i]};
        stalls_full[i] = !home[i] && full[side[i]][wanted_class[i]];
        stalls_wires[i] = !home[i] && wires_busy[side[i]];
      end
    silent = |(asks & nothing);
    postponed = delivered && !pixel_valid;
    hits = hit & decided;
    takes_slot = accept;
    slots_full = group_room_now == '0;
    replies_lead = replies_first && asks[SIDES-1:0] != '0 && asks[RAYS-1:SIDES] != '0;
    feeds = child_fed;
    ends_silently = asks[REQUESTERS-1:RAYS] & nothing[REQUESTERS-1:RAYS];
    test_starts = unit_start;
    test_place = unit_takes;
    takes = accept_slot;
    takes_place = accepted;
    again = 1'b0;
    for (int u = 0; u < TRAVERSAL_UNITS; u++) again |= unit_done[u] && unit_found[u].need == NEED_TEST;
    for (int p = 0; p < ALL_PLACES; p++) ends[p] = leaves[p] && decision[p].need == NEED_ANSWER;
  end
endmodule
