#include "testbench/cell/unit_calls.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace raycell {

std::size_t UnitCalls::add_field(const std::string& name) {
    const auto at = std::find(fields_.begin(), fields_.end(), name);
    if (at != fields_.end()) return std::size_t(at - fields_.begin());
    fields_.push_back(name);
    return fields_.size() - 1;
}

std::size_t UnitCalls::field(const std::string& name) const {
    const auto at = std::find(fields_.begin(), fields_.end(), name);
    if (at == fields_.end()) throw std::logic_error("the unit " + name_ + " has no field " + name);
    return std::size_t(at - fields_.begin());
}

std::size_t UnitCalls::call(const std::string& name) const {
    for (std::size_t i = 0; i < calls_.size(); ++i) {
        if (calls_[i].name == name) return i;
    }
    throw std::logic_error("the unit " + name_ + " has no call " + name);
}

/// A copy moves bits: what they are worth must not change.
void UnitCalls::same_fraction(const std::string& value, const MicroProgram& program, RegisterIndex index) {
    const int fraction = program.registers[index].fraction;
    if (fractions_.emplace(value, fraction).first->second != fraction)
        throw std::logic_error("microprogram " + program.name + ": " + program.registers[index].name +
                               " has other last bits than " + value);
}

void UnitCalls::add(const std::string& name, MicroProgram program, const Names& loads, const Names& stores,
                    bool charged) {
    UnitCall call{name, programs_.size(), {}, {}, charged};
    for (const auto& [value, target] : loads) {
        call.loads.emplace_back(add_field(value), program.find(target));
        same_fraction(value, program, call.loads.back().second);
    }
    for (const auto& [source, value] : stores) {
        call.stores.emplace_back(program.find(source), add_field(value));
        same_fraction(value, program, call.stores.back().first);
    }
    calls_.push_back(std::move(call));
    programs_.push_back(std::make_unique<MicroProgram>(std::move(program)));
}

std::int64_t UnitCalls::word(const std::string& field, double value) const {
    const auto known = fractions_.find(field);
    const double scaled = std::ldexp(value, known == fractions_.end() ? 0 : known->second);
    if (scaled != std::floor(scaled))
        throw std::logic_error("the unit " + name_ + " has no word for " + field);
    return std::int64_t(scaled);
}

MicroImage image_of(const std::vector<const UnitCalls*>& units) {
    std::vector<const MicroProgram*> programs;
    for (const UnitCalls* unit : units) {
        for (const auto& program : unit->programs()) programs.push_back(program.get());
    }
    return MicroImage(programs, true);
}

std::string constant_line(const std::string& name, std::int64_t value) {
    return "  localparam int " + name + " = " + std::to_string(value) + ";\n";
}

UnitFiles unit_files(const UnitCalls& unit, const MicroImage& image, std::size_t first_program) {
    using Word = MicroMachine::Value;
    const int wide = std::max(bits_of(image.register_count()), bits_of(unit.fields().size()));
    const int entry = image.entry_bits();
    std::size_t copies = 0;
    for (const UnitCall& c : unit.calls()) copies += c.loads.size() + c.stores.size();
    const int copy = bits_of(copies + 1);
    UnitFiles files;
    std::size_t at = 0;
    // From: 0 a field, 3 a register. To: 0 a register, 1 a field.
    const auto add_copy = [&](unsigned from, std::size_t number, bool to_field, std::size_t to) {
        const Word word =
            Word(from) << (wide + 1 + wide) | Word(number) << (1 + wide) | Word(to_field) << wide | Word(to);
        files.copies += MicroImage::hexadecimal(word, 2 + wide + 1 + wide) + "\n";
        ++at;
    };
    for (const UnitCall& c : unit.calls()) {
        const std::size_t program = first_program + c.program;
        const RegisterIndex base = image.first_register(program);
        const std::size_t first = at;
        for (const auto& [from, to] : c.loads) add_copy(0, from, false, base + to);
        const std::size_t middle = at;
        for (const auto& [from, to] : c.stores) add_copy(3, base + from, true, to);
        const Word word =
            ((Word(first) << copy | Word(middle)) << copy | Word(at)) << entry | Word(image.entry(program));
        files.calls += "// " + c.name + "\n" + MicroImage::hexadecimal(word, 3 * copy + entry) + "\n";
    }
    const auto number = [&](const std::string& name, std::size_t value) {
        files.constants += constant_line(name, std::int64_t(value));
    };
    number("FIELDS", unit.fields().size());
    number("FIELD_BITS", std::size_t(bits_of(unit.fields().size())));
    number("SOURCE_BITS", std::size_t(wide));
    number("TO_BITS", std::size_t(wide));
    number("COPIES", copies);
    number("COPY_BITS", std::size_t(copy));
    number("CALLS", unit.calls().size());
    number("CALL_BITS", std::size_t(bits_of(unit.calls().size())));
    for (std::size_t i = 0; i < unit.fields().size(); ++i) number("F_" + constant_name(unit.fields()[i]), i);
    for (std::size_t i = 0; i < unit.calls().size(); ++i)
        number("CALL_" + constant_name(unit.calls()[i].name), i);
    return files;
}

}  // namespace raycell
