// Drives the traversal unit with the rays of a record (cell_tb --hardware): all fields, the decision, the counts and
// the cycles of the programs and copies are compared.
module traversal_tb;
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int MOST_SHOWN = 10;
  localparam int MOST_CYCLES = 10000000;

  logic clock = 0;
  logic reset = 1;
  logic store_write = 0, register_write = 0, field_write = 0, start = 0;
  logic shadow = 0, finite = 0, outside = 0;
  logic busy, counts_run, counts_test, counts_edge, computing, copying;
  logic [1:0] what;
  logic [visit::STORE_BITS-1:0] store_address = 0, lines_end = 0;
  logic [microcode::REGISTER_ADDRESS_BITS-1:0] register_address = 0;
  logic [visit::FIELD_BITS-1:0] field_address = 0;
  logic signed [BITS-1:0] word = 0;
  logic signed [BITS-1:0] field, voxel;

  traversal unit (
      .clock(clock), .reset(reset), .store_write(store_write), .store_address(store_address), .store_value(word),
      .lines_end(lines_end), .register_write(register_write), .register_address(register_address),
      .register_value(word), .field_write(field_write), .field_address(field_address), .field_value(word),
      .field(field), .start(start), .shadow(shadow), .finite(finite), .outside(outside), .busy(busy), .what(what),
      .voxel(voxel), .counts_run(counts_run), .counts_test(counts_test), .counts_edge(counts_edge),
      .counts_leave(), .edges_of_test(), .computing(computing), .copying(copying));

  always #1 clock = !clock;

  integer list, file, names, cell_number, all_rays, all_lines, found, rays, ray, lines, words, i, shown, differences, wrong;
  integer runs, tests, edges, cycles, copies, all, sum_cycles, sum_copies, sum_all;
  reg [8*64-1:0] name;
  reg signed [BITS-1:0] value;
  reg signed [BITS-1:0] inputs[0:visit::FIELDS];

  task differs(input [8*16-1:0] what_differs, input signed [BITS-1:0] is, input signed [BITS-1:0] wanted);
    begin
      if (shown < MOST_SHOWN) $display("cell %0d, ray %0d: %0s is %0d, expected %0d", cell_number, ray, what_differs, is, wanted);
      shown = shown + 1;
      differences = differences + 1;
    end
  endtask

  task check(input [8*16-1:0] what_differs, input signed [BITS-1:0] is);
    begin
      found = $fscanf(file, "%h", value);
      if (is !== value) differs(what_differs, is, value);
    end
  endtask

  task check_field(input integer number);
    integer at, got;
    begin
      found = $fscanf(file, "%h", value);
      field_address = visit::FIELD_BITS'(number);
      @(posedge clock);
      if (field !== value) begin
        names = $fopen("fields.txt", "r");
        for (at = 0; at <= number; at = at + 1) got = $fscanf(names, "%s", name);
        $fclose(names);
        differs(name[8*16-1:0], field, value);
      end
      @(negedge clock);
    end
  endtask

  initial begin
    shown = 0;
    differences = 0;
    sum_cycles = 0;
    sum_copies = 0;
    sum_all = 0;
    cell_number = 0;
    all_rays = 0;
    all_lines = 0;
    list = $fopen("visits.txt", "r");
    if (list == 0) begin
      $display("visits.txt: not found, expected what cell_tb --hardware wrote in the current folder");
      $finish;
    end
    repeat (2) @(negedge clock);
    reset = 0;
    while ($fscanf(list, "%d %d %d", rays, lines, words) == 3) begin
      file = $fopen("registers.hex", "r");
      register_write = 1;
      for (i = 0; i < visit::REGISTERS; i = i + 1) begin
        found = $fscanf(file, "%h", value);
        word = value;
        register_address = microcode::REGISTER_ADDRESS_BITS'(i);
        @(negedge clock);
      end
      register_write = 0;
      $fclose(file);
      lines_end = visit::STORE_BITS'(lines * visit::VOXEL_WORDS);
      $sformat(name, "store_%0d.hex", cell_number);
      file = $fopen(name, "r");
      store_write = 1;
      for (i = 0; i < words; i = i + 1) begin
        found = $fscanf(file, "%h", value);
        word = value;
        store_address = visit::STORE_BITS'(i);
        @(negedge clock);
      end
      store_write = 0;
      $fclose(file);
      $sformat(name, "visits_%0d.hex", cell_number);
      file = $fopen(name, "r");
      for (ray = 0; ray < rays; ray = ray + 1) begin
        field_write = 1;
        for (i = 0; i < visit::FIELDS; i = i + 1) begin
          found = $fscanf(file, "%h", value);
          word = value;
          field_address = visit::FIELD_BITS'(i);
          @(negedge clock);
        end
        field_write = 0;
        found = $fscanf(file, "%h", value);
        {shadow, finite, outside} = value[2:0];
        runs = 0;
        tests = 0;
        edges = 0;
        cycles = 0;
        copies = 0;
        all = 0;
        start = 1;
        @(negedge clock);
        start = 0;
        while (busy && all < MOST_CYCLES) begin
          runs = runs + 32'(counts_run);
          tests = tests + 32'(counts_test);
          edges = edges + 32'(counts_edge);
          cycles = cycles + 32'(computing);
          copies = copies + 32'(copying);
          all = all + 1;
          @(negedge clock);
        end
        check("what", BITS'({1'b0, what}));
        found = $fscanf(file, "%h", value);
        if (what == 1 && voxel !== value) differs("voxel", voxel, value);
        check("runs", BITS'(runs));
        check("tests", BITS'(tests));
        check("edges", BITS'(edges));
        check("cycles", BITS'(cycles));
        check("copies", BITS'(copies));
        for (i = 0; i < visit::FIELDS; i = i + 1) check_field(i);
        sum_cycles = sum_cycles + cycles;
        sum_copies = sum_copies + copies;
        sum_all = sum_all + all;
      end
      $fclose(file);
      all_rays = all_rays + rays;
      all_lines = all_lines + lines;
      cell_number = cell_number + 1;
    end
    $display("words of %0d bits: %0d cells, %0d voxels, %0d rays, %0d cycles of programs, %0d of copies, %0d in all, %0d differences",
        microcode::WORD_BITS, cell_number, all_lines, all_rays, sum_cycles, sum_copies, sum_all, differences);
    $finish;
  end
endmodule
