// A place of rays: the buffer of one side and class. Its oldest ray is untested, in test or decided.
module ray_place
  import raycell_pkg::*;
  import raycell_cell::*;
#(
    parameter int DEPTH = BUFFER
) (
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic arrives,
    input  logic [RAY_BITS-1:0] arrives_message,
    input  id_t arrives_id,
    input  logic leaves,
    input  logic test_starts,
    input  logic test_ends,  // at the end of this cycle
    input  decision_t found,
    output logic untested,  // behind a ray that leaves in this cycle, too
    output logic [RAY_BITS-1:0] to_test,
    output logic decided,
    output time_t since,
    output decision_t decision,
    output logic [RAY_BITS-1:0] message,
    output id_t id,
    output logic empty
);
  localparam int COUNT = $clog2(DEPTH + 1);
  localparam logic [1:0] UNTESTED = 0, IN_TEST = 1, DECIDED = 2;
  logic [COUNT-1:0] count;
  logic [RAY_BITS-1:0] second;
  id_t second_id;
  logic [1:0] stage;
  time_t arrival;

  // The oldest ray with the place, way left and mark that a test has found.
  ray_t ray;
  shadow_ray_t shadow;
  logic [RAY_BITS-1:0] moved;
  always_comb begin
    ray = message;
    ray.x = found.x;
    ray.y = found.y;
    ray.z = found.z;
    ray.outside = found.outside;
    shadow = message[RAY_BITS-1-:SHADOW_RAY_BITS];
    shadow.x = found.x;
    shadow.y = found.y;
    shadow.z = found.z;
    shadow.reach = found.reach;
    shadow.outside = found.outside;
  end
  assign moved = ray.message_type == TYPE_SHADOW_RAY ? {shadow, {(RAY_BITS - SHADOW_RAY_BITS) {1'b0}}} : ray;

  message_buffer #(
      .BITS (ID_BITS + RAY_BITS),
      .DEPTH(DEPTH)
  ) buffer (
      .clock,
      .reset,
      .push(arrives),
      .push_message({arrives_id, arrives_message}),
      .push_arrival(now + 1'b1),
      .pop(leaves),
      .replace(test_ends),
      .replacement({id, moved}),
      .count,
      .head({id, message}),
      .arrival,
      .second({second_id, second})
  );
  logic unused;
  assign unused = &{1'b0, arrival, second_id};

  assign empty = count == '0;
  assign decided = !empty && stage == DECIDED;
  assign untested = leaves ? int'(count) > 1 : !empty && stage == UNTESTED;
  assign to_test = leaves ? second : message;

  always_ff @(posedge clock) begin
    if (reset) begin
      stage <= UNTESTED;
      since <= '0;
      decision <= '0;
    end else if (test_starts) begin
      stage <= IN_TEST;
    end else if (leaves) begin
      stage <= UNTESTED;
    end else if (test_ends) begin
      // What has left the cube stays in its place and is tested once more.
      stage <= found.need == NEED_TEST ? UNTESTED : DECIDED;
      since <= now + 1'b1;
      decision <= found;
    end
  end
endmodule
