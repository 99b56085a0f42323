// A slot of the ray store: a hit that waits for its children's answers.
module slot
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
  import raycell_whole::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    // The hit.
    input  logic accept,
    input  logic [RAY_BITS-1:0] accept_message,
    input  id_t accept_id,
    input  logic [DISTANCE_BITS-1:0] accept_t,
    input  logic [VOXEL_BITS-1:0] accept_voxel,
    output logic [RAY_BITS-1:0] message,
    output id_t id,
    output logic [DISTANCE_BITS-1:0] t,
    output logic [VOXEL_BITS-1:0] voxel,
    // Its children, one after the other through one register.
    input  logic hold_back,
    input  logic child_empty,  // the register
    input  logic child_leaves,
    output logic feed,
    output child_index_t feed_number,
    // Their answers.
    input  logic deliver,
    input  logic [INTENSITY_BITS-1:0] answer,
    input  time_t wait_cycles,  // of a child that was postponed
    output logic [1:0][7:0] attempts,
    output logic [LIGHTS-1:0] lit,
    output colour_t [1:0] colour,
    // Jobs of the shading unit: it begins one, and ends it at the end of a cycle.
    output logic complete,  // at the end of this cycle
    output logic fresh,
    output time_t since,
    input  logic begins,
    input  logic ends_set_up,
    input  logic ends_shading,
    input  set_up_t found,
    input  colour_t result,
    // The reply.
    output logic to_answer,
    output time_t changed,
    output logic [INTENSITY_BITS-1:0] reply,
    input  logic released,
    output logic empty,
    output logic quiet
);
  localparam logic [2:0] EMPTY = 0, TO_SET_UP = 1, IN_SET_UP = 2, WAITING = 3, IN_SHADING = 4, TO_ANSWER = 5;
  localparam logic [7:0] ATTEMPTS = 8'd250;  // a back-off counts no further

  logic [2:0] state;
  logic [LIGHTS-1:0] to_ask, awaited, asked, next_awaited, next_lit;
  logic [1:0] send, await, fed, next_send, next_await;
  time_t [1:0] retry_at;
  colour_t colour_held;

  // The next child: shadow rays by light, then the reflected, then the refracted ray.
  always_comb begin
    feed = 1'b0;
    feed_number = '0;
    asked = '0;
    fed = '0;
    if (state == WAITING && child_empty && !hold_back) begin
      for (int k = LIGHTS - 1; k >= 0; k--)
        if (to_ask[k]) begin
          feed = 1'b1;
          feed_number = child_index_t'(k);
        end
      if (feed) asked[light_index_t'(feed_number)] = 1'b1;
      else
        for (int c = 1; c >= 0; c--)
          if (send[c] && (now >= retry_at[c] || fault == FAULT_RETRY)) begin
            feed = 1'b1;
            feed_number = child_index_t'(LIGHTS + c);
            fed = c == 0 ? 2'b01 : 2'b10;
          end
    end
  end

  // An answer that is home.
  intensity_t intensity;
  verdict_t verdict;
  logic colours, postponed, which;
  always_comb begin
    intensity = intensity_t'(answer);
    verdict = verdict_t'(answer[INTENSITY_BITS-1-:VERDICT_BITS]);
    colours = deliver && intensity.message_type == TYPE_INTENSITY;
    postponed = deliver && intensity.message_type == TYPE_POSTPONED;
    which = colours ? intensity.child[0] : verdict.child[0];
    next_awaited = awaited;
    next_lit = lit;
    next_send = send & ~fed;
    next_await = await;
    if (colours) next_await[which] = 1'b0;
    else if (postponed) next_send[which] = 1'b1;
    else if (deliver) begin
      next_awaited[light_index_t'(verdict.child)] = 1'b0;
      if (verdict.message_type == TYPE_LIT) next_lit[light_index_t'(verdict.child)] = 1'b1;
    end
    complete = state == WAITING && (child_empty ? !feed : child_leaves) && to_ask == '0 && next_awaited == '0 &&
        next_send == '0 && next_await == '0;
    fresh = state == TO_SET_UP || accept;
    empty = state == EMPTY;
    quiet = empty || (state == WAITING && (!child_empty || (to_ask == '0 && send == '0)));
    to_answer = state == TO_ANSWER;
  end

  ray_t hit;
  always_comb begin
    hit = ray_t'(message);
    reply = intensity_t'{
        message_type: TYPE_INTENSITY,
        red: colour_held.red,
        green: colour_held.green,
        blue: colour_held.blue,
        home_x: hit.home_x,
        home_y: hit.home_y,
        slot: hit.slot,
        child: hit.child
    };
  end
  logic unused;
  assign unused = &{1'b0, hit, intensity, verdict};

  always_ff @(posedge clock) begin
    if (reset) begin
      state <= EMPTY;
      {message, id, t, voxel, since, changed} <= '0;
      {to_ask, awaited, lit, send, await, retry_at, attempts} <= '0;
      colour <= '0;
      colour_held <= '0;
    end else begin
      if (accept) begin
        state <= begins ? IN_SET_UP : TO_SET_UP;
        message <= accept_message;
        id <= accept_id;
        t <= accept_t;
        voxel <= accept_voxel;
        since <= now;
        {lit, retry_at, attempts} <= '0;
        colour <= '0;
      end else if (released) begin
        state <= EMPTY;
      end else if (begins) begin
        state <= state == TO_SET_UP ? IN_SET_UP : IN_SHADING;
        lit <= fault == FAULT_LAST_VERDICT ? lit : next_lit;  // what comes last may begin the job
        if (colours) colour[which] <= '{red: intensity.red, green: intensity.green, blue: intensity.blue};
        {to_ask, awaited, send, await} <= '0;
      end else if (ends_set_up) begin
        state <= WAITING;
        changed <= now + 1'b1;
        to_ask <= found.facing;
        awaited <= found.facing;
        send <= {found.refracts, found.reflects};
        await <= {found.refracts, found.reflects};
      end else if (ends_shading) begin
        state <= TO_ANSWER;
        changed <= now + 1'b1;
        colour_held <= result;
      end else if (state == WAITING) begin
        to_ask <= to_ask & ~asked;
        awaited <= next_awaited;
        lit <= next_lit;
        send <= next_send;
        await <= next_await;
        if (colours) colour[which] <= '{red: intensity.red, green: intensity.green, blue: intensity.blue};
        if (postponed) begin
          retry_at[which] <= now + wait_cycles;
          if (attempts[which] < ATTEMPTS) attempts[which] <= attempts[which] + 8'd1;
        end
      end
    end
  end
endmodule
