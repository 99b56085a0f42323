#include "testbench/cell/shading_machine.hpp"

#include <algorithm>

namespace raycell {

ShadingMachine::ShadingMachine(const ShadingCalls& calls, std::size_t slots, std::size_t lights)
    : calls_(calls), outs_(calls.words(ShadeSpace::out).size(), 0), lights_(lights) {
    for (const auto& program : calls.programs()) machines_.emplace_back(*program);
    memories_[std::size_t(ShadeSpace::slot)].assign(slots * calls.words(ShadeSpace::slot).size(), 0);
}

void ShadingMachine::write(ShadeSpace space, std::size_t number, const std::vector<Word>& words) {
    std::vector<Word>& memory = memories_[std::size_t(space)];
    const std::size_t first = number * words.size();
    if (memory.size() < first + words.size()) memory.resize(first + words.size(), 0);
    std::copy(words.begin(), words.end(), memory.begin() + std::ptrdiff_t(first));
}

void ShadingMachine::set(const std::string& name, Word value) {
    const ShadePlace place = calls_.place("setup." + name);
    machines_[place.program].set(place.number, std::int64_t(value));
}

/// The place's word in its memory.
std::size_t ShadingMachine::at(const ShadePlace& place) const {
    const std::size_t thing = place.space == ShadeSpace::voxel    ? input_.voxel
                              : place.space == ShadeSpace::object ? std::size_t(out("object"))
                              : place.space == ShadeSpace::source ? light_
                                                                  : input_.slot;
    return thing * calls_.words(place.space).size() + place.number;
}

ShadingMachine::Word ShadingMachine::read(const ShadePlace& place) const {
    switch (place.space) {
        case ShadeSpace::own:
            return machines_[place.program].values()[place.number];
        case ShadeSpace::port:
            return input_.ports.at(place.number);
        case ShadeSpace::out:
            return outs_[place.number];
        default:
            return memories_[std::size_t(place.space)].at(at(place));
    }
}

void ShadingMachine::copy(const std::vector<ShadeCopy>& copies) {
    for (const ShadeCopy& c : copies) {
        const Word value = read(c.from);
        if (c.to.space == ShadeSpace::own) {
            machines_[c.to.program].set(c.to.number, std::int64_t(value));
        } else if (c.to.space == ShadeSpace::slot) {
            memories_[std::size_t(ShadeSpace::slot)].at(at(c.to)) = value;
        } else {
            outs_[c.to.number] = value;
        }
    }
    result_.copies += copies.size();
}

ShadingMachine::Result ShadingMachine::run(const Input& input) {
    using Op = ShadeStep::Op;
    input_ = input;
    result_ = {};
    const std::uint64_t lit = input.job == Job::shade ? input.lit : 0;
    const auto emit = [&](std::size_t number) {
        if (input.job != Job::direct) result_.children.push_back({number, outs_});
    };
    std::size_t at = input.job == Job::shade ? calls_.shade_entry() : 0;
    for (;;) {
        const ShadeStep& step = calls_.script()[at++];
        ++result_.steps;
        result_.charge += step.charge;
        bool goes = false;
        switch (step.op) {
            case Op::call: {
                const ShadeCall& call = calls_.calls()[step.argument];
                copy(call.before);
                result_.cycles += std::uint64_t(machines_[call.program].run());
                copy(call.after);
                ++result_.calls;
                break;
            }
            case Op::end:
                return result_;
            case Op::end_of_setup:
                if (input.job != Job::direct) return result_;
                break;
            case Op::first_light:
                light_ = 0;
                break;
            case Op::if_light:
                goes = light_ >= lights_;
                break;
            case Op::if_lit:
                goes = (lit >> light_ & 1) == 0;
                break;
            case Op::if_any_lit:
                goes = lit == 0;
                break;
            case Op::if_positive:
                goes = outs_[step.argument] <= 0;
                break;
            case Op::faces:
                result_.facing |= std::uint64_t(1) << light_;
                break;
            case Op::emit_light:
                emit(light_);
                break;
            case Op::emit:
                emit(step.argument);
                break;
            case Op::next_light:
                ++light_;
                goes = true;
                break;
            case Op::jump:
                goes = true;
                break;
        }
        if (goes) at = step.target;
    }
}

}  // namespace raycell
