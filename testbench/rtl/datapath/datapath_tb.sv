// Runs every program of programs.txt, in the current folder, over its vectors: all registers before are written,
// all after and the cycles are compared. Prints a line a program, each difference up to a limit, and a sum.
module datapath_tb;
  import microcode::*;
  localparam int NAME_BITS = 8 * 64;
  localparam int MOST_SHOWN = 10;

  logic clock = 0;
  logic reset = 1;
  logic start = 0;
  logic busy;
  logic write = 0;
  logic [INSTRUCTION_ADDRESS_BITS-1:0] entry = 0;
  logic [REGISTER_ADDRESS_BITS-1:0] write_address = 0, read_address = 0;
  logic signed [REGISTER_BITS-1:0] write_value = 0, read_value;

  datapath unit (
      .clock(clock), .reset(reset), .start(start), .entry(entry), .busy(busy), .write(write),
      .write_address(write_address), .write_value(write_value), .read_address(read_address),
      .read_value(read_value));

  always #1 clock = !clock;

  integer list, file, found, program_entry, registers, vectors, vector, i, cycles, cycles_wanted;
  integer differences, shown, wrong, programs, all_vectors, all_cycles, all_differences;
  reg [NAME_BITS-1:0] name;
  reg [NAME_BITS+8*16-1:0] path;
  reg [REGISTER_BITS-1:0] value;

  // Prints the name of a register.
  task print_register(input integer number);
    integer names, at, got, bits, fraction;
    reg [NAME_BITS-1:0] register;
    reg [8*32-1:0] constant;
    begin
      $sformat(path, "%0s.registers.txt", name);
      names = $fopen(path, "r");
      for (at = 0; at <= number; at = at + 1)
        got = $fscanf(names, "%s %d %d %s", register, bits, fraction, constant);
      $fclose(names);
      $write("%0s", register);
    end
  endtask

  task differs;
    begin
      wrong = 1;
      differences = differences + 1;
    end
  endtask

  task run_vector;
    begin
      wrong = 0;
      found = $fscanf(file, "%h", cycles_wanted);
      write = 1;
      for (i = 0; i < registers; i = i + 1) begin
        found = $fscanf(file, "%h", value);
        write_value = value;
        write_address = REGISTER_ADDRESS_BITS'(i);
        @(negedge clock);
      end
      write = 0;
      entry = INSTRUCTION_ADDRESS_BITS'(program_entry);
      start = 1;
      @(negedge clock);
      start = 0;
      cycles = 0;
      while (busy && cycles < cycles_wanted + 1000) begin
        cycles = cycles + 1;
        @(negedge clock);
      end
      if (busy) begin  // it does not end: begin again
        reset = 1;
        @(negedge clock);
        reset = 0;
      end
      all_cycles = all_cycles + cycles;
      if (cycles != cycles_wanted) begin
        if (shown < MOST_SHOWN)
          $display("%0s, vector %0d: cycles is %0d, expected %0d", name, vector, cycles, cycles_wanted);
        shown = shown + 1;
        differs;
      end
      for (i = 0; i < registers; i = i + 1) begin
        found = $fscanf(file, "%h", value);
        read_address = REGISTER_ADDRESS_BITS'(i);
        @(posedge clock);
        if (read_value !== value) begin
          if (shown < MOST_SHOWN) begin
            $write("%0s, vector %0d: ", name, vector);
            print_register(i);
            $display(" is %h, expected %h", read_value, value);
          end
          shown = shown + 1;
          differs;
        end
        @(negedge clock);
      end
      if (found != 1) begin
        $display("%0s.vectors.hex: ends in vector %0d, expected %0d vectors", name, vector, vectors);
        $finish;
      end
    end
  endtask

  initial begin
    programs = 0;
    all_vectors = 0;
    all_cycles = 0;
    all_differences = 0;
    repeat (2) @(negedge clock);
    reset = 0;
    list = $fopen("programs.txt", "r");
    if (list == 0) begin
      $display("programs.txt: not found, expected what microcode_tb --export wrote in the current folder");
      $finish;
    end
    while ($fscanf(list, "%s %d %d %d", name, program_entry, registers, vectors) == 4) begin
      $sformat(path, "%0s.vectors.hex", name);
      file = $fopen(path, "r");
      differences = 0;
      shown = 0;
      for (vector = 0; vector < vectors; vector = vector + 1) run_vector;
      $fclose(file);
      $display("%0s: %0d vectors, %0d differences", name, vectors, differences);
      programs = programs + 1;
      all_vectors = all_vectors + vectors;
      all_differences = all_differences + differences;
    end
    $display("words of %0d bits: %0d programs, %0d vectors, %0d cycles, %0d differences", WORD_BITS, programs,
        all_vectors, all_cycles, all_differences);
    $finish;
  end
endmodule
