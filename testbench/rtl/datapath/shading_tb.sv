// Drives the shading unit with the jobs of shading_jobs.txt (cell_tb --hardware --shading), in the current folder:
// children as they are made, results, charges and the cycles of the programs and copies are compared.
module shading_tb;
  localparam int BITS = microcode::REGISTER_BITS;
  localparam int MOST_SHOWN = 10;
  localparam int MOST_CYCLES = 1000000;
  localparam int CHILD_WORDS = 13;
  localparam int RESULT_WORDS = 7;
  localparam int MOST_CHILDREN = shade::SOURCES_MOST + 2;

  logic clock = 0;
  logic reset = 1;
  logic memory_write = 0, field_write = 0, start = 0;
  logic [2:0] memory_space = 0;
  logic [shade::MEMORY_BITS-1:0] memory_address = 0;
  logic [microcode::REGISTER_ADDRESS_BITS-1:0] field_address = 0;
  logic signed [BITS-1:0] word = 0;
  logic [shade::LIGHT_BITS-1:0] lights = 0;
  logic [shade::CELL_BITS-1:0] cell_x = 0, cell_y = 0;
  logic [1:0] job = 0;
  logic [shade::SLOT_BITS-1:0] slot = 0;
  logic [shade::VOXEL_BITS-1:0] voxel = 0;
  logic [shade::SOURCES_MOST-1:0] lit = 0, facing;
  logic signed [BITS-1:0] answer[0:5];
  logic busy, child_valid, computing, copying;
  logic [shade::CHILD_BITS-1:0] child_number;
  logic [shade::CHARGE_BITS-1:0] charge;
  logic signed [BITS-1:0] child[0:CHILD_WORDS-1];
  logic signed [BITS-1:0] result[0:RESULT_WORDS-1];

  shading unit (
      .clock(clock), .reset(reset), .memory_write(memory_write), .memory_space(memory_space),
      .memory_address(memory_address), .memory_value(word), .field_write(field_write), .field_address(field_address),
      .field_value(word), .lights(lights), .cell_x(cell_x), .cell_y(cell_y), .start(start), .job(job), .slot(slot),
      .voxel(voxel), .lit(lit), .reflected_red(answer[0]), .reflected_green(answer[1]), .reflected_blue(answer[2]),
      .refracted_red(answer[3]), .refracted_green(answer[4]), .refracted_blue(answer[5]), .busy(busy),
      .child_valid(child_valid), .child_number(child_number), .child_x(child[0]), .child_y(child[1]),
      .child_z(child[2]), .child_dx(child[3]), .child_dy(child[4]), .child_dz(child[5]), .child_mx(child[6]),
      .child_ex(child[7]), .child_my(child[8]), .child_ey(child[9]), .child_weight(child[10]),
      .child_reach(child[11]), .child_front(child[12]), .facing(facing), .reflects(result[0]), .refracts(result[1]),
      .polygon(result[2]), .object(result[3]), .red(result[4]), .green(result[5]), .blue(result[6]), .charge(charge),
      .computing(computing), .copying(copying));

  always #1 clock = !clock;

  integer file, got, i, shown, differences, jobs, children, compared, cycles, copies, all, ratio, a, b, c, d, e;
  integer sum_cycles, sum_copies, sum_all, sum_charge;
  integer job_count[0:2], job_all[0:2], job_charge[0:2], most_ratio[0:2], most_all[0:2];
  longint mask;
  reg [8:1] kind;
  reg signed [BITS-1:0] value;
  reg signed [BITS-1:0] kept[0:MOST_CHILDREN*CHILD_WORDS-1];
  integer numbers[0:MOST_CHILDREN-1];

  task differs(input [8*16-1:0] what, input signed [63:0] is, input signed [63:0] wanted);
    begin
      if (shown < MOST_SHOWN) $display("job %0d (%0d): %0s is %0d, expected %0d", jobs, job, what, is, wanted);
      shown = shown + 1;
      differences = differences + 1;
    end
  endtask

  task run;
    begin
      jobs = jobs + 1;
      children = 0;
      compared = 0;
      cycles = 0;
      copies = 0;
      all = 0;
      start = 1;
      @(negedge clock);
      start = 0;
      while (busy && all < MOST_CYCLES) begin
        if (child_valid && children < MOST_CHILDREN) begin
          numbers[children] = 32'(child_number);
          for (i = 0; i < CHILD_WORDS; i = i + 1) kept[children*CHILD_WORDS+i] = child[i];
        end
        children = children + 32'(child_valid);
        cycles = cycles + 32'(computing);
        copies = copies + 32'(copying);
        all = all + 1;
        @(negedge clock);
      end
    end
  endtask

  task check_result;
    begin
      got = $fscanf(file, "%d %d %d %d", mask, a, b, c);
      if (64'(facing) !== mask) differs("facing", 64'(facing), mask);
      if (32'(charge) !== a) differs("charge", 64'(charge), 64'(a));
      if (cycles !== b) differs("cycles", 64'(cycles), 64'(b));
      if (copies !== c) differs("copies", 64'(copies), 64'(c));
      if (children !== compared) differs("children", 64'(children), 64'(compared));
      for (i = 0; i < RESULT_WORDS; i = i + 1) begin
        got = $fscanf(file, "%h", value);
        if (result[i] !== value) differs("a result", 64'(result[i]), 64'(value));
      end
      sum_cycles = sum_cycles + cycles;
      sum_copies = sum_copies + copies;
      sum_all = sum_all + all;
      sum_charge = sum_charge + a;
      job_count[job] = job_count[job] + 1;
      job_all[job] = job_all[job] + all;
      job_charge[job] = job_charge[job] + a;
      ratio = a == 0 ? 0 : all * 100 / a;
      if (ratio > most_ratio[job]) most_ratio[job] = ratio;
      if (all > most_all[job]) most_all[job] = all;
    end
  endtask

  initial begin
    shown = 0;
    differences = 0;
    jobs = 0;
    sum_cycles = 0;
    sum_copies = 0;
    sum_all = 0;
    sum_charge = 0;
    for (i = 0; i < 3; i = i + 1) begin
      job_count[i] = 0;
      job_all[i] = 0;
      job_charge[i] = 0;
      most_ratio[i] = 0;
      most_all[i] = 0;
    end
    repeat (2) @(negedge clock);
    reset = 0;
    file = $fopen("shading_lights.txt", "r");
    if (file == 0) begin
      $display("shading_lights.txt: not found, expected what cell_tb --hardware --shading wrote in the current folder");
      $finish;
    end
    got = $fscanf(file, "%d", a);
    lights = shade::LIGHT_BITS'(a);
    $fclose(file);
    file = $fopen("shading_registers.hex", "r");
    field_write = 1;
    for (i = 0; i < shade::REGISTERS; i = i + 1) begin
      got = $fscanf(file, "%h", value);
      word = value;
      field_address = microcode::REGISTER_ADDRESS_BITS'(i);
      @(negedge clock);
    end
    field_write = 0;
    $fclose(file);
    file = $fopen("shading_jobs.txt", "r");
    while ($fscanf(file, " %c", kind) == 1) begin
      case (kind)
        "m": begin  // a memory's word
          got = $fscanf(file, "%d %d %h", a, b, value);
          memory_space = 3'(a);
          memory_address = shade::MEMORY_BITS'(b);
          word = value;
          memory_write = 1;
          @(negedge clock);
          memory_write = 0;
        end
        "f": begin  // a ray's word
          got = $fscanf(file, "%d %h", a, value);
          field_address = microcode::REGISTER_ADDRESS_BITS'(a);
          word = value;
          field_write = 1;
          @(negedge clock);
          field_write = 0;
        end
        "j": begin
          got = $fscanf(file, "%d %d %d %d %d %d", a, b, c, d, e, mask);
          job = 2'(a);
          slot = shade::SLOT_BITS'(b);
          voxel = shade::VOXEL_BITS'(c);
          cell_x = shade::CELL_BITS'(d);
          cell_y = shade::CELL_BITS'(e);
          lit = shade::SOURCES_MOST'(mask);
          for (i = 0; i < 6; i = i + 1) begin
            got = $fscanf(file, "%h", value);
            answer[i] = value;
          end
          run;
        end
        "c": begin
          got = $fscanf(file, "%d", a);
          if (compared >= children) differs("a child's number", -1, 64'(a));
          else if (numbers[compared] !== a) differs("a child's number", 64'(numbers[compared]), 64'(a));
          for (i = 0; i < CHILD_WORDS; i = i + 1) begin
            got = $fscanf(file, "%h", value);
            if (compared < children && kept[compared*CHILD_WORDS+i] !== value)
              differs("a child's word", 64'(kept[compared*CHILD_WORDS+i]), 64'(value));
          end
          compared = compared + 1;
        end
        "d": check_result;
        default: differs("a line's kind", 64'(kind), 64'(0));
      endcase
    end
    for (i = 0; i < 3; i = i + 1)
      $display("job %0d: %0d times, %0d cycles, charged %0d, at most %0d hundredths of the charge, at most %0d cycles",
          i, job_count[i], job_all[i], job_charge[i], most_ratio[i], most_all[i]);
    $display("words of %0d bits: %0d jobs, %0d cycles of programs, %0d of copies, %0d in all, charged %0d, %0d differences",
        microcode::WORD_BITS, jobs, sum_cycles, sum_copies, sum_all, sum_charge, differences);
    $finish;
  end
endmodule
