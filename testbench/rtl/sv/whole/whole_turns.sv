// Who moves in a cycle. Each message wants one output, or the ray store's port. First go what is overdue, oldest
// first, then answers and the cell's own replies, of which one kind goes before the other; then rays, oldest first.
// A hit wants the port if it finds a slot, those that are released in this cycle counted; else it is
// postponed: the notice goes home, unless the port was used before its turn.
module whole_turns
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
  import raycell_whole::*;
#(
    parameter int RAYS = SIDES + RAY_STORE,
    parameter int REQUESTERS = RAYS + ALL_PLACES
) (
    input  time_t now,
    input  logic [REQUESTERS-1:0] asks,
    input  logic [REQUESTERS-1:0] nothing,  // it wants to end
    input  logic [ALL_PLACES-1:0] hit,
    input  logic [ALL_PLACES-1:0] room_before,  // a slot, without those that are released
    input  logic [ALL_PLACES-1:0] room_now,  // with them
    input  time_t [REQUESTERS-1:0] since,
    input  logic [REQUESTERS-1:0] home,
    input  logic [REQUESTERS-1:0][1:0] side,
    input  logic [REQUESTERS-1:0] can_send,  // over its side
    input  logic replies_first,
    output logic [REQUESTERS-1:0] overdue,
    output logic [SIDES:0][REQUESTERS-1:0] wins,  // by output, then of the port
    output logic [RAY_STORE-1:0] released
);
  localparam int PORT = SIDES;
  localparam int KEY_BITS = TIME_BITS + 2;

  time_t began, first_reply;
  logic reply_overdue;
  logic [REQUESTERS-1:0][KEY_BITS-1:0] key;
  always_comb begin
    began = now & ~(TIME_BITS'(EPOCH) - 1'b1);
    reply_overdue = 1'b0;
    first_reply = '0;
    for (int i = 0; i < REQUESTERS; i++) begin
      overdue[i] = asks[i] && since[i] + TIME_BITS'(PATIENCE) < began && fault != FAULT_AGE;
      if (overdue[i] && i >= SIDES && i < RAYS && (!reply_overdue || since[i] < first_reply)) begin
        reply_overdue = 1'b1;
        first_reply = since[i];
      end
    end
    // If a reply is overdue, all go.
    for (int i = 0; i < REQUESTERS; i++) begin
      if (i >= SIDES && i < RAYS)
        key[i] = reply_overdue ? {2'd0, first_reply} : {replies_first ? 2'd1 : 2'd2, TIME_BITS'(0)};
      else if (overdue[i]) key[i] = {2'd0, since[i]};
      else key[i] = {i < SIDES ? (replies_first ? 2'd2 : 2'd1) : 2'd3, since[i]};
      if (fault == FAULT_ORDER) key[i][TIME_BITS-1:0] = '0;
    end
  end

  // First all but rays that are not overdue, and hits that can't be sure of a slot.
  logic [SIDES:0][REQUESTERS-1:0] first_asks, first_wins;
  always_comb begin
    first_asks = '0;
    for (int i = 0; i < REQUESTERS; i++)
      if (asks[i] && !nothing[i] && (i < RAYS || overdue[i])) begin
        if (i >= RAYS && hit[i-RAYS]) first_asks[PORT][i] = room_before[i-RAYS];
        else if (home[i]) first_asks[PORT][i] = 1'b1;
        else first_asks[side[i]][i] = can_send[i];
      end
  end
  for (genvar r = 0; r <= SIDES; r++) begin : g_first
    oldest_first #(
        .REQUESTERS(REQUESTERS),
        .KEY_BITS  (KEY_BITS)
    ) arbiter (
        .asks(first_asks[r]),
        .key,
        .wins(first_wins[r])
    );
  end
  always_comb begin
    released = '0;
    for (int r = 0; r <= SIDES; r++) released |= first_wins[r][RAYS-1:SIDES];
  end

  // Then rays on what is left: the port, and, when it is known whose that is, the outputs.
  logic [SIDES-1:0][REQUESTERS-1:0] then_asks;
  logic [SIDES-1:0][REQUESTERS-1:0] then_wins;
  logic [REQUESTERS-1:0] port_wins;
  logic [SIDES:0] used;
  logic [REQUESTERS-1:0] left, port_asks, port_used_before;
  always_comb begin
    left = asks & ~nothing;
    left[RAYS-1:0] = '0;
    port_asks = '0;
    for (int r = 0; r <= SIDES; r++) begin
      left &= ~first_wins[r];
      used[r] = first_wins[r] != '0;
    end
    for (int i = RAYS; i < REQUESTERS; i++)
      port_asks[i] = left[i] && !used[PORT] && ((hit[i-RAYS] && room_now[i-RAYS]) || home[i]);
  end
  oldest_first #(
      .REQUESTERS(REQUESTERS),
      .KEY_BITS  (KEY_BITS)
  ) port (
      .asks(port_asks),
      .key,
      .wins(port_wins)
  );
  always_comb begin
    port_used_before = '0;
    then_asks = '0;
    for (int i = RAYS; i < REQUESTERS; i++) begin
      port_used_before[i] = used[PORT];
      for (int j = RAYS; j < REQUESTERS; j++)
        if (port_wins[j] && (key[j] < key[i] || (key[j] == key[i] && j < i))) port_used_before[i] = 1'b1;
      if (left[i] && !home[i] && !(hit[i-RAYS] && (room_now[i-RAYS] || port_used_before[i] || fault == FAULT_WAITS)))
        then_asks[side[i]][i] = can_send[i] && !used[{1'b0, side[i]}];
    end
  end
  for (genvar r = 0; r < SIDES; r++) begin : g_then
    oldest_first #(
        .REQUESTERS(REQUESTERS),
        .KEY_BITS  (KEY_BITS)
    ) arbiter (
        .asks(then_asks[r]),
        .key,
        .wins(then_wins[r])
    );
  end
  assign wins = first_wins | {port_wins, then_wins};
endmodule
