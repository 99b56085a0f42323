// A microprogrammed datapath: one instruction a cycle. While it is idle its registers are read and written from
// outside; `start` begins the program at `entry`, and `busy` holds for as many cycles as it runs.
module datapath #(
    parameter int WORD_BITS = microcode::WORD_BITS,
    parameter int OPERAND_BITS = WORD_BITS + 1,  // words without a sign too
    parameter int REGISTER_BITS = microcode::REGISTER_BITS,
    parameter int ACCUMULATOR_BITS = microcode::ACCUMULATOR_BITS,
    parameter int REGISTERS = microcode::REGISTERS,
    // Memories of its own, in the encoding of all.
    parameter int INSTRUCTIONS = microcode::INSTRUCTIONS,
    parameter int LINES = microcode::LINES,
    parameter PROGRAM_FILE = "programs.hex",
    parameter TABLE_FILE = "tables.hex",
    parameter REGISTER_FILE = ""  // constants; else they are written from outside
) (
    input  logic                                                  clock,
    input  logic                                                  reset,
    input  logic                                                  start,
    input  logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] entry,
    output logic                                                  busy,
    input  logic                                                  write,
    input  logic [microcode::REGISTER_ADDRESS_BITS-1:0]    write_address,
    input  logic signed [REGISTER_BITS-1:0]                       write_value,
    input  logic [microcode::REGISTER_ADDRESS_BITS-1:0]    read_address,
    output logic signed [REGISTER_BITS-1:0]                       read_value
);
  `include "faults.svh"
  localparam int ADDRESS = microcode::REGISTER_ADDRESS_BITS;
  localparam int BIT_NUMBER_BITS = $clog2(REGISTER_BITS);
  localparam int LINE_ADDRESS = microcode::LINE_ADDRESS_BITS;
  localparam int DISTANCE_BITS =
      (microcode::SHIFT_BITS > microcode::NUMBER_BITS ? microcode::SHIFT_BITS : microcode::NUMBER_BITS) + 1;

  // The fields of an instruction.
  logic [microcode::INSTRUCTION_BITS-1:0]         instruction;
  logic [microcode::OPERATION_BITS-1:0]           operation;
  logic [ADDRESS-1:0]                  target, a_number, b_number;
  logic [microcode::INSTRUCTION_ADDRESS_BITS-1:0] jump_target;
  logic [microcode::SHIFT_BITS-1:0]               shift;
  logic [microcode::SHIFT_BITS-2:0]               shift_left;
  logic [microcode::EXTRA_BITS-1:0]               extra;
  logic                                taken;

  assign operation = instruction[microcode::OPERATION_LOW+:microcode::OPERATION_BITS];
  assign target = instruction[microcode::TARGET_LOW+:ADDRESS];
  assign jump_target = instruction[microcode::TARGET_LOW+:microcode::INSTRUCTION_ADDRESS_BITS];
  assign a_number = instruction[microcode::A_LOW+:microcode::A_BITS];
  assign b_number = instruction[microcode::B_LOW+:microcode::B_BITS];
  assign shift = instruction[microcode::SHIFT_LOW+:microcode::SHIFT_BITS];
  assign shift_left = shift[microcode::SHIFT_BITS-2:0];
  assign extra = instruction[microcode::EXTRA_LOW+:microcode::EXTRA_BITS];

  sequencer #(.WORDS(INSTRUCTIONS), .FILE(PROGRAM_FILE)) fetcher (
      .clock(clock), .reset(reset), .start(start), .entry(entry), .taken(taken), .target(jump_target),
      .instruction(instruction), .busy(busy));

  // Registers. An array's register has the number a + the value of b.
  logic signed [REGISTER_BITS-1:0] a, b, result;
  logic        [ADDRESS-1:0]       element, a_address, result_address;
  logic                            has_result, runs_table;
  logic signed [microcode::LINE_BITS-1:0]     line_start, line_rise;

  assign element = a_number + ADDRESS'(b);
  assign a_address = !busy ? read_address : operation == microcode::FETCH ? element
      : operation == microcode::STORE ? target : a_number;
  assign result_address = operation == microcode::STORE ? element : target;
  assign runs_table = busy && operation == microcode::TABLE;
  assign read_value = a;

  register_file #(.REGISTER_BITS(REGISTER_BITS), .REGISTERS(REGISTERS), .ADDRESS_BITS(ADDRESS), .FILE(REGISTER_FILE)) registers (
      .clock(clock), .a_address(a_address), .b_address(b_number), .a(a), .b(b),
      .write(busy ? has_result : write), .write_address(busy ? result_address : write_address),
      .write_value(busy ? result : write_value),
      .write_second(runs_table), .second_address(b_number), .second_value(REGISTER_BITS'(line_rise)));

  // Units.
  logic signed [ACCUMULATOR_BITS-1:0] accumulated;
  logic signed [DISTANCE_BITS-1:0]    distance;
  logic signed [REGISTER_BITS-1:0]    rounded, sum, difference, absolute, low, high, count;
  logic                               less, zero, selected, accumulates;

  assign accumulates = busy && (operation == microcode::LOAD || operation == microcode::ADD_TO ||
      operation == microcode::CLEAR || operation == microcode::MULTIPLY);
  accumulator #(
      .REGISTER_BITS(REGISTER_BITS), .OPERAND_BITS(OPERAND_BITS), .ACCUMULATOR_BITS(ACCUMULATOR_BITS)
  ) products (
      .clock(clock), .enable(accumulates), .afresh(operation == microcode::LOAD || operation == microcode::CLEAR),
      .multiply(operation == microcode::MULTIPLY), .nothing(operation == microcode::CLEAR),
      .negative(instruction[microcode::NEGATIVE_LOW]), .a(a), .b(b),
      .a_part(instruction[microcode::A_PART_LOW+:microcode::A_PART_BITS]),
      .b_part(instruction[microcode::B_PART_LOW+:microcode::B_PART_BITS]),
      .a_last(instruction[microcode::A_LAST_LOW]), .b_last(instruction[microcode::B_LAST_LOW]),
      .shift(shift_left), .value(accumulated));

  // A register may move the rounding to the left.
  assign distance = DISTANCE_BITS'($signed(shift)) -
      (instruction[microcode::BY_LOW] ? DISTANCE_BITS'($signed(b[microcode::NUMBER_BITS-1:0])) : '0);
  rounder #(
      .REGISTER_BITS(REGISTER_BITS), .ACCUMULATOR_BITS(ACCUMULATOR_BITS), .DISTANCE_BITS(DISTANCE_BITS)
  ) rounding (
      .value(accumulated), .distance(distance), .nearest(instruction[microcode::NEAREST_LOW]),
      .bits(extra), .word(rounded));

  adder #(.REGISTER_BITS(REGISTER_BITS)) adding (
      .a(a), .b(b), .sum(sum), .difference(difference), .absolute(absolute), .less(less), .zero(zero));

  bit_unit #(.REGISTER_BITS(REGISTER_BITS)) bits (
      .value(a), .shift(shift_left), .number(BIT_NUMBER_BITS'(b)), .low(low), .high(high),
      .selected(selected), .count(count));

  logic [LINE_ADDRESS-1:0] line;
  assign line = LINE_ADDRESS'(extra) + LINE_ADDRESS'(high) + LINE_ADDRESS'(fault == FIRST + 10);
  table_memory #(.LINES(LINES), .FILE(TABLE_FILE)) tables (
      .address(line),
      .start(line_start), .rise(line_rise));

  always_comb begin
    has_result = 1'b1;
    case (operation)
      microcode::MOVE, microcode::FETCH, microcode::STORE: result = a;
      microcode::ADD: result = sum;
      microcode::SUBTRACT: result = difference;
      microcode::LEAST: result = less ? a : b;
      microcode::MOST: result = less ? b : a;
      microcode::ABSOLUTE: result = absolute;
      microcode::COUNT: result = count;
      microcode::LOW: result = low;
      microcode::HIGH: result = high;
      microcode::BIT: result = REGISTER_BITS'({1'b0, selected});
      microcode::TABLE: result = REGISTER_BITS'(line_start);
      microcode::ROUND: result = rounded;
      default: begin
        result = a;
        has_result = 1'b0;
      end
    endcase
  end

  always_comb
    case (operation)
      microcode::JUMP: taken = 1'b1;
      microcode::JUMP_LESS: taken = less;
      microcode::JUMP_NEGATIVE: taken = a < 0;
      microcode::JUMP_ZERO: taken = zero;
      microcode::JUMP_MINUS: taken = accumulated < 0;
      default: taken = 1'b0;
    endcase
endmodule
