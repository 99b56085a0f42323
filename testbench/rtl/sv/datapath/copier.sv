// Calls of microprograms: values are copied into registers, one a cycle, the program runs, and registers are
// copied back. `done` holds in the last cycle of a call.
module copier (
    input  logic                                           clock,
    input  logic                                           reset,
    input  logic                                           start,
    input  logic [visit::CALL_BITS-1:0]                    call,
    output logic                                           done,
    output logic                                           copying,
    // What is copied: `from` of a space, to a register or a field.
    output logic [1:0]                                     space,
    output logic [visit::SOURCE_BITS-1:0]                  from,
    output logic                                           to_field,
    output logic [visit::TO_BITS-1:0]                      to,
    // The datapath.
    output logic                                           run,
    output logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] entry,
    input  logic                                           busy
);
  localparam int COPY = visit::COPY_BITS;
  localparam int ENTRY = microcode::INSTRUCTION_ADDRESS_BITS;
  localparam int COPY_WORD = 2 + visit::SOURCE_BITS + 1 + visit::TO_BITS;
  localparam logic [1:0] IDLE = 2'd0, LOAD = 2'd1, RUN = 2'd2, STORE = 2'd3;

  logic [COPY_WORD-1:0]    copies[0:visit::COPIES-1];
  logic [3*COPY+ENTRY-1:0] calls [0:visit::CALLS-1];
  initial $readmemh("copies.hex", copies);
  initial $readmemh("calls.hex", calls);

  logic [1:0]      state;
  logic [COPY-1:0] place, first, middle, past, middle_held, past_held;
  logic            last;

  assign first = calls[call][2*COPY+ENTRY+:COPY];
  assign middle = calls[call][COPY+ENTRY+:COPY];
  assign past = calls[call][ENTRY+:COPY];
  assign {space, from, to_field, to} = copies[place];
  assign copying = state == LOAD || state == STORE;
  assign last = place + 1'b1 == (state == LOAD ? middle_held : past_held);
  assign run = state == LOAD && last;
  assign done = state == STORE && last;

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
        RUN: if (!busy) state <= STORE;
        default: begin
          place <= place + 1'b1;
          if (last) state <= IDLE;
        end
      endcase
    end
endmodule
