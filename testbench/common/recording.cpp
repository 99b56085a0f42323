#include "testbench/common/recording.hpp"

namespace raycell {

void check_recording(const RenderOptions& options) {
    if (options.film > 0 && options.film < 4)
        throw UsageError("--film: a film has two halves of two frames at least; expected 0, or 4 to 2000");
    if (options.film == 0 && !options.rays) return;
    const std::string name = options.film > 0 ? "--film" : "--rays";
    if (options.engine != Engine::timed)
        throw UsageError(name + ": the untimed engine has no cycles to show; expected --engine timed");
    if (options.prefix.empty()) throw UsageError("--output: expected one, for the file of " + name);
}

std::vector<std::string> recording_suffixes(const RenderOptions& options) {
    std::vector<std::string> all;
    if (options.film > 0) all.push_back(".film.json");
    if (options.rays) all.push_back(".rays.csv");
    return all;
}

Recording::Recording(const RenderOptions& options, Machine& machine, CellObserverList& observers)
    : machine_(machine) {
    if (options.film > 0) {
        film_.emplace(machine, options.film);
        machine.set_before_cycle([this](Cycle now) { film_->before(now); });
    }
    if (options.rays) observers.add(rays_.emplace());
}

void Recording::finish() {
    machine_.set_before_cycle({});
    if (film_) film_->finish(machine_.environment().scheduler.now());
}

void Recording::write(OutputSet& outputs) const {
    if (film_) outputs.write(".film.json", film_->json());
    if (rays_) outputs.write(".rays.csv", rays_->csv());
}

}  // namespace raycell
