// Fetches the script of loading: a step a cycle, or a word of a step a cycle where it works on several; a call as
// long as it runs. After a reset the unit forgets what it has loaded.
module load_sequencer (
    input  logic                               clock,
    input  logic                               reset,
    input  logic                               start,      // with a message
    input  logic                               finish,     // write out
    output logic                               busy,
    output logic                               stepping,
    output logic        [load::OP_BITS-1:0]    op,
    output logic        [load::FIELD_BITS-1:0] a,          // fields, those of a block counted on
    output logic        [load::FIELD_BITS-1:0] b,
    output logic        [load::FIELD_BITS-1:0] c,
    output logic signed [load::VALUE_BITS-1:0] value,
    output logic        [load::COUNT_BITS-1:0] index,
    input  logic                               holds,      // what a jump asks for
    input  logic                               call_done
);
  localparam int FIELD = load::FIELD_BITS;
  localparam int ADDRESS = load::STEP_ADDRESS_BITS;
  localparam int STEP = load::OP_BITS + 3 * FIELD + load::VALUE_BITS;
  localparam logic [1:0] IDLE = 2'd0, RUN = 2'd1, CALLS = 2'd2;

  logic [STEP-1:0] script[0:load::STEPS-1];
  initial $readmemh("load_script.hex", script);

  logic [1:0]                  state;
  logic [ADDRESS-1:0]          place, next;
  logic [FIELD-1:0]            first_a, first_b, first_c, counted;
  logic [load::COUNT_BITS-1:0] count;
  logic                        last;

  assign {op, first_a, first_b, first_c, value} = script[place];
  assign busy = state != IDLE;
  assign stepping = state == RUN;
  assign counted = FIELD'(index);
  assign a = first_a + counted;
  assign b = first_b + (op == load::DO_COPY || op == load::DO_WRITE || op == load::DO_SEND ? counted : '0);
  assign c = first_c + (op == load::DO_PUT ? counted : '0);
  assign count = value[load::COUNT_BITS-1:0];
  assign last = op < load::DO_COPY || op > load::DO_SEND || index + 1'b1 == count;
  assign next = holds ? ADDRESS'(value) : place + 1'b1;

  always_ff @(posedge clock)
    if (reset) begin
      state <= RUN;
      place <= ADDRESS'(load::ENTRY_BEGIN);
      index <= '0;
    end else begin
      case (state)
        IDLE:
          if (start || finish) begin
            state <= RUN;
            place <= start ? ADDRESS'(load::ENTRY_MESSAGE) : ADDRESS'(load::ENTRY_FINISH);
          end
        RUN: begin
          index <= last ? '0 : index + 1'b1;
          if (last) place <= next;
          if (op == load::DO_END || op == load::DO_FAIL) state <= IDLE;
          if (op == load::DO_CALL) state <= CALLS;
        end
        default: if (call_done) state <= RUN;
      endcase
    end
endmodule
