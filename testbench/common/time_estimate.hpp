// How long a run takes: told before a long one, and while it goes on.
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

/// By what hops cost on the machine on which the constants were measured (see the source). Without what it
/// takes to build the machine. `ranks`: processes that share the array, each on a core of its own.
ExpectedSeconds expected_seconds(const Forecast& forecast, std::size_t cells, bool every_cell_is_a_module,
                                 int ranks = 1);

/// A run that is expected to take longer than this says so before it starts, seconds.
constexpr double long_run = 60;

/// One line for people: "about 12 min for 310 M hops: load 2 min, trace 10 min".
std::string expectation(const Forecast& forecast, const ExpectedSeconds& seconds);

/// "40 s", "12 min", "3.5 h", "2.1 days".
std::string duration(double seconds);

/// Seconds that a phase will go on as it went so far; negative: nothing can be said yet.
double seconds_left(const RunProgress& progress);

/// The line of progress, without its end.
std::string progress_line(const RunProgress& progress);

}  // namespace raycell
