// The order of a job's calls: a script of steps, one a cycle but for calls. The cost table's cycles of the steps that
// are taken are added up.
module shading_script #(
    parameter int BITS = microcode::REGISTER_BITS,
    parameter int SOURCES = shade::SOURCES_MOST,
    parameter int LIGHT = shade::LIGHT_BITS,
    parameter int CHILD = shade::CHILD_BITS,
    parameter int CALL = shade::CALL_BITS,
    parameter int CHARGE = shade::CHARGE_BITS,
    parameter int OUT = $clog2(shade::OUTS)
) (
    input  logic                     clock,
    input  logic                     reset,
    input  logic                     start,
    input  logic                     shades,  // begins with the intensity, not with the set-up
    input  logic                     goes_on, // from the set-up to the intensity
    input  logic       [LIGHT-1:0]   lights,  // how many sources there are
    input  logic       [SOURCES-1:0] lit,
    output logic                     busy,
    output logic                     call_start,
    output logic       [CALL-1:0]    call,
    input  logic                     call_done,
    output logic       [LIGHT-1:0]   light,
    // The output word that a step asks about.
    output logic       [OUT-1:0]     asked,
    input  logic signed [BITS-1:0]   answer,
    output logic                     emits,
    output logic       [CHILD-1:0]   child,
    output logic       [SOURCES-1:0] facing,
    output logic       [CHARGE-1:0]  charge
);
  localparam int STEP = shade::STEP_BITS;
  localparam int ARGUMENT = shade::ARGUMENT_BITS;
  localparam int STEP_CHARGE = shade::STEP_CHARGE_BITS;
  localparam int WORD = 4 + ARGUMENT + STEP + STEP_CHARGE;

  logic [WORD-1:0] steps[0:shade::STEPS-1];
  initial $readmemh("shading_script.hex", steps);

  logic [STEP-1:0]        place, target;
  logic [3:0]             operation;
  logic [ARGUMENT-1:0]    argument;
  logic [STEP_CHARGE-1:0] step_charge;
  logic                   waits, taken, ends, steps_now;
  logic [SOURCES-1:0]     here;

  assign {operation, argument, target, step_charge} = steps[place];
  assign steps_now = busy && !waits;
  assign call_start = steps_now && operation == 4'(shade::STEP_CALL);
  assign call = CALL'(argument);
  assign asked = OUT'(argument);
  assign emits = steps_now && (operation == 4'(shade::STEP_EMIT) || operation == 4'(shade::STEP_EMIT_LIGHT));
  assign child = operation == 4'(shade::STEP_EMIT) ? CHILD'(argument) : CHILD'(light);
  assign here = SOURCES'(1) << light;
  assign ends = operation == 4'(shade::STEP_END) || (operation == 4'(shade::STEP_END_OF_SETUP) && !goes_on);

  always_comb
    case (operation)
      4'(shade::STEP_IF_LIGHT): taken = light == lights;
      4'(shade::STEP_IF_LIT): taken = (lit & here) == 0;
      4'(shade::STEP_IF_ANY): taken = lit == 0;
      4'(shade::STEP_IF_POSITIVE): taken = answer <= 0;
      4'(shade::STEP_NEXT), 4'(shade::STEP_JUMP): taken = 1'b1;
      default: taken = 1'b0;
    endcase

  always_ff @(posedge clock)
    if (reset) begin
      busy <= 1'b0;
    end else if (start && !busy) begin
      busy <= 1'b1;
      waits <= 1'b0;
      place <= shades ? STEP'(shade::SHADE_ENTRY) : '0;
      facing <= '0;
      charge <= '0;
    end else if (steps_now) begin
      waits <= call_start;
      place <= taken ? target : place + 1'b1;
      charge <= charge + CHARGE'(step_charge);
      if (ends) busy <= 1'b0;
      if (operation == 4'(shade::STEP_FIRST_LIGHT)) light <= '0;
      if (operation == 4'(shade::STEP_NEXT)) light <= light + 1'b1;
      if (operation == 4'(shade::STEP_FACES)) facing <= facing | here;
    end else if (call_done) begin
      waits <= 1'b0;
    end
endmodule
