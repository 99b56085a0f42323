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
    output logic [SIDES:0][CLASSES-1:0] take,  // the oldest message leaves the buffer
    output logic [SIDES-1:0] out_valid,
    output logic [SIDES-1:0][CLASS_BITS-1:0] out_class,
    output logic [SIDES-1:0][15:0] out_cycles,
    output logic [SIDES-1:0][MESSAGE_BITS-1:0] out_message,
    input  logic [SIDES-1:0][CLASSES-1:0] free,  // a place at the far end
    output logic pixel_valid,
    output logic [3*WORD-1:0] pixel,
    output logic makes_voxel,  // a span begins here: not a cell for this scene
    output logic idle,  // nothing happens before something comes
    // What happens inside, for coverage.
    output logic [SIDES+PLACES-1:0] asks,
    output logic [SIDES+PLACES-1:0] goes,
    output logic [SIDES+PLACES-1:0] stalls_full,
    output logic [SIDES+PLACES-1:0] stalls_wires,
    output logic [SIDES+PLACES-1:0] overdue,
    output logic [PLACES-1:0] untested,
    output logic [SIDES+PLACES-1:0][2:0] goal,  // side, or 4: home
    output time_t [SIDES+PLACES-1:0] asks_since,
    output logic [PLACES-1:0] ends,  // a ray, with an answer
    output logic silent,  // a ray ended without one
    output logic again,  // a ray has left the cube and is to be tested again
    output logic postponed  // the own ray, says a notice
);
  localparam int REQUESTERS = SIDES + PLACES;  // answers by side, then rays by place
  localparam int KEY_BITS = TIME_BITS + 2;
  localparam int PORT = SIDES;  // of the ray store, beside the outputs

  logic loading, tracing;
  assign loading = phase == PHASE_LOAD;
  assign tracing = !loading;

  // Receivers.
  logic [SIDES:0] arrives, receiver_idle;
  logic [SIDES:0][CLASS_BITS-1:0] arrives_class;
  logic [SIDES:0][15:0] arrives_cycles;
  logic [SIDES:0][MESSAGE_BITS-1:0] arrives_message;
  for (genvar s = 0; s <= SIDES; s++) begin : g_receiver
    receiver from (
        .clock,
        .reset,
        .now,
        .valid(in_valid[s]),
        .in_class(in_class[s]),
        .in_cycles(in_cycles[s]),
        .in_message(in_message[s]),
        .arrives(arrives[s]),
        .arrives_class(arrives_class[s]),
        .arrives_cycles(arrives_cycles[s]),
        .arrives_message(arrives_message[s]),
        .idle(receiver_idle[s])
    );
  end

  // Outputs.
  logic [SIDES-1:0][CLASSES-1:0] room, full;
  logic [SIDES-1:0] wires_busy;
  for (genvar s = 0; s < SIDES; s++) begin : g_out
    out_link to (
        .clock,
        .reset,
        .now,
        .send(out_valid[s]),
        .send_class(out_class[s]),
        .send_cycles(out_cycles[s]),
        .free(free[s]),
        .room(room[s]),
        .full(full[s]),
        .wires_busy(wires_busy[s])
    );
  end

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
  assign viewer = preset ? setup_t'(preset_viewer) : setup_t'(load_message[MESSAGE_BITS-1-:SETUP_BITS]);
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
  time_t [PLACES-1:0] since;
  decision_t [PLACES-1:0] decision, found;
  logic [TRAVERSAL_UNITS-1:0] unit_busy, unit_start, unit_done;
  logic [TRAVERSAL_UNITS-1:0][PLACE_INDEX_BITS-1:0] unit_takes, unit_place;
  decision_t [TRAVERSAL_UNITS-1:0] unit_found;

  for (genvar p = 0; p < OWN; p++) begin : g_place
    localparam int SIDE = p / RAY_CLASSES;
    localparam int CLASS = p % RAY_CLASSES;
    if (CARRIES[CLASSES*SIDE+CLASS]) begin : g_used
      ray_place place (
          .clock,
          .reset,
          .now,
          .arrives(tracing && arrives[SIDE] && int'(arrives_class[SIDE]) == CLASS),
          .arrives_message(arrives_message[SIDE][MESSAGE_BITS-1-:RAY_BITS]),
          .leaves(leaves[p]),
          .test_starts(started[p]),
          .test_ends(test_ends[p]),
          .found(found[p]),
          .untested(untested[p]),
          .to_test(to_test[p]),
          .decided(decided[p]),
          .since(since[p]),
          .decision(decision[p]),
          .message(message[p]),
          .empty(place_empty[p])
      );
    end else begin : g_none  // no ray of this class comes over this side
      assign untested[p] = 1'b0;
      assign decided[p] = 1'b0;
      assign place_empty[p] = 1'b1;
      assign to_test[p] = '0;
      assign message[p] = '0;
      assign since[p] = '0;
      assign decision[p] = '0;
    end
  end

  // The own ray's register: a ray can be tested in the cycle in which it comes there.
  logic feed, own_untested, delivered, pixel_idle;
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
  time_t [REQUESTERS-1:0] ready_since;

  logic [SIDES-1:0] answers_empty;
  for (genvar s = 0; s < SIDES; s++) begin : g_answers
    answer_place place (
        .clock,
        .reset,
        .now,
        .x,
        .y,
        .arrives(tracing && arrives[s] && int'(arrives_class[s]) == ANSWERS),
        .arrives_message(arrives_message[s][MESSAGE_BITS-1-:INTENSITY_BITS]),
        .leaves(goes[s]),
        .ready(ready[s]),
        .since(ready_since[s]),
        .home(home[s]),
        .side(side[s]),
        .cycles(wanted_cycles[s]),
        .message(wanted_message[s][RAY_BITS-1-:INTENSITY_BITS]),
        .empty(answers_empty[s])
    );
    assign wanted_message[s][RAY_BITS-INTENSITY_BITS-1:0] = '0;
    assign wanted_class[s] = CLASS_BITS'(ANSWERS);
    assign nothing[s] = 1'b0;
  end
  for (genvar p = 0; p < PLACES; p++) begin : g_request
    assign ready[SIDES+p] = decided[p];
    assign ready_since[SIDES+p] = since[p];
    ray_request request (
        .x,
        .y,
        .known,
        .decision(decision[p]),
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
  logic [REQUESTERS-1:0][KEY_BITS-1:0] key;
  logic [SIDES:0][REQUESTERS-1:0] resource_asks, resource_wins;
  always_comb begin
    resource_asks = '0;
    stalls_full   = '0;
    stalls_wires  = '0;
    goal          = '0;
    asks          = tracing ? ready : '0;
    for (int i = 0; i < REQUESTERS; i++) begin
      overdue[i] = ready[i] && ready_since[i] + TIME_BITS'(PATIENCE) < began && fault != FAULT_AGE;
      key[i] = {!overdue[i], !overdue[i] && i >= SIDES, fault == FAULT_ORDER ? '0 : ready_since[i]};
      if (asks[i] && !nothing[i]) begin
        if (home[i]) begin
          goal[i] = 3'(PORT);
          resource_asks[PORT][i] = 1'b1;
        end else begin
          goal[i] = {1'b0, side[i]};
          resource_asks[side[i]][i] = room[side[i]][wanted_class[i]];
          stalls_full[i] = full[side[i]][wanted_class[i]];
          stalls_wires[i] = wires_busy[side[i]];
        end
      end
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
  for (genvar r = 0; r <= SIDES; r++) begin : g_winner
    winner #(
        .REQUESTERS(REQUESTERS)
    ) of (
        .wins(resource_wins[r]),
        .classes(wanted_class),
        .cycles(wanted_cycles),
        .messages(wanted_message),
        .won_class(won_class[r]),
        .won_cycles(won_cycles[r]),
        .won_message(won_message[r])
    );
  end
  logic unused;
  assign unused = &{1'b0, won_class[PORT], won_cycles[PORT]};  // home is no link
  assign delivered = |resource_wins[PORT];
  assign delivered_answer = won_message[PORT][RAY_BITS-1-:INTENSITY_BITS];
  for (genvar s = 0; s < SIDES; s++) begin : g_sent
    localparam logic LOADS = s == EAST;
    assign out_valid[s] = |resource_wins[s] || (LOADS && load_send);
    assign out_class[s] = won_class[s];  // 0 while loading
    assign out_cycles[s] = LOADS && loading ? load_cycles : won_cycles[s];
    assign out_message[s] = LOADS && loading ? load_message : {won_message[s], {(MESSAGE_BITS - RAY_BITS) {1'b0}}};
  end

  always_comb begin
    goes = asks & nothing;
    for (int r = 0; r <= SIDES; r++) goes |= resource_wins[r];
    leaves = goes[REQUESTERS-1:SIDES];
    take = '0;
    for (int s = 0; s < SIDES; s++) begin
      take[s][ANSWERS] = goes[s];
      for (int c = 0; c < RAY_CLASSES; c++) take[s][c] = leaves[RAY_CLASSES*s+c];
    end
    if (load_take) begin
      if (first_column) take[LOAD_LINK][0] = 1'b1;
      else take[WEST][0] = 1'b1;
    end
    idle = &receiver_idle && load_idle && &place_empty && &answers_empty && pixel_idle && !latch && !making;
  end

  // What coverage counts; nothing else reads it.
  always_comb begin
    asks_since = ready_since;
    silent = |(asks & nothing);
    postponed = delivered && !pixel_valid;
    again = 1'b0;
    for (int u = 0; u < TRAVERSAL_UNITS; u++) again |= unit_done[u] && unit_found[u].need == NEED_TEST;
    for (int p = 0; p < PLACES; p++) ends[p] = leaves[p] && decision[p].need == NEED_ANSWER;
  end
endmodule
