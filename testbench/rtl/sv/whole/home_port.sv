// What comes home in a cycle: a hit takes the port for its slot, an answer for its own or for the pixel.
module home_port
  import raycell_pkg::*;
  import raycell_whole::*;
(
    input  logic [ALL_PLACES-1:0] hit_wins,  // one at most
    input  logic wins,
    input  logic [INTENSITY_BITS-1:0] answer,  // of the winner, unless that is a hit
    output logic accept,
    output logic [ALL_INDEX_BITS-1:0] accepted,  // where the hit stands
    output logic to_slot,
    output logic to_pixel,
    output logic child_postponed
);
  intensity_t intensity;
  verdict_t verdict;
  logic of_pixel;
  always_comb begin
    accept = hit_wins != '0;
    accepted = '0;
    for (int p = 0; p < ALL_PLACES; p++) if (hit_wins[p]) accepted = ALL_INDEX_BITS'(p);
    intensity = intensity_t'(answer);
    verdict = verdict_t'(answer[INTENSITY_BITS-1-:VERDICT_BITS]);
    // A primary ray's slot is all ones.
    of_pixel = intensity.message_type == TYPE_INTENSITY ? &intensity.slot
        : verdict.message_type == TYPE_POSTPONED && &verdict.slot;
    to_pixel = wins && !accept && of_pixel;
    to_slot = wins && !accept && !of_pixel;
    child_postponed = to_slot && verdict.message_type == TYPE_POSTPONED;
  end
  logic unused;
  assign unused = &{1'b0, intensity, verdict};
endmodule
