#include "testbench/golden/packing.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "testbench/golden/messages.hpp"

namespace raycell {
namespace {

constexpr std::array<std::pair<const char*, WireType>, 4> types{{{"ray", WireType::ray},
                                                                 {"shadow_ray", WireType::shadow_ray},
                                                                 {"intensity", WireType::intensity},
                                                                 {"verdict", WireType::lit}}};

constexpr std::array<std::pair<const char*, LoadType>, 4> load_types{
    {{"setup", LoadType::viewer},
     {"features", LoadType::features},
     {"span", LoadType::span},
     {"end_of_scene", LoadType::end_of_scene}}};

int bits_in(const std::vector<WireField>& layout) {
    int bits = 0;
    for (const WireField& field : layout) bits += field.bits;
    return bits;
}

int digit_of(char letter) {
    if (letter >= '0' && letter <= '9') return letter - '0';
    if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
    throw GoldenError(std::string("bits: '") + letter + "': expected digits from 0 to 9 and a to f");
}

}  // namespace

Packing::Packing(const Context& context, const MachineSettings& machine)
    : context_(context), words_(context.arithmetic, context.settings) {
    if (context.arithmetic.exact()) return;
    wire_.emplace(context.settings, machine, context.arithmetic.formats());
    load_wire_.emplace(context.settings, context.arithmetic.formats());
}

WireBits Packing::pack(const Message& message) const {
    switch (message.kind) {
        case Message::Kind::ray:
            return wire_->pack(message.ray->ray);
        case Message::Kind::answer:
            return wire_->pack(*message.answer);
        case Message::Kind::load:
            return pack(*message.load);
        case Message::Kind::none:
            break;
    }
    throw std::range_error("no message");
}

/// Of the load messages that come to a cell.
WireBits Packing::pack(const LoadItem& item) const {
    switch (item.kind) {
        case LoadItem::Kind::setup:
            return load_wire_->pack(viewer_of(context_));
        case LoadItem::Kind::features:
            if (item.object >= context_.objects.size()) break;
            return load_wire_->pack(context_.objects[item.object]);
        case LoadItem::Kind::span:
            return load_wire_->pack(item.span);
        case LoadItem::Kind::end_of_scene:
            return load_wire_->end_of_scene();
        case LoadItem::Kind::polygon:
        case LoadItem::Kind::surface:
        case LoadItem::Kind::trapeze:
            break;
    }
    throw std::range_error("no message of a cell");
}

std::optional<WireBits> Packing::bits_of(const Message& message) const {
    if (!wire_) return std::nullopt;
    try {
        return pack(message);
    } catch (const std::range_error&) {
        return std::nullopt;
    }
}

std::string Packing::packed(const Message& message) const {
    const auto bits = bits_of(message);
    return bits ? bits->hex() : "";
}

std::string Packing::text_of_bits(const std::string& digits) const {
    if (!wire_) throw GoldenError("bits: exact arithmetic has none; expected -");
    WireBits bits;
    try {
        for (const char letter : digits) bits.put(std::uint64_t(digit_of(letter)), 4);
        WireBits type = bits;
        const auto code = WireType(type.get(3));
        if (code > WireType::postponed) throw GoldenError("bits: no ray and no answer has this type");
        const std::size_t expected = std::size_t(bits_in(wire_->layout(code)) + 3) / 4;
        if (digits.size() != expected)
            throw GoldenError("bits: expected " + std::to_string(expected) + " digits of this type");
        if (code == WireType::ray || code == WireType::shadow_ray) {
            RayPacket packet;
            packet.ray = wire_->unpack_ray(bits, false);
            return text_of(words_, Message(&packet));
        }
        Answer answer = wire_->unpack_answer(bits, false);
        return text_of(words_, Message(&answer));
    } catch (const std::length_error& error) {
        throw GoldenError(std::string("bits: ") + error.what());
    }
}

std::string Packing::objection(const Message& message, const std::string& digits) const {
    const std::string bits = packed(message);
    if (digits.empty() || digits == bits) return "";
    std::string field;
    if (message.kind != Message::Kind::load)
        field = difference(words_, tokens_of(text_of_bits(digits)), tokens_of(text_of(words_, message)));
    return "bits and words differ: " +
           (field.empty() ? "expected the bits " + bits : field + " in the words");
}

namespace {

std::string layout_text(const char* name, const std::vector<WireField>& fields) {
    std::string line = name;
    for (const WireField& field : fields) {
        std::string word = field.name;
        std::replace(word.begin(), word.end(), ' ', '_');
        line += " " + word + ":" + std::to_string(field.bits);
    }
    return line;
}

}  // namespace

std::vector<std::string> Packing::layouts() const {
    std::vector<std::string> lines;
    if (!wire_) return lines;
    for (const auto& [name, type] : types) lines.push_back(layout_text(name, wire_->layout(type)));
    for (const auto& [name, type] : load_types) lines.push_back(layout_text(name, load_wire_->layout(type)));
    const SourceCounts counts(context_.lights.sources, 1);
    for (int i = 0; i < source_kinds && !counts.points(); ++i) {
        const SourceKind kind = SourceKind(i);
        if (counts.of_kind[std::size_t(i)] > 0)
            lines.push_back(layout_text((std::string("setup_") + name_of(kind)).c_str(),
                                        load_wire_->layout(LoadType::viewer_of_kinds, kind)));
    }
    return lines;
}

int Packing::widest() const {
    int most = 0;
    if (!wire_) return most;
    for (const auto& [name, type] : types) most = std::max(most, bits_in(wire_->layout(type)));
    Span span;
    span.edge_count = int(span.edges.size());
    const Material features = hold(Material(), context_.arithmetic);
    return std::max({most, load_wire_->pack(viewer_of(context_)).size(), load_wire_->pack(features).size(),
                     load_wire_->pack(span).size()});
}

}  // namespace raycell
