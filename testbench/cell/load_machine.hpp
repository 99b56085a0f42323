// Runs the script of loading on the microprograms' interpreter, message by message: what loading.sv does.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "testbench/cell/load_calls.hpp"

namespace raycell {

class LoadMachine {
  public:
    using Word = MicroMachine::Value;
    /// `calls` must outlive it.
    LoadMachine(const LoadCalls& calls, int column);

    struct Result {
        bool made = false;  ///< a voxel was made, or another piece has joined one
        bool ends = false;  ///< this is the span's last column
        std::uint32_t lines = 0;
        /// Of programs in the cost table, of all programs; copies; steps of the script.
        std::uint64_t charged = 0, cycles = 0, copies = 0, steps = 0;
        std::string advanced;  ///< the message that goes on, hexadecimal digits as of the message taken
    };
    /// Throws std::logic_error where the unit would fail.
    Result take(const std::string& digits);
    Result finish();
    /// What was written out so far.
    const std::vector<Word>& written(LoadPort port) const { return ports_[std::size_t(port)]; }
    std::size_t memory_words(LoadMemory memory) const { return memories_[std::size_t(memory)].size(); }
    Word field(const std::string& name) const { return fields_[calls_.unit().field(name)]; }

  private:
    Result run(const std::string& entry);
    void block(const LoadStep& step, std::size_t i);
    void call(const UnitCall& call);
    /// Where a part of the message begins that is the field's.
    std::size_t first_bit(std::size_t field, int& bits, bool& with_sign) const;

    const LoadCalls& calls_;
    int column_;
    std::vector<MicroMachine> machines_;
    std::vector<Word> fields_;
    std::array<std::vector<Word>, 3> memories_;
    std::array<std::vector<Word>, 4> ports_;
    std::vector<bool> message_, advanced_;
    Result result_;
};

}  // namespace raycell
