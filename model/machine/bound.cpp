#include "model/machine/bound.hpp"

#include <algorithm>
#include <vector>

namespace raycell {
namespace {

/// Whether messages can wait for each other's buffers in a ring.
bool has_rings(Networks networks, const Frame& frame) {
    switch (networks) {
        case Networks::shared:
            return frame.width > 1 || frame.height > 1;
        case Networks::split:
            return frame.width > 1 && frame.height > 1;
        case Networks::quadrant:
        case Networks::half:
            break;
    }
    return false;
}

std::string joined(const std::vector<std::string>& parts, const char* between) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}

}  // namespace

const char* name_of(Bound::May may) {
    constexpr const char* names[] = {"nothing", "livelock", "deadlock"};
    return names[int(may)];
}

Bound bound_of(const Context& context, const MachineSettings& machine) {
    Bound bound;
    if (context.settings.stage == RunStage::load) {
        bound.ray_store_needed = 1;
        bound.reason = "nothing is traced";
        return bound;
    }
    bound.generations = waiting_generations(context);
    const std::string generations = std::to_string(bound.generations) + " generations that may have to wait";
    const std::string store = "--ray-store " + std::to_string(machine.ray_store);
    const bool rings = has_rings(machine.networks, context.scene.frame);
    const bool blocks = machine.recovery == Recovery::none && bound.generations > 0;
    const bool free_slots = machine.slots == Slots::free && bound.generations > 1;
    const bool too_few = machine.ray_store < bound.generations;
    std::vector<std::string> reasons;
    std::vector<std::string> options;
    if (rings) {
        const bool shared = machine.networks == Networks::shared;
        reasons.push_back(shared ? "with --networks shared rays that turn, and rays and answers, can wait "
                                   "for each other in a ring"
                                 : "with --networks split rays that turn can wait for each other in a ring");
        options.emplace_back("--networks half");
    }
    if (blocks) {
        reasons.emplace_back("with --recovery none a hit that finds no slot holds up what would free one");
        options.emplace_back("--recovery postpone");
    }
    if (free_slots) {
        reasons.emplace_back("with --slots free trees can wait for each other's slots");
        options.emplace_back("--slots reserved");
    }
    if (too_few) {
        reasons.push_back(store + " is less than the " + generations);
        options.push_back("--ray-store " + std::to_string(bound.generations));
    }
    bound.may = rings || blocks         ? Bound::May::deadlock
                : free_slots || too_few ? Bound::May::livelock
                                        : Bound::May::nothing;
    if (!rings && !blocks && !free_slots) bound.ray_store_needed = std::max(1, bound.generations);
    bound.reason = !reasons.empty()         ? joined(reasons, "; ")
                   : bound.generations == 0 ? "no ray ever has to wait"
                                            : store + " is no less than the " + generations;
    bound.options = joined(options, " ");
    return bound;
}

}  // namespace raycell
