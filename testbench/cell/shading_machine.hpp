// The shading unit's script on the model's interpreter: what shading.sv does.
#pragma once

#include "testbench/cell/shading_calls.hpp"

namespace raycell {

class ShadingMachine {
  public:
    using Word = MicroMachine::Value;
    enum class Job : std::uint8_t { set_up, shade, direct };
    struct Child {
        std::size_t number;
        std::vector<Word> words;  ///< all outputs when it was made
    };
    struct Result {
        std::vector<Child> children;
        std::uint64_t facing = 0;
        std::uint32_t charge = 0;
        std::uint64_t cycles = 0, copies = 0, calls = 0, steps = 0;
    };

    /// `calls` must outlive it.
    ShadingMachine(const ShadingCalls& calls, std::size_t slots, std::size_t lights);

    /// The words of one thing: voxel, object or source.
    void write(ShadeSpace space, std::size_t number, const std::vector<Word>& words);
    /// A ray's word, by its register of `setup`.
    void set(const std::string& name, Word value);
    struct Input {
        Job job = Job::set_up;
        std::size_t slot = 0, voxel = 0;
        std::uint64_t lit = 0;
        std::vector<Word> ports;  ///< in the order of the names
    };
    Result run(const Input& input);
    Word out(const std::string& name) const { return outs_[calls_.place("out " + name).number]; }
    const std::vector<Word>& outs() const { return outs_; }

  private:
    Word read(const ShadePlace& place) const;
    void copy(const std::vector<ShadeCopy>& copies);
    std::size_t at(const ShadePlace& place) const;

    const ShadingCalls& calls_;
    std::vector<MicroMachine> machines_;
    std::vector<Word> memories_[shade_spaces];
    std::vector<Word> outs_;
    std::size_t lights_;
    std::size_t light_ = 0;
    Input input_;
    Result result_;
};

}  // namespace raycell
