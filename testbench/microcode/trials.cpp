#include "testbench/microcode/trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "testbench/microcode/trial_lists.hpp"

namespace raycell {

double MicroRandom::word(const Format& format) { return word(format, format.least(), format.most()); }

double MicroRandom::word(const Format& format, double low, double high) {
    low = format.hold(low);
    high = format.hold(high);
    const double corner = uniform(0, 1);
    const auto inside = [&](double value) { return std::clamp(format.hold(value), low, high); };
    if (corner < 0.05) return low;
    if (corner < 0.10) return high;
    if (corner < 0.15) return inside(0);
    if (corner < 0.20) return inside(chance(0.5) ? format.step() : -format.step());
    if (corner < 0.40) return inside(uniform(low, high) * std::exp2(-uniform(0, format.bits())));
    if (corner < 0.50) {  // next to a power of two
        const double power = std::exp2(std::floor(uniform(-format.fraction_bits(), format.integer_bits())));
        return inside((chance(0.5) ? power : -power) + std::floor(uniform(-1, 2)) * format.step());
    }
    return inside(uniform(low, high));
}

MicroTrial::MicroTrial(const MicroSetting& setting, MicroProgram program, MicroCost cost)
    : arithmetic_(setting.numbers, setting.extent),
      program_(std::move(program)),
      machine_(program_),
      cost_(std::move(cost)),
      operators_(setting.numbers.operators) {}

std::string MicroTrial::cost_name() const {
    std::string name;
    const auto add = [&](int times, const std::string& what) {
        if (times == 0 || what.empty()) return;
        name += (name.empty() ? "" : " + ") + (times > 1 ? std::to_string(times) + " " : "") + what;
    };
    add(1, cost_.entry);
    add(cost_.reciprocals, "reciprocal");
    add(cost_.roots, "root");
    add(cost_.powers, "power");
    return name;
}

int MicroTrial::step(MicroRandom& random) {
    draw(random);
    inputs_ = machine_.values();
    int cycles = 0;
    try {
        cycles = machine_.run();
    } catch (const std::logic_error& error) {  // a value that its register does not hold, or no end
        throw MicroDifference(std::string(error.what()) + ", for" + input_text());
    }
    compare();
    return cycles;
}

std::string MicroTrial::input_text() const {
    std::ostringstream text;
    text.precision(17);
    for (RegisterIndex i = 0; i < inputs_.size(); ++i) {
        const MicroRegister& r = program_.registers[i];
        if (r.name.find('.') == std::string::npos)
            text << ' ' << r.name << ' ' << std::ldexp(double(inputs_[i]), -r.fraction);
    }
    return text.str();
}

void MicroTrial::put(const std::string& before, const dvec3& v, const std::string& after) {
    for (int i = 0; i < 3; ++i) put(before + "xyz"[i] + after, v[i]);
}

void MicroTrial::expect(const std::string& name, double found, double wanted) const {
    if (found == wanted) return;
    std::ostringstream text;
    text.precision(17);
    text << "microprogram " << program_.name << " on datapath " << program_.datapath.name << ": " << name
         << " is " << found << ", expected " << wanted << ", for" << input_text();
    throw MicroDifference(text.str());
}

void MicroTrial::expect(const std::string& before, const dvec3& wanted) const {
    for (int i = 0; i < 3; ++i) expect(before + "xyz"[i], take(before + "xyz"[i]), wanted[i]);
}

dvec3 any_direction(MicroRandom& random, const Arithmetic& arithmetic) {
    dvec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int axis = 0; axis < 3; ++axis) {
        if (random.chance(0.1)) v[axis] = 0;
        if (random.chance(0.1)) v[axis] *= std::exp2(-random.uniform(0, 20));
    }
    if (v == dvec3(0)) v.z = 1;
    return arithmetic.normalise(v);
}

std::vector<std::unique_ptr<MicroTrial>> micro_trials(const MicroSetting& s) {
    TrialList all = traversal_trials(s);
    for (const auto make : {ray_trials, shading_trials, source_trials, loading_trials, joining_trials}) {
        for (auto& trial : make(s)) all.push_back(std::move(trial));
    }
    return all;
}

MicroTally run_trial(MicroTrial& trial, std::uint64_t runs, std::uint64_t seed) {
    MicroRandom random(seed);
    MicroTally tally;
    tally.least = std::numeric_limits<int>::max();
    std::uint64_t sum = 0;
    for (; tally.runs < runs; ++tally.runs) {
        const int cycles = trial.step(random);
        tally.least = std::min(tally.least, cycles);
        tally.most = std::max(tally.most, cycles);
        sum += std::uint64_t(cycles);
    }
    tally.mean = double(sum) / double(std::max<std::uint64_t>(runs, 1));
    return tally;
}

}  // namespace raycell
