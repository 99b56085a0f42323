// Microprograms tried against the functions of the model that they must equal, bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/microcode/programs.hpp"

namespace raycell {

/// Draws numbers, corners more often than chance would.
class MicroRandom {
  public:
    explicit MicroRandom(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    bool chance(double share) { return uniform(0, 1) < share; }
    /// A word of the format: of any size, an end of the range, 0 or a last bit.
    double word(const Format& format);
    /// The same from low to high.
    double word(const Format& format, double low, double high);

  private:
    std::mt19937_64 engine_;
};

/// A program gave something else than the model.
struct MicroDifference : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What a program stands for in the cost table: an entry, and operators that have entries of their own.
struct MicroCost {
    std::string entry;  ///< "reciprocal", "root", "power": the method's; empty: none
    int times = 1;      ///< how often the entry contains it
    int reciprocals = 0;
    int roots = 0;
    int powers = 0;

    bool has_operators() const {
        return reciprocals + roots + powers > 0 || entry == "reciprocal" || entry == "root" ||
               entry == "power";
    }
};

/// One program on one datapath.
class MicroTrial {
  public:
    virtual ~MicroTrial() = default;
    MicroTrial(const MicroTrial&) = delete;
    MicroTrial& operator=(const MicroTrial&) = delete;

    /// Runs the program with inputs of a draw and compares what it gives with the model. Returns the cycles.
    /// Throws MicroDifference that names the inputs and both results if they differ.
    int step(MicroRandom& random);

    const MicroProgram& program() const { return program_; }
    int accumulator_bits() const { return machine_.accumulator_bits(); }
    /// All registers before and after the last step.
    const std::vector<MicroMachine::Value>& inputs() const { return inputs_; }
    const std::vector<MicroMachine::Value>& results() const { return machine_.values(); }
    const MicroCost& cost() const { return cost_; }
    /// The entries of the cost table that the program stands for, as "compare_edge + reciprocal".
    std::string cost_name() const;
    const OperatorSettings& operators() const { return operators_; }

  protected:
    MicroTrial(const MicroSetting& setting, MicroProgram program, MicroCost cost);
    virtual void draw(MicroRandom& random) = 0;
    /// Calls expect() for every result.
    virtual void compare() = 0;

    void put(const std::string& name, double value) { machine_.put(name, value); }
    void put_bits(const std::string& name, std::int64_t bits) { machine_.set(program_.find(name), bits); }
    double take(const std::string& name) const { return machine_.take(name); }
    void put(const std::string& before, const dvec3& v, const std::string& after = "");
    void expect(const std::string& name, double found, double wanted) const;
    void expect(const std::string& before, const dvec3& wanted) const;

    Arithmetic arithmetic_;

  private:
    std::string input_text() const;

    MicroProgram program_;
    MicroMachine machine_;
    MicroCost cost_;
    OperatorSettings operators_;
    std::vector<MicroMachine::Value> inputs_;
};

/// A trial of every program.
std::vector<std::unique_ptr<MicroTrial>> micro_trials(const MicroSetting& setting);

/// Whether another walk than walk_program() gives something else for one of `runs` inputs, or does not end.
bool walk_differs(const MicroSetting& setting, const MicroProgram& other, std::uint64_t runs);

/// What a number of steps gave.
struct MicroTally {
    std::uint64_t runs = 0;
    int least = 0;
    int most = 0;
    double mean = 0;
};
/// Runs a trial `runs` times. Throws what step() throws.
MicroTally run_trial(MicroTrial& trial, std::uint64_t runs, std::uint64_t seed);

}  // namespace raycell
