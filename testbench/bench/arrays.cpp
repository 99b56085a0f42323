// The cases that run an array: under SystemC, and without it.
#include "testbench/bench/cases.hpp"

namespace raycell::bench {
namespace {

/// An array without the stages before it, as it stands when tracing begins.
struct Bench {
    Bench(const Traffic& traffic, const Granularity& granularity)
        : picture(traffic.side(), traffic.side()), environment(traffic.environment(scheduler, picture)) {
        array = std::make_unique<Array>("array", *environment, granularity);
    }
    void elaborate() {
        sc_core::sc_start(sc_core::SC_ZERO_TIME);
        for (Cell& cell : array->cells()) {
            SyntheticTraffic::furnish(cell.store(), environment->context.scene.frame, cell.x(), cell.y());
        }
    }
    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    Picture picture;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<Array> array;
};

template <typename Run>
Measured measure(const Traffic& traffic, const Granularity& granularity, const Run& run) {
    Measured measured;
    const double cells = double(traffic.side()) * traffic.side();
    const double before = resident_bytes();
    const double start = clock_seconds();
    // Never destroyed: SystemC takes ports down in quadratic time.
    Bench& bench = *new Bench(traffic, granularity);
    measured.bytes_per_cell = (resident_bytes() - before) / cells;
    bench.elaborate();
    measured.build_seconds = clock_seconds() - start;
    bench.array->begin_phase();
    const double traced = clock_seconds();
    run(bench);
    measured.seconds = clock_seconds() - traced;
    const Counters& counters = bench.environment->meters.counters;
    if (counters.pixels_done != std::uint64_t(cells)) throw std::logic_error("a ray was not answered");
    measured.hops = counters.rays.ray_hops + counters.rays.return_hops;
    measured.cycles = counters.last_progress;
    return measured;
}

/// What a tile does, in a plain loop.
class BareHost : public CellHost {
  public:
    void activate(Cell& cell) override { active_.push_back(&cell); }
    void run(Environment& environment, const Prefetch& prefetch) {
        while (environment.scheduler.run_next()) {
            run_cells(active_, environment, prefetch);
            active_.clear();
        }
    }

  private:
    std::vector<Cell*> active_;
};

}  // namespace

Measured run_array(const Traffic& traffic, const Granularity& granularity) {
    return measure(traffic, granularity, [](Bench&) { sc_core::sc_start(); });
}

Measured run_bare_cells(const Traffic& traffic) {
    return measure(traffic, {}, [](Bench& bench) {
        BareHost host;
        for (Cell& cell : bench.array->cells()) cell.set_host(host);
        host.run(*bench.environment, bench.array->prefetch());
    });
}

}  // namespace raycell::bench
