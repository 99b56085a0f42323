#include "testbench/bench/traffic.hpp"

#include <unistd.h>

#include <ctime>
#include <fstream>

namespace raycell::bench {
namespace {

/// A ray crosses about sixteen cells before it hits.
TrafficSettings draws() {
    TrafficSettings settings;
    settings.hit_probability = 1.0 / 16;
    settings.directions = Directions::isotropic;
    settings.reflected = 0;
    return settings;
}

}  // namespace

Traffic::Traffic(int side)
    : side_(side),
      draws_(draws()),
      picture_(traffic_picture(side, side, 0)),
      scene_(traffic_scene(picture_, draws())) {}

std::unique_ptr<Environment> Traffic::environment(Scheduler& scheduler, Picture& picture) const {
    auto environment =
        std::make_unique<Environment>(scene_, picture_, MachineSettings(), scheduler, picture, &draws_);
    environment->phase = Phase::trace;
    return environment;
}

bool goes_on(const Environment& environment, const Visit& visit, int x, int y) {
    if (visit.event != Visit::Event::forward) return false;
    const int to_x = x + step_x(visit.crossing.side);
    const int to_y = y + step_y(visit.crossing.side);
    return to_x >= 0 && to_x < environment.width() && to_y >= 0 && to_y < environment.height();
}

Side way_home(const Answer& answer, int x, int y) {
    if (answer.home_x != x) return answer.home_x > x ? Side::east : Side::west;
    return answer.home_y > y ? Side::south : Side::north;
}

double clock_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

double resident_bytes() {
    std::uint64_t pages = 0;
    std::uint64_t resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return double(resident) * double(sysconf(_SC_PAGESIZE));
}

}  // namespace raycell::bench
