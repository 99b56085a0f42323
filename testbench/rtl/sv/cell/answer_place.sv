// The answers that came over one side, and where the oldest goes. It is ready some cycles after its arrival,
// not after it came to the head.
module answer_place
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  logic arrives,
    input  logic [INTENSITY_BITS-1:0] arrives_message,
    input  id_t arrives_id,
    input  logic leaves,
    output logic ready,
    output time_t since,
    output logic home,
    output logic [1:0] side,
    output logic [15:0] cycles,
    output logic [INTENSITY_BITS-1:0] message,
    output id_t id,
    output logic empty
);
  localparam int COUNT = $clog2(BUFFER + 1);
  logic [COUNT-1:0] count;
  logic [ID_BITS+INTENSITY_BITS-1:0] second;
  time_t arrival;

  message_buffer #(
      .BITS (ID_BITS + INTENSITY_BITS),
      .DEPTH(BUFFER)
  ) buffer (
      .clock,
      .reset,
      .push(arrives),
      .push_message({arrives_id, arrives_message}),
      .push_arrival(now + 1'b1),
      .pop(leaves),
      .replace(1'b0),
      .replacement({(ID_BITS + INTENSITY_BITS) {1'b0}}),
      .count,
      .head({id, message}),
      .arrival,
      .second
  );

  intensity_t intensity;
  verdict_t verdict;
  logic is_intensity;
  always_comb begin
    intensity = message;
    verdict = message[INTENSITY_BITS-1-:VERDICT_BITS];
    is_intensity = intensity.message_type == TYPE_INTENSITY;
    cycles = is_intensity ? 16'(INTENSITY_CYCLES) : 16'(VERDICT_CYCLES);
  end
  way_home route (
      .x,
      .y,
      .home_x(is_intensity ? intensity.home_x : verdict.home_x),
      .home_y(is_intensity ? intensity.home_y : verdict.home_y),
      .home,
      .side
  );

  assign empty = count == '0;
  assign since = arrival + TIME_BITS'(COST_ROUTE_RETURN);
  assign ready = !empty && now >= since;
  logic unused;
  assign unused = &{1'b0, second, intensity, verdict};
endmodule
