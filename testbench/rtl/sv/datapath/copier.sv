// Calls of microprograms: values are copied into registers, one a cycle, the program runs, and registers are
// copied back, if any are. `done` holds in the last cycle of a call.
module copier #(
    parameter int COPIES = 1,
    parameter int COPY = 1,  // bits of a copy's number
    parameter int CALLS = 1,
    parameter int CALL = 1,
    parameter int SPACE = 2,
    parameter int FROM = 1,
    parameter int TO_SPACE = 1,
    parameter int TO = 1,
    parameter int ENTRY = microcode::INSTRUCTION_ADDRESS_BITS,
    parameter COPY_FILE = "copies.hex",
    parameter CALL_FILE = "calls.hex"
) (
    input  logic                clock,
    input  logic                reset,
    input  logic                start,
    input  logic [CALL-1:0]     call,
    output logic                done,
    output logic                copying,
    // What is copied: `from` of a space, to `to` of another, where 0 are the registers.
    output logic [SPACE-1:0]    space,
    output logic [FROM-1:0]     from,
    output logic [TO_SPACE-1:0] to_space,
    output logic [TO-1:0]       to,
    // The datapath.
    output logic                run,
    output logic [ENTRY-1:0]    entry,
    input  logic                busy
);
  localparam int COPY_WORD = SPACE + FROM + TO_SPACE + TO;
  localparam logic [1:0] IDLE = 2'd0, LOAD = 2'd1, RUN = 2'd2, STORE = 2'd3;

  logic [COPY_WORD-1:0]    copies[0:COPIES-1];
  logic [3*COPY+ENTRY-1:0] calls [0:CALLS-1];
  initial $readmemh(COPY_FILE, copies);
  initial $readmemh(CALL_FILE, calls);

  logic [1:0]      state;
  logic [COPY-1:0] place, first, middle, past, middle_held, past_held;
  logic            last, none_left;

  assign first = calls[call][2*COPY+ENTRY+:COPY];
  assign middle = calls[call][COPY+ENTRY+:COPY];
  assign past = calls[call][ENTRY+:COPY];
  assign {space, from, to_space, to} = copies[place];
  assign copying = state == LOAD || state == STORE;
  assign last = place + 1'b1 == (state == LOAD ? middle_held : past_held);
  assign none_left = place == past_held;
  assign run = state == LOAD && last;
  assign done = (state == STORE && last) || (state == RUN && !busy && none_left);

  always_ff @(posedge clock)
    if (reset) begin
      state <= IDLE;
    end else begin
      case (state)
        IDLE:
          if (start) begin
            state <= LOAD;
            place <= first;
            middle_held <= middle;
            past_held <= past;
            entry <= calls[call][ENTRY-1:0];
          end
        LOAD: begin
          place <= place + 1'b1;
          if (last) state <= RUN;
        end
        RUN: if (!busy) state <= none_left ? IDLE : STORE;
        default: begin
          place <= place + 1'b1;
          if (last) state <= IDLE;
        end
      endcase
    end
endmodule
