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
  logic shadow, at_home, short;
  logic [1:0] way;
  intensity_t background;
  verdict_t verdict;

  always_comb begin
    ray = message;
    shadow_ray = message[RAY_BITS-1-:SHADOW_RAY_BITS];  // a shorter message stands in the upper bits
    shadow = ray.message_type == TYPE_SHADOW_RAY;
    background.message_type = TYPE_INTENSITY;
    background.red = known.red;
    background.green = known.green;
    background.blue = known.blue;
    background.home_x = ray.home_x;
    background.home_y = ray.home_y;
    background.slot = ray.slot;
    background.child = ray.child;
    verdict.message_type = !shadow ? TYPE_POSTPONED : decision.blocked ? TYPE_BLOCKED : TYPE_LIT;
    verdict.home_x = shadow ? shadow_ray.home_x : ray.home_x;
    verdict.home_y = shadow ? shadow_ray.home_y : ray.home_y;
    verdict.slot = shadow ? shadow_ray.slot : ray.slot;
    verdict.child = shadow ? shadow_ray.child : ray.child;
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
    short = 1'b0;
    if (decision.need == NEED_OUTPUT) begin
      home = 1'b0;
      side = decision.side;
      out_class = CLASS_BITS'({CLASS_BY_DY && ray.dy[WORD-1], CLASS_BY_DX && ray.dx[WORD-1]});
      cycles = shadow ? 16'(SHADOW_RAY_CYCLES) : 16'(RAY_CYCLES);
      sent = message;
    end else begin
      home = at_home && !nothing;
      side = way;
      out_class = CLASS_BITS'(ANSWERS);
      short = shadow || decision.need == NEED_SLOT;  // a hit that finds no slot is postponed
      cycles = short ? 16'(VERDICT_CYCLES) : 16'(INTENSITY_CYCLES);
      sent = short ? {verdict, {(RAY_BITS - VERDICT_BITS) {1'b0}}} : {background, {(RAY_BITS - INTENSITY_BITS) {1'b0}}};
    end
  end
  // A ray's remaining fields go on as they are, and so does what a decision says of its place.
  logic unused;
  assign unused = &{1'b0, ray, shadow_ray, decision, known.beyond, known.depth, known.sources};
endmodule
