// Which generations of hits find a slot: each that may wait keeps one, and the rest is free for all.
module group_room
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_whole::*;
(
    input  logic [RAY_STORE-1:0] used,
    input  logic [RAY_STORE-1:0][5:0] generation,  // of the hits in the slots
    output logic [SLOT_GROUPS-1:0] room
);
  localparam int COUNT = $clog2(RAY_STORE + 1);
  logic [COUNT-1:0] all, borrowed;
  logic [SLOT_GROUPS-1:0][COUNT-1:0] used_by;
  always_comb begin
    all = '0;
    borrowed = '0;
    used_by = '0;
    for (int i = 0; i < RAY_STORE; i++)
      if (used[i]) begin
        all = all + 1'b1;
        used_by[group_of(generation[i])] = used_by[group_of(generation[i])] + 1'b1;
      end
    for (int g = 0; g < SLOT_GROUPS; g++) if (used_by[g] > 1) borrowed = borrowed + used_by[g] - 1'b1;
    for (int g = 0; g < SLOT_GROUPS; g++)
      room[g] = int'(all) < RAY_STORE && (fault == FAULT_RESERVED || used_by[g] == '0 || int'(borrowed) < RAY_STORE - SLOT_GROUPS);
  end
endmodule
