// A microprogrammed datapath: one instruction a cycle. While it is idle its registers are read and written from
// outside; `start` begins the program at `entry`, and `busy` holds for as many cycles as it runs.
module datapath #(
    parameter int WORD_BITS = datapath_package::WORD_BITS,
    parameter int OPERAND_BITS = WORD_BITS + 1,  // words without a sign too
    parameter int REGISTER_BITS = datapath_package::REGISTER_BITS,
    parameter int ACCUMULATOR_BITS = datapath_package::ACCUMULATOR_BITS,
    parameter int REGISTERS = datapath_package::REGISTERS
) (
    input  logic                                                  clock,
    input  logic                                                  reset,
    input  logic                                                  start,
    input  logic [datapath_package::INSTRUCTION_ADDRESS_BITS-1:0] entry,
    output logic                                                  busy,
    input  logic                                                  write,
    input  logic [datapath_package::REGISTER_ADDRESS_BITS-1:0]    write_address,
    input  logic signed [REGISTER_BITS-1:0]                       write_value,
    input  logic [datapath_package::REGISTER_ADDRESS_BITS-1:0]    read_address,
    output logic signed [REGISTER_BITS-1:0]                       read_value
);
  import datapath_package::*;
  `include "faults.svh"
  localparam int ADDRESS = REGISTER_ADDRESS_BITS;
  localparam int DISTANCE_BITS = (SHIFT_BITS > NUMBER_BITS ? SHIFT_BITS : NUMBER_BITS) + 1;

  // The fields of an instruction.
  logic [INSTRUCTION_BITS-1:0]         instruction;
  logic [OPERATION_BITS-1:0]           operation;
  logic [ADDRESS-1:0]                  target, a_number, b_number;
  logic [INSTRUCTION_ADDRESS_BITS-1:0] jump_target;
  logic [SHIFT_BITS-1:0]               shift;
  logic [SHIFT_BITS-2:0]               shift_left;
  logic [EXTRA_BITS-1:0]               extra;
  logic                                taken;

  assign operation = instruction[OPERATION_LOW+:OPERATION_BITS];
  assign target = instruction[TARGET_LOW+:ADDRESS];
  assign jump_target = instruction[TARGET_LOW+:INSTRUCTION_ADDRESS_BITS];
  assign a_number = instruction[A_LOW+:A_BITS];
  assign b_number = instruction[B_LOW+:B_BITS];
  assign shift = instruction[SHIFT_LOW+:SHIFT_BITS];
  assign shift_left = shift[SHIFT_BITS-2:0];
  assign extra = instruction[EXTRA_LOW+:EXTRA_BITS];

  sequencer fetcher (
      .clock(clock), .reset(reset), .start(start), .entry(entry), .taken(taken), .target(jump_target),
      .instruction(instruction), .busy(busy));

  // Registers. An array's register has the number a + the value of b.
  logic signed [REGISTER_BITS-1:0] a, b, result;
  logic        [ADDRESS-1:0]       element, a_address, result_address;
  logic                            has_result, runs_table;
  logic signed [LINE_BITS-1:0]     line_start, line_rise;

  assign element = a_number + ADDRESS'(b);
  assign a_address = !busy ? read_address : operation == FETCH ? element : operation == STORE ? target : a_number;
  assign result_address = operation == STORE ? element : target;
  assign runs_table = busy && operation == TABLE;
  assign read_value = a;

  register_file #(.REGISTER_BITS(REGISTER_BITS), .REGISTERS(REGISTERS), .ADDRESS_BITS(ADDRESS)) registers (
      .clock(clock), .a_address(a_address), .b_address(b_number), .a(a), .b(b),
      .write(busy ? has_result : write), .write_address(busy ? result_address : write_address),
      .write_value(busy ? result : write_value),
      .write_second(runs_table), .second_address(b_number), .second_value(REGISTER_BITS'(line_rise)));

  // Units.
  logic signed [ACCUMULATOR_BITS-1:0] accumulated;
  logic signed [DISTANCE_BITS-1:0]    distance;
  logic signed [REGISTER_BITS-1:0]    rounded, sum, difference, absolute, low, high, count;
  logic                               less, zero, selected, accumulates;

  assign accumulates = busy && (operation == LOAD || operation == ADD_TO || operation == CLEAR || operation == MULTIPLY);
  accumulator #(
      .REGISTER_BITS(REGISTER_BITS), .OPERAND_BITS(OPERAND_BITS), .ACCUMULATOR_BITS(ACCUMULATOR_BITS)
  ) products (
      .clock(clock), .enable(accumulates), .afresh(operation == LOAD || operation == CLEAR),
      .multiply(operation == MULTIPLY), .nothing(operation == CLEAR),
      .negative(instruction[NEGATIVE_LOW]), .a(a), .b(b),
      .a_part(instruction[A_PART_LOW+:A_PART_BITS]), .b_part(instruction[B_PART_LOW+:B_PART_BITS]),
      .a_last(instruction[A_LAST_LOW]), .b_last(instruction[B_LAST_LOW]), .shift(shift_left),
      .value(accumulated));

  // A register may move the rounding to the left.
  assign distance = DISTANCE_BITS'($signed(shift)) -
      (instruction[BY_LOW] ? DISTANCE_BITS'($signed(b[NUMBER_BITS-1:0])) : '0);
  rounder #(
      .REGISTER_BITS(REGISTER_BITS), .ACCUMULATOR_BITS(ACCUMULATOR_BITS), .DISTANCE_BITS(DISTANCE_BITS)
  ) rounding (
      .value(accumulated), .distance(distance), .nearest(instruction[NEAREST_LOW]), .bits(extra), .word(rounded));

  adder #(.REGISTER_BITS(REGISTER_BITS)) adding (
      .a(a), .b(b), .sum(sum), .difference(difference), .absolute(absolute), .less(less), .zero(zero));

  bit_unit #(.REGISTER_BITS(REGISTER_BITS)) bits (
      .value(a), .shift(shift_left), .number($clog2(REGISTER_BITS)'(b)), .low(low), .high(high),
      .selected(selected), .count(count));

  table_memory tables (
      .address(LINE_ADDRESS_BITS'(extra) + LINE_ADDRESS_BITS'(high) + LINE_ADDRESS_BITS'(fault == 10)),
      .start(line_start), .rise(line_rise));

  always_comb begin
    has_result = 1'b1;
    case (operation)
      MOVE, FETCH, STORE: result = a;
      ADD: result = sum;
      SUBTRACT: result = difference;
      LEAST: result = less ? a : b;
      MOST: result = less ? b : a;
      ABSOLUTE: result = absolute;
      COUNT: result = count;
      LOW: result = low;
      HIGH: result = high;
      BIT: result = REGISTER_BITS'({1'b0, selected});
      TABLE: result = REGISTER_BITS'(line_start);
      ROUND: result = rounded;
      default: begin
        result = a;
        has_result = 1'b0;
      end
    endcase
  end

  always_comb
    case (operation)
      JUMP: taken = 1'b1;
      JUMP_LESS: taken = less;
      JUMP_NEGATIVE: taken = a < 0;
      JUMP_ZERO: taken = zero;
      JUMP_MINUS: taken = accumulated < 0;
      default: taken = 1'b0;
    endcase
endmodule
