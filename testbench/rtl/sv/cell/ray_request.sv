// What a decided ray asks for: an output, the ray store's port, or nothing; and the message that it sends.
module ray_request
  import raycell_pkg::*;
  import raycell_cell::*;
(
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  known_t known,
    input  decision_t decision,
    input  logic [RAY_BITS-1:0] message,
    output logic nothing,  // it ends without an answer
    output logic home,  // its answer is for this cell
    output logic [1:0] side,
    output logic [CLASS_BITS-1:0] out_class,
    output logic [15:0] cycles,
    output logic [RAY_BITS-1:0] sent
);
  ray_t ray;
  shadow_ray_t shadow_ray;
  logic shadow, at_home;
  logic [1:0] way;
  intensity_t background;
  verdict_t lit;

  always_comb begin
    ray = as_ray(message);
    shadow_ray = as_shadow_ray(message);
    shadow = is_shadow(message);
    background = '{
        message_type: TYPE_INTENSITY,
        red: known.red,
        green: known.green,
        blue: known.blue,
        home_x: ray.home_x,
        home_y: ray.home_y,
        slot: ray.slot,
        child: ray.child
    };
    lit = '{
        message_type: TYPE_LIT,
        home_x: shadow_ray.home_x,
        home_y: shadow_ray.home_y,
        slot: shadow_ray.slot,
        child: shadow_ray.child
    };
  end

  way_home route (
      .x,
      .y,
      .home_x(shadow ? shadow_ray.home_x : ray.home_x),
      .home_y(shadow ? shadow_ray.home_y : ray.home_y),
      .home  (at_home),
      .side  (way)
  );

  always_comb begin
    nothing = decision.need == NEED_NOTHING;
    if (decision.need == NEED_OUTPUT) begin
      home = 1'b0;
      side = decision.side;
      out_class = '0;
      if (CLASS_BY_DX && ray.dx[WORD-1]) out_class = out_class + CLASS_BITS'(1);
      if (CLASS_BY_DY && ray.dy[WORD-1]) out_class = out_class + CLASS_BITS'(2);
      cycles = shadow ? 16'(SHADOW_RAY_CYCLES) : 16'(RAY_CYCLES);
      sent = message;
    end else begin
      home = at_home && !nothing;
      side = way;
      out_class = CLASS_BITS'(ANSWERS);
      cycles = shadow ? 16'(VERDICT_CYCLES) : 16'(INTENSITY_CYCLES);
      sent = shadow ? {lit, {(RAY_BITS - VERDICT_BITS) {1'b0}}} : {background, {(RAY_BITS - INTENSITY_BITS) {1'b0}}};
    end
  end
  // A ray's remaining fields go on as they are, and so does what a decision says of its place.
  logic unused;
  assign unused = &{1'b0, ray, shadow_ray, decision, known.beyond, known.depth};
endmodule
