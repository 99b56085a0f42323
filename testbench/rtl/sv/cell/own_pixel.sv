// The cell's own pixel: when its primary ray is sent, and sent again after a notice that it was postponed.
module own_pixel
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  time_t now,
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  logic begins,  // first cycle of the trace
    input  logic other_phase,  // another phase begins
    input  logic hold_back,  // new rays wait
    input  logic register_free,
    input  logic delivered,
    input  logic [INTENSITY_BITS-1:0] answer,
    output logic send,
    output logic pixel_valid,
    output logic [3*WORD-1:0] pixel,
    output logic idle
);
  logic to_send;
  time_t not_before;
  logic [7:0] attempts;
  logic [63:0] wait_cycles, first_start;

  back_off draw (
      .ray({32'(y) * 32'(COLUMNS) + 32'(x), 32'd0}),
      .attempt(attempts),
      .cycles(wait_cycles),
      .first_start
  );

  time_t first;
  intensity_t intensity;
  logic postponed;
  always_comb begin
    first = START_WITHIN == 0 ? now : now + TIME_BITS'(first_start);
    send = !hold_back && register_free &&
        (begins ? first == now : to_send && now >= not_before);
    intensity = answer;
    postponed = intensity.message_type == TYPE_POSTPONED;
    pixel_valid = delivered && !postponed;
    pixel = {intensity.red, intensity.green, intensity.blue};
    idle = !to_send;
  end
  logic unused;
  assign unused = &{1'b0, intensity, wait_cycles, first_start};

  always_ff @(posedge clock) begin
    if (reset) begin
      to_send <= 1'b0;
      not_before <= '0;
      attempts <= '0;
    end else if (begins) begin
      to_send <= !send;
      not_before <= first;
      attempts <= '0;
    end else if (delivered && postponed) begin
      to_send <= 1'b1;
      not_before <= now + TIME_BITS'(wait_cycles);
      if (attempts < 8'd250) attempts <= attempts + 8'd1;
    end else if (send || other_phase) begin
      to_send <= 1'b0;
    end
  end
endmodule
