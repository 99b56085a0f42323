#include "testbench/cell/load_machine.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell {
namespace {

using Op = LoadStep::Op;

std::vector<bool> bits_of(const std::string& digits) {
    std::vector<bool> bits;
    for (const char digit : digits) {
        const unsigned value = unsigned(digit <= '9' ? digit - '0' : digit - 'a' + 10);
        for (unsigned bit = 4; bit-- > 0;) bits.push_back(value >> bit & 1);
    }
    return bits;
}

std::string digits_of(const std::vector<bool>& bits) {
    std::string digits;
    for (std::size_t i = 0; i < bits.size(); i += 4) {
        unsigned value = 0;
        for (std::size_t bit = 0; bit < 4; ++bit) value = value << 1U | unsigned(bits[i + bit]);
        digits += "0123456789abcdef"[value];
    }
    return digits;
}

}  // namespace

LoadMachine::LoadMachine(const LoadCalls& calls, int column) : calls_(calls), column_(column) {
    for (const auto& program : calls.unit().programs()) machines_.emplace_back(*program);
    fields_.assign(calls.unit().fields().size(), 0);
    run("begin");
}

LoadMachine::Result LoadMachine::take(const std::string& digits) {
    message_ = advanced_ = bits_of(digits);
    Result result = run("message");
    result.made = field("made") != 0;
    result.ends = field("ends") != 0;
    result.lines = std::uint32_t(field("lines"));
    result.advanced = digits_of(advanced_);
    return result;
}

LoadMachine::Result LoadMachine::finish() { return run("finish"); }

std::size_t LoadMachine::first_bit(std::size_t field, int& bits, bool& with_sign) const {
    for (const LoadPart& part : calls_.parts()) {
        if (part.field != field) continue;
        bits = part.bits;
        with_sign = part.with_sign;
        return std::size_t(part.low) + std::size_t(part.stride) * std::size_t(this->field("source"));
    }
    throw std::logic_error("no part of a message is " + calls_.unit().fields()[field]);
}

/// Word number i of a step that works on several.
void LoadMachine::block(const LoadStep& step, std::size_t i) {
    int bits = 0;
    bool with_sign = false;
    switch (step.op) {
        case Op::copy:
            fields_[step.a + i] = fields_[step.b + i];
            break;
        case Op::get:
            fields_[step.a + i] = memories_[step.place()].at(std::size_t(fields_[step.b]) + step.c + i);
            break;
        case Op::put: {
            std::vector<Word>& memory = memories_[step.place()];
            const std::size_t at = std::size_t(fields_[step.b]) + i;
            memory.resize(std::max(memory.size(), at + 1));
            memory[at] = fields_[step.c + i];
            break;
        }
        case Op::write:
            ports_[step.place()].push_back(fields_[step.b + i]);
            break;
        case Op::take: {
            Word word = column_;
            if (step.a != calls_.unit().field("column")) {
                const std::size_t first = first_bit(step.a + i, bits, with_sign);
                word = with_sign && message_.at(first) ? -1 : 0;
                for (std::size_t bit = first; bit < first + std::size_t(bits); ++bit)
                    word = word * 2 + Word(message_.at(bit));
            }
            fields_[step.a + i] = word;
            break;
        }
        default: {  // send
            const std::size_t first = first_bit(step.b + i, bits, with_sign);
            for (int bit = 0; bit < bits; ++bit)
                advanced_.at(first + std::size_t(bit)) = fields_[step.b + i] >> (bits - 1 - bit) & 1;
            break;
        }
    }
}

void LoadMachine::call(const UnitCall& call) {
    MicroMachine& machine = machines_[call.program];
    for (const auto& [from, to] : call.loads) machine.set(to, std::int64_t(fields_[from]));
    const int cycles = machine.run();
    result_.cycles += std::uint64_t(cycles);
    if (call.charged) result_.charged += std::uint64_t(cycles);
    result_.copies += call.loads.size() + call.stores.size();
    for (const auto& [from, to] : call.stores) fields_[to] = machine.values()[from];
}

LoadMachine::Result LoadMachine::run(const std::string& entry) {
    result_ = {};
    std::size_t at = calls_.script().entry(entry);
    for (;;) {
        const LoadStep& step = calls_.script().steps().at(at++);
        result_.steps += step.count();
        Word& a = fields_[step.a];
        const Word b = fields_[step.b];
        bool jumps = step.op == Op::jump;
        switch (step.op) {
            case Op::end:
                return result_;
            case Op::fail:
                throw std::logic_error("a message that the unit does not know");
            case Op::rewind:
                for (auto& port : ports_) port.clear();
                break;
            case Op::set:
                a = step.value;
                break;
            case Op::add_number:
                a = b + step.value;
                break;
            case Op::add:
                a = b + fields_[step.c];
                break;
            case Op::call:
                call(calls_.unit().calls()[std::size_t(step.value)]);
                break;
            case Op::jump:
                break;
            case Op::jump_is:
                jumps = b == Word(step.c);
                break;
            case Op::jump_equal:
                jumps = b == fields_[step.c];
                break;
            default:
                for (std::size_t i = 0; i < step.count(); ++i) block(step, i);
        }
        if (jumps) at = std::size_t(step.value);
    }
}

}  // namespace raycell
