// A cell without voxels: passes load messages on, walks rays from side to side, sends answers home, and traces
// its own pixel's ray. A link's message port is as wide as the widest message; the first bit sent is the
// highest. `cycles` is how long a message takes on the wires. All that a cell does in a cycle follows from its
// registers, so nothing that a neighbour does in the same cycle is seen.
module empty_cell
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  logic clock,
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
    input  logic [SIDES:0][ID_BITS-1:0] in_id,  // beside the wires
    output logic [SIDES:0][CLASSES-1:0] take,  // the oldest message leaves the buffer
    output logic [SIDES-1:0] out_valid,
    output logic [SIDES-1:0][CLASS_BITS-1:0] out_class,
    output logic [SIDES-1:0][15:0] out_cycles,
    output logic [SIDES-1:0][MESSAGE_BITS-1:0] out_message,
    output logic [SIDES-1:0][ID_BITS-1:0] out_id,
    input  logic [SIDES-1:0][CLASSES-1:0] free,  // a place at the far end
    output logic pixel_valid,
    output logic [3*WORD-1:0] pixel,
    output logic makes_voxel,  // a span begins here: not a cell for this scene
    output logic idle,  // nothing happens before something comes
    output logic still,  // nor before a place at a far end is freed
    // What happens inside, for coverage and for the books of an array.
    output logic [SIDES+PLACES-1:0] asks,
    output logic [SIDES+PLACES-1:0] goes,
    output logic [SIDES+PLACES-1:0] stalls_full,
    output logic [SIDES+PLACES-1:0] stalls_wires,
    output logic [SIDES+PLACES-1:0] overdue,
    output logic [PLACES-1:0] untested,
    output logic [SIDES+PLACES-1:0][2:0] goal,  // side, or 4: home
    output logic [SIDES+PLACES-1:0][TIME_BITS-1:0] asks_since,
    output logic [PLACES-1:0] ends,  // a ray, with an answer
    output logic silent,  // a ray ended without one
    output logic again,  // a ray has left the cube and is to be tested again
    output logic postponed,  // the own ray, says a notice
    output logic [PLACES-1:0] ends_silently,  // a ray, without an answer
    output logic feed,  // the own ray comes into its register
    output logic [TRAVERSAL_UNITS-1:0] test_starts,
    output logic [TRAVERSAL_UNITS-1:0][PLACE_INDEX_BITS-1:0] test_place
);
  localparam int REQUESTERS = SIDES + PLACES;  // answers by side, then rays by place
  localparam int KEY_BITS = TIME_BITS + 2;
  localparam int PORT = SIDES;  // of the ray store, beside the outputs

  logic loading, tracing;
  assign loading = phase == PHASE_LOAD;
  assign tracing = !loading;

  logic [SIDES:0] arrives;
  logic links_idle;
  logic [SIDES:0][CLASS_BITS-1:0] arrives_class;
  logic [SIDES:0][15:0] arrives_cycles;
  logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message;
  logic [SIDES:0][ID_BITS-1:0] arrives_id;
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
  load_unit loader (
      .clock,
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
      .is_setup(load_is_setup),
      .makes_voxel,
      .idle(load_idle)
  );

  logic latch;
  setup_t viewer;
  known_t known;
  assign latch  = preset || (load_is_setup && load_take);
  assign viewer = preset ? preset_viewer : load_message[MESSAGE_BITS-1-:SETUP_BITS];
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
  logic [PLACES-1:0] leaves, decided, place_empty, started, test_ends;
  logic [PLACES-1:0][RAY_BITS-1:0] to_test, message;
  logic [PLACES-1:0][ID_BITS-1:0] id;
  logic [PLACES-1:0][TIME_BITS-1:0] since;
  logic [PLACES-1:0][DECISION_BITS-1:0] decision, found;
  logic [TRAVERSAL_UNITS-1:0] unit_busy, unit_start, unit_done;
  logic [TRAVERSAL_UNITS-1:0][PLACE_INDEX_BITS-1:0] unit_takes, unit_place;
  logic [TRAVERSAL_UNITS-1:0][DECISION_BITS-1:0] unit_found;
  logic [TRAVERSAL_UNITS-1:0] unit_again;

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

  test_turn turn (
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
    traversal_unit traversal (
        .clock,
        .reset,
        .now,
        .x,
        .y,
        .known,
        .precast(phase == PHASE_PRECAST),
        .start(unit_start[u]),
        .start_place(unit_takes[u]),
        .start_message(to_test[unit_takes[u]]),
        .busy(unit_busy[u]),
        .done(unit_done[u]),
        .place(unit_place[u]),
        .decision(unit_found[u])
    );
    logic [DECISION_BITS-1:0] result;
    assign result = unit_found[u];
    assign unit_again[u] = unit_done[u] && result[DECISION_BITS-1-:3] == NEED_TEST;
    logic unused;
    assign unused = &{1'b0, result};
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
  logic [REQUESTERS-1:0][ID_BITS-1:0] wanted_id;
  logic [REQUESTERS-1:0][TIME_BITS-1:0] ready_since;

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
  for (genvar p = 0; p < PLACES; p++) begin : g_request
    assign ready[SIDES+p] = decided[p];
    assign ready_since[SIDES+p] = since[p];
    assign wanted_id[SIDES+p] = id[p];
    logic [DECISION_BITS-1:0] decided_for;
    assign decided_for = decision[p];
    assign ends[p] = leaves[p] && decided_for[DECISION_BITS-1-:3] == NEED_ANSWER;
    ray_request request (
        .x,
        .y,
        .known,
        .decision(decided_for),
        .message(message[p]),
        .nothing(nothing[SIDES+p]),
        .home(home[SIDES+p]),
        .side(side[SIDES+p]),
        .out_class(wanted_class[SIDES+p]),
        .cycles(wanted_cycles[SIDES+p]),
        .sent(wanted_message[SIDES+p])
    );
  end

  // Overdue messages before all others, oldest first; then answers before rays.
  time_t began;
  assign began = now & ~(TIME_BITS'(EPOCH) - 1'b1);
  assign asks  = tracing ? ready : '0;
  logic [REQUESTERS-1:0][KEY_BITS-1:0] key;
  logic [REQUESTERS-1:0][SIDES:0] asks_for;
  logic [SIDES:0][REQUESTERS-1:0] resource_asks, resource_wins;
  for (genvar i = 0; i < REQUESTERS; i++) begin : g_asks
    localparam logic IS_ANSWER = i < SIDES;
    time_t since_when;
    logic [CLASSES-1:0] room_there, full_there;
    logic wants_link, late;
    assign since_when = ready_since[i];
    assign room_there = room[side[i]];
    assign full_there = full[side[i]];
    assign wants_link = asks[i] && !nothing[i] && !home[i];
    assign late = ready[i] && since_when + TIME_BITS'(PATIENCE) < began && fault != FAULT_AGE;
    assign overdue[i] = late;
    assign key[i] = {!late, !late && !IS_ANSWER, fault == FAULT_ORDER ? TIME_BITS'(0) : since_when};
    assign goal[i] = !asks[i] || nothing[i] ? 3'd0 : home[i] ? 3'(PORT) : {1'b0, side[i]};
    assign asks_for[i] = {asks[i] && !nothing[i] && home[i],
                          {3'b0, wants_link && room_there[wanted_class[i]]} << side[i]};
    assign stalls_full[i] = wants_link && full_there[wanted_class[i]];
    assign stalls_wires[i] = wants_link && wires_busy[side[i]];
    for (genvar r = 0; r <= SIDES; r++) begin : g_of
      assign resource_asks[r][i] = asks_for[i][r];
    end
  end
  for (genvar r = 0; r <= SIDES; r++) begin : g_arbiter
    oldest_first #(
        .REQUESTERS(REQUESTERS),
        .KEY_BITS  (KEY_BITS)
    ) arbiter (
        .asks(resource_asks[r]),
        .key,
        .wins(resource_wins[r])
    );
  end

  // The winner's message; one bit of a resource is set at most.
  logic [SIDES:0][CLASS_BITS-1:0] won_class;
  logic [SIDES:0][15:0] won_cycles;
  logic [SIDES:0][RAY_BITS-1:0] won_message;
  logic [SIDES:0][ID_BITS-1:0] won_id;
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
  assign unused = &{1'b0, won_class[PORT], won_cycles[PORT], delivered_message, won_id[PORT], arrives_id[LOAD_LINK]};  // home is no link
  assign delivered = |resource_wins[PORT];
  logic [RAY_BITS-1:0] delivered_message;
  assign delivered_message = won_message[PORT];
  assign delivered_answer  = delivered_message[RAY_BITS-1-:INTENSITY_BITS];
  for (genvar s = 0; s < SIDES; s++) begin : g_sent
    localparam logic LOADS = s == EAST;
    assign out_valid[s] = |resource_wins[s] || (LOADS && load_send);
    assign out_class[s] = won_class[s];  // 0 while loading
    assign out_cycles[s] = LOADS && loading ? load_cycles : won_cycles[s];
    assign out_id[s] = won_id[s];
    assign out_message[s] = LOADS && loading ? load_message : {won_message[s], {(MESSAGE_BITS - RAY_BITS) {1'b0}}};
  end

  for (genvar s = 0; s < SIDES; s++) begin : g_taken
    localparam logic LOADS = s == WEST;
    // Rays by class, then answers; while loading, class 0 alone.
    assign take[s] = {goes[s], leaves[RAY_CLASSES*s+:RAY_CLASSES]} | CLASSES'(LOADS && load_take && !first_column);
  end
  assign take[LOAD_LINK] = CLASSES'(load_take && first_column);
  assign leaves = goes[REQUESTERS-1:SIDES];
  assign goes = (asks & nothing) | resource_wins[EAST] | resource_wins[SOUTH] | resource_wins[WEST] |
      resource_wins[NORTH] | resource_wins[PORT];
  always_comb begin
    idle = links_idle && load_idle && &place_empty && answers_idle && pixel_idle && !latch && !making;
    still = links_idle && load_idle && (pixel_idle || draining) && !latch && !making && untested == '0 &&
        unit_busy == '0 && answers_wait && (asks & ~stalls_full) == '0;
  end

  // What coverage counts and the books of an array say; nothing else reads it.
  always_comb begin
    asks_since = ready_since;
    silent = |(asks & nothing);
    ends_silently = asks[REQUESTERS-1:SIDES] & nothing[REQUESTERS-1:SIDES];
    test_starts = unit_start;
    test_place = unit_takes;
    postponed = delivered && !pixel_valid;
    again = |unit_again;
  end
endmodule
