// raycell_bench: the cost of a hop, by what runs the cells. SystemC elaborates once per process, so a process
// runs one case; scripts/study bench runs them all.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <systemc>

#include "testbench/bench/cases.hpp"

namespace {

using namespace raycell;
using namespace raycell::bench;

const bool banner_off = [] {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);
    return true;
}();

using Case = Measured (*)(const Traffic&);

void run_case(benchmark::State& state, Case run) {
    static int elaborations = 0;
    if (++elaborations > 1) {
        state.SkipWithError(
            "one case a process: name it with --benchmark_filter, or use scripts/study bench");
        return;
    }
    const Traffic& traffic = *new Traffic(int(state.range(0)));  // outlives the machine
    for (auto _ : state) {
        const Measured measured = run(traffic);
        state.SetIterationTime(measured.seconds);
        state.counters["hops"] = double(measured.hops);
        state.counters["hops_per_second"] = double(measured.hops) / measured.seconds;
        state.counters["cycles_per_second"] = double(measured.cycles) / measured.seconds;
        state.counters["build_seconds"] = measured.build_seconds;
        state.counters["bytes_per_cell"] = measured.bytes_per_cell;
    }
}

void add(const char* name, Case run) {
    benchmark::RegisterBenchmark(name, [run](benchmark::State& state) { run_case(state, run); })
        ->ArgName("side")
        ->RangeMultiplier(2)
        ->Range(32, 512)
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

int sc_main(int argc, char** argv) {
    (void)banner_off;
    add("sc_fifo", run_sc_fifo);
    add("cell_module", [](const Traffic& traffic) { return run_array(traffic, {true, {}}); });
    add("cell_tile", [](const Traffic& traffic) { return run_array(traffic, {}); });
    add("bare_cells", run_bare_cells);
    add("bare_tokens", run_bare_tokens);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    try {
        return benchmark::RunSpecifiedBenchmarks() > 0 ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "raycell_bench: " << error.what() << '\n';
        return 1;
    }
}
