// Warnings before a run: the table of claims in cells/deadlock/deadlock.md, row by row.
#include "model/machine/bound.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "../truth/hand_made.hpp"

namespace raycell {
namespace {

using May = Bound::May;

struct Case {
    int width;
    int height;
    bool shadows;
    int max_depth;
    MachineSettings machine;
};

std::vector<Case> every_case() {
    std::vector<Case> all;
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(5, 1), std::pair(1, 4), std::pair(3, 2)})
        for (const bool shadows : {false, true})
            for (const int depth : {0, 1, 2, 4})
                for (const Networks networks :
                     {Networks::shared, Networks::split, Networks::quadrant, Networks::half})
                    for (const Recovery recovery : {Recovery::none, Recovery::postpone})
                        for (const Slots slots : {Slots::reserved, Slots::free, Slots::nested})
                            for (const int store : {1, 2, 3, 4, 5, 6, 100000}) {
                                MachineSettings machine;
                                machine.networks = networks;
                                machine.recovery = recovery;
                                machine.slots = slots;
                                machine.ray_store = store;
                                all.push_back({width, height, shadows, depth, machine});
                            }
    return all;
}

Bound bound_of_case(const Case& each, RunStage stage = RunStage::trace) {
    CellScene scene = hand_made::cube(each.width, each.height, 8);
    if (each.shadows) scene.sources.push_back({{0.5, 0.5, 2}, dvec3(1)});
    PictureSettings settings;
    settings.width = each.width;
    settings.height = each.height;
    settings.max_depth = each.max_depth;
    settings.stage = stage;
    return bound_of(Context(scene, settings), each.machine);
}

/// The claim of the table for a machine. The conditions follow the table's rows from the last to the first.
May claim(const Case& each) {
    const MachineSettings& m = each.machine;
    const int generations = each.max_depth + (each.shadows ? 1 : 0);
    const int cells = each.width * each.height;
    Networks networks = m.networks;
    if (networks == Networks::shared && cells == 1) networks = Networks::half;
    if (networks == Networks::split && (each.width == 1 || each.height == 1)) networks = Networks::half;
    if (networks == Networks::shared || networks == Networks::split) return May::deadlock;
    if (generations == 0) return May::nothing;
    if (m.recovery == Recovery::none) return May::deadlock;
    if (m.slots == Slots::free) return generations >= 2 ? May::livelock : May::nothing;
    return m.ray_store < generations ? May::livelock : May::nothing;
}

TEST(Bound, OfEveryMachineIsTheClaimOfTheTable) {
    for (const Case& each : every_case()) {
        const Bound bound = bound_of_case(each);
        EXPECT_EQ(name_of(bound.may), std::string(name_of(claim(each))))
            << each.width << "x" << each.height << " depth " << each.max_depth << " shadows " << each.shadows
            << " networks " << int(each.machine.networks) << " recovery " << int(each.machine.recovery)
            << " slots " << int(each.machine.slots) << " M " << each.machine.ray_store;
        EXPECT_EQ(bound.generations, each.max_depth + (each.shadows ? 1 : 0));
        EXPECT_EQ(bound.options.empty(), bound.met());
        EXPECT_FALSE(bound.reason.empty());
    }
}

TEST(Bound, NamesTheSmallestRayStoreThatMeetsItOrNone) {
    for (Case each : every_case()) {
        const Bound bound = bound_of_case(each);
        std::set<int> stores;
        for (int store = 1; store <= 10; ++store) {
            each.machine.ray_store = store;
            if (claim(each) == May::nothing) stores.insert(store);
        }
        // Where no generation has to wait, no ray needs a slot, so every ray store is large enough.
        ASSERT_EQ(bound.ray_store_needed.has_value(), !stores.empty());
        if (!stores.empty()) {
            EXPECT_EQ(*bound.ray_store_needed, *stores.begin());
        }
    }
}

/// The machine with the options that the bound recommends.
MachineSettings changed(MachineSettings machine, const std::string& options) {
    std::istringstream words(options);
    for (std::string name, value; words >> name >> value;) {
        if (name == "--networks" && value == "half") machine.networks = Networks::half;
        if (name == "--recovery" && value == "postpone") machine.recovery = Recovery::postpone;
        if (name == "--slots" && value == "reserved") machine.slots = Slots::reserved;
        if (name == "--ray-store") machine.ray_store = std::stoi(value);
    }
    return machine;
}

TEST(Bound, IsMetWithTheOptionsThatItNamesAndNotWithFewer) {
    for (Case each : every_case()) {
        const std::string options = bound_of_case(each).options;
        const MachineSettings machine = each.machine;
        each.machine = changed(machine, options);
        EXPECT_TRUE(bound_of_case(each).met()) << options;
        std::istringstream words(options);
        std::vector<std::string> pairs;
        for (std::string name, value; words >> name >> value;) pairs.push_back(name + " " + value);
        for (std::size_t left_out = 0; left_out < pairs.size(); ++left_out) {
            std::string fewer;
            for (std::size_t i = 0; i < pairs.size(); ++i) fewer += i == left_out ? "" : pairs[i] + " ";
            each.machine = changed(machine, fewer);
            EXPECT_FALSE(bound_of_case(each).met()) << options << " without " << pairs[left_out];
        }
    }
}

TEST(Bound, IsMetWhereNothingIsTraced) {
    for (const Case& each : every_case()) EXPECT_TRUE(bound_of_case(each, RunStage::load).met());
}

}  // namespace
}  // namespace raycell
