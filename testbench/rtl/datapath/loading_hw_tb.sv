// Drives the loading unit with the load messages of recorded cells (cell_tb --hardware): what became of each span, the
// message that goes on, the cycles, and all words written out at the end are compared.
module loading_hw_tb
  import raycell_pkg::*;
;
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int MOST_SHOWN = 10;
  localparam int MOST_CYCLES = 1000000;

  logic clock = 0;
  logic reset = 1;
  logic register_write = 0, start = 0, finish = 0;
  logic busy, done, failed, made, ends, store_write, memory_write, stepping, computing, copying;
  logic [microcode::REGISTER_ADDRESS_BITS-1:0] register_address = 0;
  logic signed [BITS-1:0] word = 0;
  logic [X_BITS-1:0] column = 0;
  logic [MESSAGE_BITS-1:0] message = 0;
  logic [MESSAGE_BITS-1:0] advanced;
  logic [load::MEMORY_BITS-1:0] lines;
  logic [load::PORT_BITS-1:0] store_address, memory_address, lines_end;
  logic [1:0] memory_space;
  logic finishes;
  logic signed [BITS-1:0] store_value, memory_value;

  loading unit (
      .clock(clock), .reset(reset), .register_write(register_write), .register_address(register_address),
      .register_value(word), .column(column), .start(start), .message(message), .finish(finish), .busy(busy),
      .done(done), .failed(failed), .made(made), .lines(lines), .ends(ends), .advanced(advanced),
      .store_write(store_write), .store_address(store_address), .store_value(store_value), .lines_end(lines_end),
      .memory_write(memory_write), .memory_space(memory_space), .memory_address(memory_address),
      .memory_value(memory_value), .stepping(stepping), .computing(computing), .copying(copying));

  always #1 clock = !clock;

  integer list, file, cell_number, found, messages, number, i, p, shown, differences, at_column, wanted_end, wanted_cycles;
  integer cycles, copies, steps, all, sum_cycles, sum_copies, sum_steps, sum_all, sum_messages, sum_words, ended;
  integer words[0:3];
  integer counts[0:3];
  reg [8*64-1:0] name;
  reg [31:0] w_made, w_ends, w_lines, w_cycles, w_copies, w_steps;
  reg [MESSAGE_BITS-1:0] given, w_advanced;
  reg signed [BITS-1:0] value;
  reg signed [BITS-1:0] memory[0:3][0:load::PORT_WORDS-1];

  task check(input [8*16-1:0] what, input integer is, input integer wanted);
    if (is !== wanted) begin
      if (shown < MOST_SHOWN) $display("cell %0d, message %0d: %0s is %0d, expected %0d", cell_number, number, what, is, wanted);
      shown = shown + 1;
      differences = differences + 1;
    end
  endtask

  // What the ports write.
  always @(negedge clock) begin
    if (store_write) begin
      memory[0][store_address] = store_value;
      counts[0] = counts[0] + 1;
    end
    if (memory_write) begin
      memory[32'(memory_space)+1][memory_address] = memory_value;
      counts[32'(memory_space)+1] = counts[32'(memory_space)+1] + 1;
    end
  end

  task run;
    begin
      finishes = finish;
      cycles = 0;
      copies = 0;
      steps = 0;
      all = 0;
      ended = 0;
      @(negedge clock);
      start = 0;
      finish = 0;
      while (busy && all < MOST_CYCLES) begin
        cycles = cycles + 32'(computing);
        copies = copies + 32'(copying);
        steps = steps + 32'(stepping);
        ended = ended + 32'(done);
        all = all + 1;
        @(negedge clock);
      end
      check("done", ended, 1);
      sum_cycles = sum_cycles + cycles;
      sum_copies = sum_copies + copies;
      sum_steps = sum_steps + steps;
      sum_all = sum_all + all;
      sum_messages = sum_messages + 32'(!finishes);
    end
  endtask

  initial begin
    shown = 0;
    differences = 0;
    sum_cycles = 0;
    sum_copies = 0;
    sum_steps = 0;
    sum_all = 0;
    sum_messages = 0;
    sum_words = 0;
    cell_number = 0;
    list = $fopen("loads.txt", "r");
    if (list == 0) begin
      $display("loads.txt: not found, expected what cell_tb --hardware wrote in the current folder");
      $finish;
    end
    while ($fscanf(list, "%d %d %d %d %d %d %d %d", at_column, messages, words[0], words[1], words[2], words[3], wanted_end,
        wanted_cycles) == 8) begin
      number = -1;
      for (p = 0; p < 4; p = p + 1) counts[p] = 0;
      reset = 1;
      repeat (2) @(negedge clock);
      reset = 0;
      while (busy) @(negedge clock);
      file = $fopen("load_registers.hex", "r");
      register_write = 1;
      for (i = 0; i < microcode::REGISTERS; i = i + 1) begin
        found = $fscanf(file, "%h", value);
        word = value;
        register_address = microcode::REGISTER_ADDRESS_BITS'(i);
        @(negedge clock);
      end
      register_write = 0;
      $fclose(file);
      column = X_BITS'(at_column);
      $sformat(name, "messages_%0d.hex", cell_number);
      file = $fopen(name, "r");
      for (number = 0; number < messages; number = number + 1) begin
        found = $fscanf(file, "%h %h %h %h %h %h %h %h", given, w_advanced, w_made, w_ends, w_lines, w_cycles, w_copies,
            w_steps);
        message = given;
        start = 1;
        run;
        check("made", 32'(made), w_made);
        check("ends", 32'(ends), w_ends);
        check("lines", 32'(lines), w_lines);
        check("cycles", cycles, w_cycles);
        check("copies", copies, w_copies);
        check("steps", steps, w_steps);
        check("the span goes on", 32'(advanced === w_advanced), 1);
      end
      $fclose(file);
      finish = 1;
      run;
      check("cycles to finish", all, wanted_cycles);
      check("failed", 32'(failed), 0);
      check("lines end", 32'(lines_end), wanted_end);
      $sformat(name, "written_%0d.hex", cell_number);
      file = $fopen(name, "r");
      for (p = 0; p < 4; p = p + 1) begin
        check("words written", counts[p], words[p]);
        for (number = 0; number < words[p]; number = number + 1) begin
          found = $fscanf(file, "%h", value);
          if (memory[p][number] !== value) begin
            if (shown < MOST_SHOWN)
              $display("cell %0d, port %0d, word %0d: is %0d, expected %0d", cell_number, p, number, memory[p][number], value);
            shown = shown + 1;
            differences = differences + 1;
          end
          sum_words = sum_words + 1;
        end
      end
      $fclose(file);
      cell_number = cell_number + 1;
    end
    $display("words of %0d bits: %0d cells, %0d messages, %0d words written, %0d cycles of programs, %0d of copies, %0d steps, %0d in all, %0d differences",
        microcode::WORD_BITS, cell_number, sum_messages, sum_words, sum_cycles, sum_copies, sum_steps, sum_all, differences);
    $finish;
  end
endmodule
