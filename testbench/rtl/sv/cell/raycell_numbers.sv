// Numbers of the cell: rounding, saturation, reciprocal, 1/sqrt. Values are integers in units of their last
// bit; sums and products are exact, and hold() is the only place that rounds and saturates.
package raycell_numbers;
  import raycell_pkg::*;

  // Errors that can be put in on purpose, to see that the vectors find them. A cell that is built without
  // RTL_FAULTS has none of them.
  localparam int FAULT_ROUNDING = 1;
  localparam int FAULT_TIE = 2;
  localparam int FAULT_CREDIT = 3;
  localparam int FAULT_AGE = 4;
  localparam int FAULT_ORDER = 5;
  localparam int FAULT_TURN = 6;
  localparam int FAULT_ROUTE = 7;
  localparam int FAULT_LEAVING = 8;
  localparam int FAULT_WIRES = 9;
  localparam int FAULT_BACK_OFF = 10;
  // Of a cell with voxels, which has those above, too, that are not the walk's.
  /* verilator lint_off UNUSEDPARAM */
  localparam int FAULT_RESERVED = 11;  // no slots are kept for the generations
  localparam int FAULT_WAITS = 12;  // a hit that finds no slot waits for one
  localparam int FAULT_STACK = 13;  // slots that were never used go before those that became free
  localparam int FAULT_EQUALS = 14;  // of equal ages the higher place goes first
  localparam int FAULT_YOUNGEST = 15;  // the hit accepted last is shaded first
  localparam int FAULT_CHILD = 16;  // a hit's children swap their numbers
  localparam int FAULT_OFFSET = 17;  // a span's offset is advanced in the wrong direction
  localparam int FAULT_LEFT = 18;  // a child hits the polygon that it leaves
  localparam int FAULT_RETRY = 19;  // a postponed child is sent again at once
  localparam int FAULT_LAST_VERDICT = 20;  // the verdict that completes a slot is lost
  localparam int FAULT_DATAPATH = 20;  // those of the datapath come behind it: 21 to 30
  /* verilator lint_on UNUSEDPARAM */
`ifdef RTL_FAULTS
  int fault  /*verilator public_flat_rw*/ = 0;
`else
  localparam int fault = 0;
`endif

  typedef logic signed [raycell_pkg::ACC-1:0] acc_t;  // as wide as the widest product

  // value * 2^(exponent - WORD + 1)
  typedef struct packed {
    logic [raycell_pkg::WORD-1:0] mantissa;
    logic signed [7:0] exponent;
  } floating_t;

  localparam acc_t ONE = acc_t'(1) <<< UNIT_F;
  localparam int MF = WORD - 1;  // fraction bits of a mantissa

  // v / 2^drop as an integer: to the nearest, ties to even, or towards minus infinity.
  function automatic acc_t round_off(input acc_t v, input int drop);
    acc_t word, rest, half;
    if (drop <= 0) begin
      word = v <<< -drop;
    end else begin
      word = v >>> drop;
      rest = v - (word <<< drop);
      half = acc_t'(1) <<< (drop - 1);
      if (ROUND_NEAREST && (rest > half || (rest == half && ((word & 1) != 0 || fault == FAULT_ROUNDING))))
        word = word + 1;
    end
    round_off = word;
  endfunction

  function automatic acc_t saturate(input acc_t v, input int bits);
    acc_t most, word;
    most = (acc_t'(1) <<< (bits - 1)) - 1;
    word = v;
    if (v > most) word = most;
    else if (v < -most - 1) word = -most - 1;
    saturate = word;
  endfunction

  function automatic acc_t hold(input acc_t v, input int drop, input int bits);
    hold = saturate(round_off(v, drop), bits);
  endfunction

  function automatic acc_t clamp_to_cell(input acc_t v);
    clamp_to_cell = v < 0 ? '0 : v > ONE ? ONE : v;
  endfunction

  function automatic acc_t magnitude(input acc_t v);
    magnitude = v < 0 ? -v : v;
  endfunction

  // Bits of v >= 0 up to its leading one.
  function automatic int bit_length(input acc_t v);
    acc_t rest;
    int length;
    rest = v;
    length = 0;
    for (int step = 64; step > 0; step = step / 2)
      if (step < ACC && (rest >>> step) != 0) begin
        rest = rest >>> step;
        length = length + step;
      end
    bit_length = rest == 0 ? 0 : length + 1;
  endfunction

  // A line between two words of a table, at `rest` of 2^rest_bits.
  function automatic acc_t on_line(input acc_t start, input acc_t last, input acc_t rest, input int rest_bits);
    on_line = round_off((start <<< rest_bits) + (last - start) * rest, rest_bits);
  endfunction

  // m: 2^MF to 2^(MF + 1) - 1, for 1 to 2; the result is 2^(MF - 1) to 2^MF.
  function automatic acc_t reciprocal_mantissa(input acc_t m);
    acc_t argument, line, r, correction;
    argument = m - (acc_t'(1) <<< MF);
    line = argument >>> RECIPROCAL_REST_BITS;
    r = on_line(acc_t'(RECIPROCAL_WORDS[int'(line)*WORD+:WORD]), acc_t'(RECIPROCAL_WORDS[(int'(line)+1)*WORD+:WORD]),
                argument - (line <<< RECIPROCAL_REST_BITS), RECIPROCAL_REST_BITS);
    if (RECIPROCAL_NEWTON) begin
      correction = round_off((acc_t'(2) <<< (2 * MF)) - m * r, MF);
      r = round_off(r * correction, MF);
    end
    reciprocal_mantissa = r;
  endfunction

  // 1 / |x| of a word x != 0 of the format unit, a floating_t. Such a word never has to be rounded to a mantissa.
  function automatic logic [WORD+7:0] reciprocal(input acc_t x);
    acc_t size;
    int length;
    size = magnitude(x);
    length = bit_length(size);
    reciprocal = {WORD'(reciprocal_mantissa(size <<< (WORD - length))), 8'(UNIT_F + 1 - length)};
  endfunction

  // m: 2^(MF - 1) to 2^(MF + 1) - 1, for 1 to 4.
  function automatic acc_t root_mantissa(input acc_t m);
    acc_t argument, line, r, correction, root;
    if (m[MF]) begin
      argument = m - (acc_t'(1) <<< MF);
      line = argument >>> ROOT_2_REST_BITS;
      r = on_line(acc_t'(ROOT_2_WORDS[int'(line)*WORD+:WORD]), acc_t'(ROOT_2_WORDS[(int'(line)+1)*WORD+:WORD]),
                  argument - (line <<< ROOT_2_REST_BITS), ROOT_2_REST_BITS);
    end else begin
      argument = m - (acc_t'(1) <<< (MF - 1));
      line = argument >>> ROOT_1_REST_BITS;
      r = on_line(acc_t'(ROOT_1_WORDS[int'(line)*WORD+:WORD]), acc_t'(ROOT_1_WORDS[(int'(line)+1)*WORD+:WORD]),
                  argument - (line <<< ROOT_1_REST_BITS), ROOT_1_REST_BITS);
    end
    if (ROOT_NEWTON) begin
      root = round_off(m * r, MF - 1);
      correction = round_off((acc_t'(3) <<< (2 * MF)) - root * r, MF + 1);
      r = round_off(r * correction, MF);
    end
    root_mantissa = r;
  endfunction

  // 1 / sqrt(x) of a word x > 0 of the format field, a floating_t.
  function automatic logic [WORD+7:0] inverse_root(input acc_t x);
    int exponent, odd, half;
    acc_t m;
    exponent = bit_length(x) - 1 - FIELD_F;
    odd = exponent & 1;
    half = (exponent - odd) >>> 1;
    m = round_off(x, bit_length(x) - 1 - (MF - 1) - odd);
    if (m[MF+1]) begin  // rounded up to 4
      m = m >>> 2;
      half = half + 1;
    end
    half = -half;
    inverse_root = {WORD'(root_mantissa(m)), 8'(half)};
  endfunction
endpackage
