// The jobs of the shading unit as calls of microprograms, and the script that says in which order.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/tracing/tracing.hpp"
#include "testbench/microcode/image.hpp"

namespace raycell {

/// Where a word is: in a program's registers, behind a place in a memory, at an input, at an output.
enum class ShadeSpace : std::uint8_t { own, voxel, object, source, slot, port, out };
constexpr std::size_t shade_spaces = 7;

struct ShadePlace {
    ShadeSpace space = ShadeSpace::own;
    std::size_t number = 0;
    std::size_t program = 0;  ///< whose register it is
};
struct ShadeCopy {
    ShadePlace from;
    ShadePlace to;  ///< a register, a slot's word or an output
};
/// Copies, then a program, then copies.
struct ShadeCall {
    std::string name;
    std::size_t program = 0;
    std::vector<ShadeCopy> before, after;
};

/// A step of the script. Steps with a target go there unless their condition holds.
struct ShadeStep {
    enum class Op : std::uint8_t {
        call,          ///< of number `argument`
        end,           ///< of the job
        end_of_setup,  ///< of the job, unless it is DIRECT
        first_light,
        if_light,  ///< there is a light of this number
        if_lit,    ///< its bit is set
        if_any_lit,
        if_positive,  ///< the output word `argument` is greater than 0
        faces,        ///< sets the light's bit of `facing`
        emit_light,   ///< a child of the light's number
        emit,         ///< a child of number `argument`
        next_light,   ///< and to the target
        jump
    };
    Op op = Op::end;
    std::size_t argument = 0;
    std::size_t target = 0;
    std::uint32_t charge = 0;  ///< cycles of the cost table
};

/// Programs, words, calls and script of one machine.
class ShadingCalls {
  public:
    /// Throws std::invalid_argument for a machine whose shading the unit does not have.
    ShadingCalls(const Context& context, const CostTable& costs);
    ShadingCalls(const ShadingCalls&) = delete;
    ShadingCalls& operator=(const ShadingCalls&) = delete;

    const std::vector<std::unique_ptr<MicroProgram>>& programs() const { return programs_; }
    const std::vector<ShadeCall>& calls() const { return calls_; }
    const std::vector<ShadeStep>& script() const { return script_; }
    std::size_t shade_entry() const { return shade_entry_; }  ///< the step that SHADE begins with
    MicroImage& image() { return *image_; }
    const MicroImage& image() const { return *image_; }

    const std::vector<std::string>& words(ShadeSpace space) const { return words_[std::size_t(space)]; }
    /// A word by its name: "slot px", "setup.px". Throws std::logic_error if there is none.
    ShadePlace place(const std::string& name) const;
    /// A number as that word.
    std::int64_t word(const std::string& name, double value) const;
    /// The number of a place in its space; of a register among all.
    std::size_t number(const ShadePlace& place) const;

  private:
    using Names = std::vector<std::pair<std::string, std::string>>;  ///< "xyz" at the end: three of them
    void add_programs(const Context& context);
    void add_setup_calls();
    void add_shade_calls();
    void write_script(const Context& context, const CostTable& costs);
    void call(const std::string& name, const std::string& program, const Names& before, const Names& after);
    std::vector<ShadeCopy> copies(const Names& names);
    ShadePlace found(const std::string& name);
    std::size_t number_of(const std::string& call) const;

    std::vector<std::unique_ptr<MicroProgram>> programs_;
    std::unique_ptr<MicroImage> image_;
    std::vector<std::string> words_[shade_spaces];
    std::map<std::string, int> fractions_;  ///< of the last bit of each word outside of registers
    std::vector<ShadeCall> calls_;
    std::vector<ShadeStep> script_;
    std::size_t shade_entry_ = 0;
};

}  // namespace raycell
