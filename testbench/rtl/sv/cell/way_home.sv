// The way of an answer: along x first, then along y.
module way_home
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  logic [X_BITS-1:0] x,
    input  logic [Y_BITS-1:0] y,
    input  logic [X_BITS-1:0] home_x,
    input  logic [Y_BITS-1:0] home_y,
    output logic home,
    output logic [1:0] side
);
  logic along_y;
  assign along_y = home_x == x || (fault == FAULT_ROUTE && home_y != y);
  assign home = home_x == x && home_y == y;
  assign side = along_y ? (home_y > y ? 2'(SOUTH) : 2'(NORTH)) : (home_x > x ? 2'(EAST) : 2'(WEST));
endmodule
