#include "testbench/rtl/package.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "cells/units/aging_arbiter.hpp"
#include "model/machine/load_wire.hpp"
#include "model/machine/wire.hpp"
#include "model/numbers/bits.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
    throw std::invalid_argument("RTL cell: " + what + ": expected " + expected);
}

/// Settings that the cell in sv/ does not know.
void check(const Context& context, const MachineSettings& machine) {
    const PictureSettings& picture = context.settings;
    const OperatorSettings& operators = picture.numbers.operators;
    if (context.arithmetic.exact()) refuse("--arithmetic exact", "fixed: wires carry words");
    if (machine.networks == Networks::shared)
        refuse("--networks shared", "split, half or quadrant: its answers have buffers of their own");
    if (machine.stall > 0) refuse("--stall", "0: it draws no random stalls");
    if (picture.own_samples() != 1) refuse("--pixels or --samples", "a pixel and a ray for each cell");
    if (operators.reciprocal == Iteration::rounded) refuse("--reciprocal rounded", "newton or table");
    if (operators.root == Iteration::rounded) refuse("--root rounded", "newton or table");
    if (machine.costs.walk_step < 2)
        refuse("--cost walk_step=" + std::to_string(machine.costs.walk_step), "2 cycles at least");
    if (machine.costs.backoff < 1) refuse("--cost backoff=0", "1 cycle at least");
    if (picture.width < 2 || picture.height < 2)
        refuse("--cells " + std::to_string(picture.width) + "x" + std::to_string(picture.height),
               "2 columns and 2 rows at least: a home of no bits is no field");
}

std::string constant(const std::string& name, std::int64_t value) {
    return "  localparam int " + name + " = " + std::to_string(value) + ";\n";
}
std::string constant64(const std::string& name, std::uint64_t value) {
    return "  localparam logic [63:0] " + name + " = 64'd" + std::to_string(value) + ";\n";
}
std::string bit_constant(const std::string& name, bool value) {
    return "  localparam bit " + name + " = 1'b" + (value ? "1" : "0") + ";\n";
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

/// A field's name as an identifier: "polygon left" is polygon_left.
std::string identifier(const std::string& name) {
    if (name == "type") return "message_type";  // `type` is a key word
    std::string text;
    for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return text;
}

/// Tools read sources as ASCII: a raised dot becomes *, the rest is left out.
std::string ascii(const std::string& text) {
    std::string plain;
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 0x80) plain += c;
        if (static_cast<unsigned char>(c) == 0xb7) plain += '*';
    }
    return plain;
}

/// The first `count` fields of a layout (0: all) as members. A reciprocal "1/dx" has two: mantissa, exponent.
RtlPackage::Struct struct_of(const std::string& name, const std::vector<WireField>& layout,
                             std::size_t count = 0) {
    RtlPackage::Struct made{name, {}, 0};
    for (const WireField& field : layout) {
        if (count > 0 && made.members.size() == count) break;
        if (field.name.rfind("1/", 0) == 0) {
            const std::string stem = "inverse_" + field.name.substr(2);
            const int exponent = Formats::exponent_bits;
            made.members.push_back({stem + "_mantissa", field.bits - exponent, "without a sign"});
            made.members.push_back({stem + "_exponent", exponent, "with a sign"});
        } else {
            made.members.push_back({identifier(field.name), field.bits, field.meaning});
        }
        made.bits += field.bits;
    }
    return made;
}

/// Fields of a layout up to one of this name, that one included; all, if there is none.
std::size_t fields_up_to(const std::vector<WireField>& layout, const std::string& name) {
    const auto at = std::find_if(layout.begin(), layout.end(),
                                 [&](const WireField& field) { return field.name == name; });
    return std::min(std::size_t(at - layout.begin()) + 1, layout.size());
}

/// The fields behind those, which a message repeats.
std::vector<WireField> fields_behind(const std::vector<WireField>& layout, const std::string& name,
                                     std::size_t count) {
    const auto first = layout.begin() + std::ptrdiff_t(fields_up_to(layout, name));
    return {first, first + std::ptrdiff_t(std::min(count, std::size_t(layout.end() - first)))};
}

/// The words between the lines of a table, the last one's end included; the first in the lowest bits. One
/// vector: not every tool takes constants of several dimensions.
std::string words_of(const Operators::Table& table, int bits) {
    std::vector<std::uint64_t> words;
    for (const auto& line : table.lines) words.push_back(line.start);
    words.push_back(words.back() + std::uint64_t(table.lines.back().rise));
    std::string text;
    for (std::size_t i = words.size(); i-- > 0;) {
        text += std::to_string(bits) + "'d" + std::to_string(words[i]) + (i > 0 ? "," : "");
        text += i % 8 == 0 ? "\n    " : " ";
    }
    return "{\n    " + text + "}";
}

std::string table_text(const std::string& name, const Operators::Table& table, int bits) {
    const int width = bits * (int(table.lines.size()) + 1);
    return constant(name + "_REST_BITS", table.rest_bits) + "  localparam logic [" +
           std::to_string(width - 1) + ":0] " + name + "_WORDS = " + words_of(table, bits) + ";\n";
}

Side opposite(int side) { return Side((side + 2) % side_count); }

}  // namespace

RtlPackage::RtlPackage(const Context& context, const MachineSettings& machine)
    : context_(context), machine_(machine), message_bits_(0) {
    check(context, machine);
    message_bits_ = (Packing(context, machine).widest() + 3) / 4 * 4;  // as in the files for $readmemh
}

std::vector<RtlPackage::Struct> RtlPackage::structs() const {
    const Formats& formats = context_.arithmetic.formats();
    const Wire wire(context_.settings, machine_, formats);
    const LoadWire load(context_.settings, formats);
    const std::vector<WireField> viewer = load.layout(LoadType::viewer);
    const std::vector<WireField> span = load.layout(LoadType::span);
    std::vector<Struct> made = {struct_of("ray", wire.layout(WireType::ray)),
                                struct_of("shadow_ray", wire.layout(WireType::shadow_ray)),
                                struct_of("intensity", wire.layout(WireType::intensity)),
                                struct_of("verdict", wire.layout(WireType::lit)),
                                struct_of("setup", viewer, fields_up_to(viewer, "sources")),
                                struct_of("point", fields_behind(viewer, "sources", viewer.size())),
                                struct_of("features", load.layout(LoadType::features)),
                                struct_of("span_head", span, 4),  // type, polygon, first and last column
                                struct_of("span", span, fields_up_to(span, "edges"))};
    const std::vector<WireField> edge = fields_behind(span, "edges", 3);
    if (!edge.empty()) made.push_back(struct_of("span_edge", edge));
    return made;
}

std::string RtlPackage::numbers() const {
    const Formats& f = context_.arithmetic.formats();
    std::string text = "\n  // Numbers: bits of a format, and how many of them are a fraction.\n";
    const int word = f.word_bits;
    text += constant("WORD", word) + constant("UNIT_F", f.unit.fraction_bits());
    const std::pair<const char*, const Format*> formats[] = {{"DEPTH", &f.depth},
                                                             {"DISTANCE", &f.distance},
                                                             {"REACH", &f.reach},
                                                             {"FIELD", &f.field},
                                                             {"LOADING", &f.loading}};
    for (const auto& [name, format] : formats) {
        text += constant(std::string(name) + "_BITS", format->bits());
        text += constant(std::string(name) + "_F", format->fraction_bits());
    }
    text += constant("INTENSITY_F", f.intensity.fraction_bits()) +
            constant("PLACE_BITS", f.from.fraction_bits() + 1) + constant("EXPONENT_BITS", f.exponent_bits) +
            constant("LEVEL_MANTISSA_BITS", field::level_mantissa) + constant("ACC", 3 * word + 4) +
            bit_constant("ROUND_NEAREST", f.unit.rounding() == Rounding::nearest);
    return text;
}

std::string RtlPackage::machine_constants() const {
    const BufferClasses classes = buffer_classes(machine_.networks);
    const PictureSettings& picture = context_.settings;
    std::string text =
        "\n  // The array, its links and their buffer classes; sides are east, south, west, north.\n";
    text += constant("COLUMNS", picture.width) + constant("ROWS", picture.height) +
            constant("X_BITS", bits_for(picture.width)) + constant("Y_BITS", bits_for(picture.height)) +
            constant("BUFFER", machine_.buffer_depth) + constant("LINK_BITS", machine_.link_bits) +
            constant("CLASSES", classes.count) + constant("RAY_CLASSES", classes.count - 1) +
            constant("ANSWERS", classes.answer) + constant("CLASS_BITS", bits_for(classes.count)) +
            bit_constant("CLASS_BY_DX", machine_.networks != Networks::split) +
            bit_constant("CLASS_BY_DY", machine_.networks == Networks::quadrant);
    std::string carries;
    for (int side = side_count; side-- > 0;) {
        const std::uint32_t used = classes.used_over(opposite(side));
        for (int index = classes.count; index-- > 0;) carries += used >> unsigned(index) & 1 ? '1' : '0';
    }
    const int width = side_count * classes.count;
    text += "  localparam logic [" + std::to_string(width - 1) + ":0] CARRIES = " + std::to_string(width) +
            "'b" + carries + ";  // bit CLASSES * side + class: comes in there\n";
    const int groups = std::clamp(waiting_generations(context_), 1, machine_.ray_store);
    const int lights = std::max(1, int(context_.lights.rays.size()));
    text += "\n  // Units, ray store, back-off.\n";
    text += constant("TRAVERSAL_UNITS", machine_.traversal_units) +
            constant("LOADING_UNITS", machine_.loading_units) +
            constant("LOAD_VOXEL_CYCLES", int(machine_.costs.load_voxel(picture.hit))) +
            constant("RAY_STORE", machine_.ray_store) +
            constant("SLOT_BITS", slot_address_bits(picture, machine_)) + constant("SLOT_GROUPS", groups) +
            constant("LIGHTS", lights) + constant("LIGHT_INDEX_BITS", bits_for(lights)) +
            bit_constant("EXTERIOR", picture.exterior == ExteriorMode::host) +
            constant64("SEED", machine_.seed) + constant64("START_WITHIN", machine_.start_within) +
            constant("PATIENCE", int(AgingArbiter::patience)) + constant("EPOCH", int(AgingArbiter::epoch));
    return text;
}

std::string RtlPackage::costs() const {
    std::string text = "\n  // Cycles: of a message on a link, and of each operation.\n";
    const MessageBits bits =
        raycell::message_bits(context_.settings, machine_, context_.arithmetic.formats());
    const std::pair<const char*, int> messages[] = {{"RAY", bits.ray},
                                                    {"SHADOW_RAY", bits.shadow_ray},
                                                    {"INTENSITY", bits.intensity},
                                                    {"VERDICT", bits.verdict}};
    for (const auto& [name, width] : messages)
        text += constant(std::string(name) + "_CYCLES", link_cycles(width, machine_.link_bits));
    // Load messages, whose length depends on what they hold.
    const LoadWire load(context_.settings, context_.arithmetic.formats());
    int edges_at = 0;  // bits before a span's number of edges
    bool has_edges = false;
    for (const WireField& field : load.layout(LoadType::span)) {
        has_edges = has_edges || field.name == "edges";
        if (!has_edges) edges_at += field.bits;
    }
    text += constant("LOAD_VIEWER_BITS", bits.viewer) + constant("LOAD_POINT_BITS", bits.source[0]) +
            constant("LOAD_FEATURES_BITS", bits.features) + constant("LOAD_SPAN_BITS", bits.span) +
            constant("LOAD_EDGE_BITS", has_edges ? bits.edge : 0) +
            constant("LOAD_END_BITS", bits.end_of_scene) + constant("EDGES_AT", has_edges ? edges_at : 0) +
            constant("EDGES_BITS", field::edges) + constant("SOURCES_BITS", field::source_count);
    for (const auto& [name, cycles] : CostTable::entries())
        text += constant("COST_" + upper(name), machine_.costs.*cycles);
    text += constant("COST_RECIPROCAL", machine_.costs.reciprocal(context_.settings.numbers.operators));
    return text;
}

std::string RtlPackage::tables() const {
    const NumberSettings& numbers = context_.settings.numbers;
    const Operators operators(numbers.operators, numbers.word_bits, numbers.rounding);
    const int word = numbers.word_bits;
    std::string text = "\n  // Tables of the operators: the words between the lines, W - 1 fraction bits.\n";
    text += bit_constant("RECIPROCAL_NEWTON", operators.settings().reciprocal == Iteration::newton) +
            bit_constant("ROOT_NEWTON", operators.settings().root == Iteration::newton) +
            table_text("RECIPROCAL", operators.reciprocals(), word) +
            table_text("ROOT_1", operators.roots(0), word) + table_text("ROOT_2", operators.roots(1), word);
    return text;
}

std::string RtlPackage::types() const {
    std::string text = "\n  // Messages: the first field is sent first, its most significant bit first.\n";
    text += constant("TYPE_BITS", field::type) + constant("MESSAGE_BITS", message_bits_);
    const std::pair<const char*, WireType> codes[] = {
        {"RAY", WireType::ray}, {"SHADOW_RAY", WireType::shadow_ray}, {"INTENSITY", WireType::intensity},
        {"LIT", WireType::lit}, {"BLOCKED", WireType::blocked},       {"POSTPONED", WireType::postponed}};
    const std::pair<const char*, LoadType> load_codes[] = {{"SETUP", LoadType::viewer},
                                                           {"SETUP_OF_KINDS", LoadType::viewer_of_kinds},
                                                           {"FEATURES", LoadType::features},
                                                           {"SPAN", LoadType::span},
                                                           {"END_OF_SCENE", LoadType::end_of_scene}};
    const std::string logic = "  localparam logic [TYPE_BITS-1:0] ";
    const auto code = [&](const char* kind, const char* name, int value) {
        return logic + kind + name + " = " + std::to_string(field::type) + "'d" + std::to_string(value) +
               ";\n";
    };
    for (const auto& [name, value] : codes) text += code("TYPE_", name, int(value));
    for (const auto& [name, value] : load_codes) text += code("LOAD_", name, int(value));
    for (const Struct& made : structs()) {
        text += "\n" + constant(upper(made.name) + "_BITS", made.bits) + "  typedef struct packed {\n";
        for (const WireField& member : made.members) {
            const std::string range = member.bits > 1 ? "[" + std::to_string(member.bits - 1) + ":0] " : "";
            text += "    logic " + range + member.name + ";  // " + ascii(member.meaning) + "\n";
        }
        text += "  } " + made.name + "_t;\n";
    }
    return text;
}

std::string RtlPackage::verilog() const {
    return "// Printed by rtl_kit from the model's own layouts and tables; not to be edited.\n"
           "// A cell uses some of the costs and fields only, so a linter must not ask for the others.\n"
           "/* verilator lint_off UNUSEDPARAM */\n"
           "package raycell_pkg;\n" +
           numbers() + machine_constants() + costs() + tables() + types() +
           "endpackage\n"
           "/* verilator lint_on UNUSEDPARAM */\n";
}

std::string RtlPackage::header() const {
    const BufferClasses classes = buffer_classes(machine_.networks);
    int setup_bits = 0;
    for (const Struct& made : structs()) setup_bits = made.name == "setup" ? made.bits : setup_bits;
    const auto number = [](const char* name, int value) {
        return "constexpr int " + std::string(name) + " = " + std::to_string(value) + ";\n";
    };
    return "// Printed by rtl_kit; not to be edited.\n#pragma once\n\nnamespace rtl {\n" +
           number("message_bits", message_bits_) + number("classes", classes.count) +
           number("answers", classes.answer) + number("class_bits", bits_for(classes.count)) +
           number("setup_bits", setup_bits) + number("word_bits", context_.arithmetic.formats().word_bits) +
           number("buffer", machine_.buffer_depth) + number("traversal_units", machine_.traversal_units) +
           number("columns", context_.settings.width) + number("rows", context_.settings.height) +
           number("ray_store", machine_.ray_store) + "}  // namespace rtl\n";
}

}  // namespace raycell
