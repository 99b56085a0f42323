#include "testbench/cell/load_script.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {
namespace {

constexpr int op_bits = 4;

}  // namespace

void LoadScript::write(LoadPort port, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size();) {
        std::size_t count = 1;
        while (i + count < names.size() && f(names[i + count]) == f(names[i]) + count) ++count;
        emit({LoadStep::Op::write, 0, f(names[i]), 0, std::int64_t(std::size_t(port) << 6U | count)});
        i += count;
    }
}

void LoadScript::jump(const LoadStep& step, const std::string& to) {
    jumps_.emplace_back(steps_.size(), to);
    emit(step);
}

void LoadScript::finish() {
    for (const auto& [at, to] : jumps_) {
        const auto found = labels_.find(to);
        if (found == labels_.end()) throw std::logic_error("the script of loading has no label " + to);
        steps_[at].value = found->second;
    }
    jumps_.clear();
}

/// With a sign: a step may count down.
int LoadScript::value_bits() const {
    std::int64_t most = 1;
    for (const LoadStep& step : steps_) most = std::max({most, step.value, -step.value});
    return 1 + bits_of(std::size_t(most) + 1);
}

std::string LoadScript::file() const {
    using Word = MicroMachine::Value;
    const int field = field_bits();
    const int value = value_bits();
    std::string text;
    for (const LoadStep& step : steps_) {
        Word word = Word(step.op);
        for (const std::size_t part : {step.a, step.b, step.c}) word = word << field | Word(part);
        word = word << value | (Word(step.value) & ((Word(1) << value) - 1));
        text += MicroImage::hexadecimal(word, op_bits + 3 * field + value) + "\n";
    }
    return text;
}

std::string LoadScript::constants() const {
    static const char* const names[] = {"END",  "FAIL", "REWIND",  "SET",       "ADD_NUMBER", "ADD",
                                        "COPY", "GET",  "PUT",     "WRITE",     "TAKE",       "SEND",
                                        "CALL", "JUMP", "JUMP_IS", "JUMP_EQUAL"};
    std::string text = constant_line("OP_BITS", op_bits) + constant_line("VALUE_BITS", value_bits()) +
                       constant_line("COUNT_BITS", 6) + constant_line("STEPS", std::int64_t(steps_.size())) +
                       constant_line("STEP_ADDRESS_BITS", bits_of(steps_.size()));
    for (std::size_t i = 0; i < std::size(names); ++i)
        text += "  localparam logic [" + std::to_string(op_bits - 1) + ":0] DO_" + names[i] + " = " +
                std::to_string(op_bits) + "'d" + std::to_string(i) + ";\n";
    for (const char* label : {"begin", "message", "finish"})
        text += constant_line("ENTRY_" + constant_name(label), std::int64_t(entry(label)));
    return text;
}

}  // namespace raycell
