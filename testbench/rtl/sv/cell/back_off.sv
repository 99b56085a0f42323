// How long a postponed ray waits, and when a primary ray starts for the first time: a hash of the run's seed,
// the ray and the number of the attempt, as the model draws it. Another cell may hash from any source.
module back_off
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  id_t ray,
    input  logic [7:0] attempt,
    output logic [63:0] cycles,
    output logic [63:0] first_start
);
  localparam logic [63:0] FIRST = 64'd251;  // no attempt has this number

  function automatic logic [63:0] drawn(input logic [63:0] who, input logic [63:0] number);
    logic [63:0] h;
    h = (SEED * 64'h9e3779b97f4a7c15) ^ (who * 64'hbf58476d1ce4e5b9) ^ (number * 64'h94d049bb133111eb);
    h = h ^ (h >> 31);
    h = h * 64'h7fb5d329728ea185;
    drawn = h ^ (h >> 27);
  endfunction

  logic [63:0] hash, low;
  logic [2:0] doublings;
  localparam logic [63:0] BASE = 64'(COST_BACKOFF);
  localparam logic [63:0] WITHIN = START_WITHIN == 0 ? 64'd1 : START_WITHIN;
  always_comb begin
    doublings = fault == FAULT_BACK_OFF ? 3'd0 : attempt > 8'd6 ? 3'd6 : attempt[2:0];
    hash = drawn(ray, 64'(attempt));
    // Modulo a constant times a power of two.
    low = hash & ((64'd1 << doublings) - 64'd1);
    cycles = (BASE << doublings) + ((((hash >> doublings) % BASE) << doublings) | low);
    first_start = drawn(ray, FIRST) % WITHIN;
  end
endmodule
