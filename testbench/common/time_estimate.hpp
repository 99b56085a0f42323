// Estimates of how long a run takes, before a long one and during a run.
#pragma once

#include <string>

#include "model/truth/forecast.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

/// Wall seconds of a run's phases.
struct ExpectedSeconds {
    double load = 0;
    double precast = 0;
    double trace = 0;

    double sum() const { return load + precast + trace; }
};

/// Estimates from the cost of hops on the machine where the constants were measured (see the source);
/// building the machine is not included. `ranks`: processes that share the array, each on a core of its own.
ExpectedSeconds expected_seconds(const Forecast& forecast, std::size_t cells, bool every_cell_is_a_module,
                                 int ranks = 1);

/// A run that is expected to take longer than this says so before it starts, seconds.
constexpr double long_run = 60;

/// One line for people: "about 12 min for 310 M hops: load 2 min, trace 10 min".
std::string expectation(const Forecast& forecast, const ExpectedSeconds& seconds);

/// "40 s", "12 min", "3.5 h", "2.1 days".
std::string duration(double seconds);

/// Seconds until a phase ends if it goes on as before; negative: too early to say.
double seconds_left(const RunProgress& progress);

/// The progress line, without its line end.
std::string progress_line(const RunProgress& progress);

}  // namespace raycell
