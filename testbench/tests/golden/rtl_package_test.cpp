// The SystemVerilog package of a machine has the model's layouts and widths, whatever the machine.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "model/machine/wire.hpp"
#include "testbench/rtl/package.hpp"

namespace raycell {
namespace {

struct RtlMachine {
    RtlMachine(int side, int word_bits, Networks networks) {
        picture.width = side;
        picture.height = side + 1;
        picture.numbers.word_bits = word_bits;
        machine.networks = networks;
        scene.frame.width = picture.width;
        scene.frame.height = picture.height;
        scene.frame.depth = side;
        scene.objects.emplace_back();
    }
    PictureSettings picture;
    MachineSettings machine;
    CellScene scene;
};

bool has_line(const std::string& text, const std::string& line) {
    return text.find("  " + line + ";\n") != std::string::npos;
}

TEST(RtlPackage, HasStructsAsWideAsTheMessagesOfEveryMachine) {
    for (const int word_bits : {8, 16, 20, 24, 32}) {
        for (const int side : {2, 24, 200}) {
            for (const Networks networks : {Networks::split, Networks::half, Networks::quadrant}) {
                const RtlMachine m(side, word_bits, networks);
                const Context context(m.scene, m.picture);
                const MessageBits bits = message_bits(m.picture, m.machine, context.arithmetic.formats());
                const std::map<std::string, int> expected = {{"ray", bits.ray},
                                                             {"shadow_ray", bits.shadow_ray},
                                                             {"intensity", bits.intensity},
                                                             {"verdict", bits.verdict},
                                                             {"setup", bits.viewer}};
                const RtlPackage package(context, m.machine);
                const std::string text = package.verilog();
                for (const auto& made : package.structs()) {
                    int members = 0;
                    for (const WireField& member : made.members) members += member.bits;
                    EXPECT_EQ(members, made.bits) << made.name;
                    const auto named = expected.find(made.name);
                    if (named != expected.end()) {
                        EXPECT_EQ(made.bits, named->second) << made.name;
                    }
                }
                EXPECT_GE(package.message_bits(), bits.ray);
                EXPECT_TRUE(has_line(text, "localparam int WORD = " + std::to_string(word_bits)));
                EXPECT_TRUE(has_line(text, "localparam int RAY_BITS = " + std::to_string(bits.ray)));
            }
        }
    }
}

TEST(RtlPackage, HasTheMembersOfTheLayoutsInTheirOrder) {
    const RtlMachine m(24, 20, Networks::half);
    const Context context(m.scene, m.picture);
    const RtlPackage package(context, m.machine);
    const Wire wire(m.picture, m.machine, context.arithmetic.formats());
    const auto structs = package.structs();
    const std::vector<WireField> layout = wire.layout(WireType::shadow_ray);
    std::size_t at = 0;
    for (const WireField& field : layout) {
        int bits = structs.at(1).members.at(at).bits;
        if (field.name.rfind("1/", 0) == 0) bits += structs[1].members.at(++at).bits;
        EXPECT_EQ(bits, field.bits) << field.name;
        ++at;
    }
    EXPECT_EQ(at, structs[1].members.size());
}

TEST(RtlPackage, HasEveryEntryOfTheCostTable) {
    RtlMachine m(24, 20, Networks::half);
    m.machine.costs.set("walk_step=41");
    const Context context(m.scene, m.picture);
    const std::string text = RtlPackage(context, m.machine).verilog();
    EXPECT_TRUE(has_line(text, "localparam int COST_WALK_STEP = 41"));
    for (const auto& [name, cycles] : CostTable::entries()) {
        std::string upper = name;
        std::transform(upper.begin(), upper.end(), upper.begin(), ::toupper);
        EXPECT_TRUE(
            has_line(text, "localparam int COST_" + upper + " = " + std::to_string(m.machine.costs.*cycles)))
            << name;
    }
}

TEST(RtlPackage, RefusesWhatTheCellHasNot) {
    const auto refused = [](RtlMachine m) {
        const Context context(m.scene, m.picture);
        EXPECT_THROW(RtlPackage(context, m.machine), std::invalid_argument);
    };
    refused(RtlMachine(24, 20, Networks::shared));
    refused(RtlMachine(1, 20, Networks::half));
    RtlMachine stalled(24, 20, Networks::half);
    stalled.machine.stall = 0.1;
    refused(stalled);
    RtlMachine quick(24, 20, Networks::half);
    quick.machine.costs.walk_step = 1;
    refused(quick);
    RtlMachine rounded(24, 20, Networks::half);
    rounded.picture.numbers.operators.reciprocal = Iteration::rounded;
    refused(rounded);
}

}  // namespace
}  // namespace raycell
