#include "testbench/cell/visit_calls.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/microcode/programs.hpp"

namespace raycell {

VisitCalls::VisitCalls(const Context& context) {
    const HitTest rung = context.settings.hit;
    if (rung != HitTest::interval && rung != HitTest::edge)
        throw std::invalid_argument(
            "the traversal unit in SystemVerilog has the rungs interval and edge alone");
    MicroSetting s{context.settings.numbers, extent_of(context.scene.frame), {}};
    s.datapath = datapaths(s.numbers.word_bits, widest_operand(s.formats())).front();
    const double hair = context.arithmetic.hair();
    const double tie = context.arithmetic.tie();
    const auto same = [](std::initializer_list<const char*> names) {
        Names all;
        for (const char* name : names) all.emplace_back(name, name);
        return all;
    };
    const auto with = [](Names all, const Names& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const Names next = {{"x", "next x"}, {"y", "next y"}, {"z", "z1"}, {"reach", "next reach"}};
    add("walk", walk_program(s, context.depth),
        same({"x", "y", "z", "dx", "dy", "dz", "mx", "ex", "my", "ey", "reach"}),
        with(same({"t", "side", "flags", "left"}), next), true);
    add("leave", leave_program(s, context.depth),
        same({"x", "y", "z", "dx", "dy", "dz", "reach", "t", "axial"}), with(same({"t", "left"}), next),
        true);
    add("reached", reached_program(s), same({"reach", "z", "dz"}), same({"t", "z1"}), false);
    add("range", range_program(s, hair), same({"z", "z1"}), same({"low", "high"}), false);
    const Names compared = {{"voxel near", "near"},
                            {"voxel far", "far"},
                            {"low", "low"},
                            {"high", "high"},
                            {"voxel polygon", ""}};
    add("run", run_program(s, false), compared, same({"meets"}), true);
    add("run outwards", run_program(s, true), with(compared, {{"voxel most", "most"}}), same({"meets"}),
        true);
    if (rung == HitTest::interval) {
        add("test", enter_program(s, rung),
            with(same({"z", "z1", "dz"}),
                 {{"voxel near", "near"}, {"voxel far", "far"}, {"t", "end"}, {"voxel number", ""}}),
            {{"hit", "hit"}, {"t", "hit t"}}, true);
    } else {
        add("test", plane_program(s, rung),
            with(same({"x", "y", "z", "dx", "dy", "dz", "leaves"}), {{"voxel nx", "nx"},
                                                                     {"voxel ny", "ny"},
                                                                     {"voxel nz", "nz"},
                                                                     {"voxel c", "c"},
                                                                     {"voxel near", "base"},
                                                                     {"voxel near", "near"},
                                                                     {"voxel far", "far"},
                                                                     {"t", "end"},
                                                                     {"voxel number", ""},
                                                                     {"voxel edges", ""},
                                                                     {"voxel first", ""}}),
            {{"hit", "hit"}, {"t", "hit t"}, {"px", "px"}, {"py", "py"}, {"pz", "pz"}}, true);
        add("projection", projection_program(s),
            with(same({"px", "py", "pz"}),
                 {{"voxel near", "base"}, {"voxel drop x", "drop x"}, {"voxel drop z", "drop z"}}),
            same({"u", "v"}), false);
        add("edge", edge_program(s),
            {{"edge a", "a"}, {"edge b", "b"}, {"edge c", "c"}, {"u", "u"}, {"v", "v"}}, same({"inside"}),
            true);
    }
    add("nearer", nearer_program(s, tie), {{"hit t", "t"}, {"best", "best"}, {"lower", "lower"}},
        same({"nearer"}), false);
    add("narrow", narrow_program(s, tie),
        {{"z", "z"}, {"dz", "dz"}, {"hit t", "t"}, {"low", "low"}, {"high", "high"}}, same({"low", "high"}),
        false);
    add("at source", at_source_program(s, hair), {{"best", "t"}, {"reach", "reach"}}, same({"there"}), false);
    found(fields_, "polygon left");
}

std::size_t VisitCalls::found(std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return std::size_t(at - names.begin());
    names.push_back(name);
    return names.size() - 1;
}

/// A copy moves bits: what they are worth must not change.
void VisitCalls::same_fraction(const std::string& value, const MicroProgram& program, RegisterIndex index) {
    const int fraction = program.registers[index].fraction;
    const auto known = fractions_.emplace(value, fraction).first;
    if (known->second != fraction)
        throw std::logic_error("microprogram " + program.name + ": " + program.registers[index].name +
                               " has other last bits than " + value);
}

void VisitCalls::add(const std::string& name, MicroProgram program, const Names& loads, const Names& stores,
                     bool charged) {
    VisitCall call{name, programs_.size(), {}, {}, charged};
    for (const auto& [value, target] : loads) {
        Transfer t{ValueSpace::field, 0, target.empty(), 0};
        const std::size_t blank = value.find(' ');
        const std::string where = value.substr(0, blank);
        const std::string rest = blank == std::string::npos ? "" : value.substr(blank + 1);
        if (where == "voxel") {
            t.space = ValueSpace::voxel;
            t.from = found(voxel_, rest);
        } else if (where == "edge") {
            t.space = ValueSpace::edge;
            t.from = found(edge_, rest);
        } else {
            t.from = found(fields_, value);
        }
        if (t.to_field) {
            t.to = found(fields_, rest);
        } else {
            t.to = program.find(target);
            same_fraction(value, program, t.to);
        }
        call.loads.push_back(t);
    }
    for (const auto& [source, value] : stores) {
        call.stores.emplace_back(program.find(source), found(fields_, value));
        same_fraction(value, program, call.stores.back().first);
    }
    calls_.push_back(std::move(call));
    programs_.push_back(std::make_unique<MicroProgram>(std::move(program)));
}

std::size_t VisitCalls::field(const std::string& name) const {
    const auto at = std::find(fields_.begin(), fields_.end(), name);
    if (at == fields_.end()) throw std::logic_error("the traversal unit has no field " + name);
    return std::size_t(at - fields_.begin());
}

std::size_t VisitCalls::call(const std::string& name) const {
    for (std::size_t i = 0; i < calls_.size(); ++i) {
        if (calls_[i].name == name) return i;
    }
    throw std::logic_error("the traversal unit has no call " + name);
}

std::int64_t VisitCalls::word(ValueSpace space, const std::string& name, double value) const {
    const std::string full = (space == ValueSpace::voxel  ? "voxel "
                              : space == ValueSpace::edge ? "edge "
                                                          : "") +
                             name;
    const auto known = fractions_.find(full);
    const double scaled = std::ldexp(value, known == fractions_.end() ? 0 : known->second);
    if (scaled != std::floor(scaled)) throw std::logic_error("the traversal unit has no word for " + full);
    return std::int64_t(scaled);
}

}  // namespace raycell
