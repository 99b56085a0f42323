// What a cell keeps of the viewer's message: which faces have something behind them, the cube's depth, the
// background.
module viewer_latch
  import raycell_pkg::*;
  import raycell_numbers::*;
  import raycell_cell::*;
(
    input  logic clock,
    input  logic reset,
    input  logic latch,
    input  setup_t viewer,
    output known_t known
);
  // The depth is a whole number of levels, each a mantissa of 16 bits and an exponent.
  acc_t levels, height;
  always_comb begin
    levels = acc_t'({1'b0, viewer.levels}) + 1;
    height = levels * acc_t'({1'b0, viewer.level});
  end

  always_ff @(posedge clock) begin
    if (reset) begin
      known <= '0;
    end else if (latch) begin
      known.beyond <= {
        viewer.beyond_left, viewer.beyond_right, viewer.beyond_top,
        viewer.beyond_bottom, viewer.beyond_front, viewer.beyond_back
      };
      known.depth <= DEPTH_BITS'(hold(height, LEVEL_MANTISSA_BITS - 1 - DEPTH_F - int'($signed(viewer.level_exponent)),
                                      DEPTH_BITS));
      known.red <= viewer.red;
      known.green <= viewer.green;
      known.blue <= viewer.blue;
      known.sources <= viewer.sources;
    end
  end
endmodule
