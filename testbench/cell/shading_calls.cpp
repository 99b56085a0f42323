#include "testbench/cell/shading_calls.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/microcode/programs.hpp"

namespace raycell {
namespace {

constexpr const char* space_names[] = {"", "voxel", "object", "source", "slot", "port", "out"};

void check(const Context& context) {
    const PictureSettings& picture = context.settings;
    const auto refuse = [](const std::string& what, const std::string& expected) {
        throw std::invalid_argument("the shading unit in SystemVerilog has no " + what + "; expected " +
                                    expected);
    };
    for (const Source& source : context.lights.sources) {
        if (source.kind != SourceKind::point)
            refuse(std::string("source of kind ") + name_of(source.kind), "point sources alone");
    }
    if (picture.normals != Normals::linear) refuse("other normals", "--normals linear");
    if (picture.shadows != Shadows::per_hit) refuse("other shadows", "--shadows per-hit");
    if (picture.numbers.operators.power == PowerMethod::rounded)
        refuse("power correctly rounded", "--power tables or schlick");
}

}  // namespace

ShadingCalls::ShadingCalls(const Context& context, const CostTable& costs) {
    check(context);
    add_programs(context);
    // The order in which loading writes them.
    for (const char* name :
         {"voxel object", "voxel polygon", "voxel near", "voxel drop x", "voxel drop z", "voxel gx",
          "voxel gy", "voxel gz", "object cx", "object cy", "object cz", "object kd", "object ks",
          "object transmit", "object mirror", "object shine", "object ior"})
        found(name);
    add_setup_calls();
    add_shade_calls();
    write_script(context, costs);
    std::vector<const MicroProgram*> all;
    for (const auto& program : programs_) all.push_back(program.get());
    image_ = std::make_unique<MicroImage>(all, true);
}

void ShadingCalls::add_programs(const Context& context) {
    MicroSetting s{context.settings.numbers, extent_of(context.scene.frame), {}};
    s.datapath = datapaths(s.numbers.word_bits, widest_operand(s.formats())).front();
    ChildLimits limits;
    limits.max_depth = context.settings.max_depth;
    limits.min_weight = context.settings.min_weight;
    for (MicroProgram& program : std::vector<MicroProgram>{
             setup_program(s, limits), place_program(s), normal_program(s), source_program(s),
             start_program(s, context.normal_offset), reflect_program(s), refract_program(s),
             ambient_program(s), light_program(s), total_program(s), nothing_program(s)})
        programs_.push_back(std::make_unique<MicroProgram>(std::move(program)));
}

// A program's results go straight into the registers of those that need them. Those that hold for all lights
// or children of a hit are copied once.

void ShadingCalls::add_setup_calls() {
    call("place", "place",
         {{"voxel object", "out object"},
          {"voxel polygon", "out polygon"},
          {"setup.*", "place.*"},
          {"setup.d*", "place.d*"},
          {"setup.t", "place.t"},
          {"voxel near", "place.base"},
          {"voxel drop x", "place.drop x"},
          {"voxel drop z", "place.drop z"}},
         {{"place.u", "normal.u"}, {"place.v", "normal.v"}});
    call("normal", "normal",
         {{"voxel b*", "normal.b*"}, {"voxel u*", "normal.u*"}, {"voxel v*", "normal.v*"}},
         {{"normal.f*", "setup.f*"}});
    call("setup", "setup",
         {{"voxel g*", "setup.g*"}, {"object mirror", "setup.mirror"}, {"object transmit", "setup.transmit"}},
         {{"setup.reflects", "out reflects"},
          {"setup.refracts", "out refracts"},
          {"setup.p*", "source.p*"},
          {"setup.n*", "source.n*"},
          {"port x", "source.cell x"},
          {"port y", "source.cell y"},
          {"setup.p*", "start.p*"},
          {"setup.g*", "start.n*"},
          {"voxel object", "slot object"},
          {"setup.reflects", "slot reflects"},
          {"setup.p*", "slot p*"},
          {"setup.n*", "slot n*"},
          {"setup.d*", "slot d*"}});
    call("source", "source", {{"source s*", "source.s*"}, {"source exponent", "source.exponent"}},
         {{"source.cosine", "out cosine"}});
    const Names child = {{"start.*", "out *"},        {"start.d*", "out d*"}, {"start.mx", "out mx"},
                         {"start.ex", "out ex"},      {"start.my", "out my"}, {"start.ey", "out ey"},
                         {"start.front", "out front"}};
    call("shadow", "start", {{"source.l*", "start.d*"}, {"source.reach", "out reach"}}, child);
    call("reflect", "reflect", {{"setup.d*", "reflect.d*"}, {"setup.n*", "reflect.n*"}},
         {{"reflect.r*", "start.d*"}, {"reflect.r*", "slot r*"}, {"object mirror", "start.share"}});
    call("refract", "refract",
         {{"setup.d*", "refract.d*"},
          {"setup.n*", "refract.n*"},
          {"object ior", "refract.ior"},
          {"setup.entering", "refract.entering"}},
         {{"refract.r*", "start.d*"}, {"object transmit", "start.share"}});
    Names weighed = child;
    weighed.emplace_back("start.weight", "out weight");
    call("secondary", "start", {{"setup.weight", "start.weight"}}, weighed);
}

void ShadingCalls::add_shade_calls() {
    call("ambient", "ambient",
         {{"slot object", "out object"},
          {"slot reflects", "out reflects"},
          {"object kd", "ambient.kd"},
          {"object c*", "ambient.c*"}},
         {{"ambient.s*", "light.s*"}});
    // What holds for all lights.
    call("lights", "nothing",
         {{"object kd", "light.kd"},
          {"object ks", "light.ks"},
          {"object shine", "light.shine"},
          {"object c*", "light.c*"},
          {"slot p*", "source.p*"},
          {"slot n*", "source.n*"},
          {"port x", "source.cell x"},
          {"port y", "source.cell y"}},
         {{"object ks", "out ks"}});
    call("kept", "nothing", {{"slot rx", "light.rx"}, {"slot ry", "light.ry"}}, {{"slot rz", "light.rz"}});
    call("mirrored", "reflect", {{"slot d*", "reflect.d*"}, {"slot n*", "reflect.n*"}},
         {{"reflect.r*", "light.r*"}});
    call("again", "source", {{"source s*", "source.s*"}, {"source exponent", "source.exponent"}},
         {{"source.cosine", "light.cosine"}, {"source.l*", "light.l*"}});
    call("light", "light", {{"source i*", "light.i*"}}, {});
    call("total", "total",
         {{"light.sx", "total.local x"},
          {"light.sy", "total.local y"},
          {"light.sz", "total.local z"},
          {"object mirror", "total.mirror"},
          {"object transmit", "total.transmit"},
          {"port reflected *", "total.reflected *"},
          {"port refracted *", "total.refracted *"}},
         {{"total.sum x", "out red"}, {"total.sum y", "out green"}, {"total.sum z", "out blue"}});
}

void ShadingCalls::write_script(const Context& context, const CostTable& costs) {
    using Op = ShadeStep::Op;
    const OperatorSettings& operators = context.settings.numbers.operators;
    const std::uint32_t root = costs.root(operators);
    const std::uint32_t reciprocal = costs.reciprocal(operators);
    const std::uint32_t start = costs.ray_start + 2 * reciprocal;
    std::map<std::string, std::size_t> labels;
    std::vector<std::pair<std::size_t, std::string>> targets;
    const auto step = [&](Op op, const std::string& target = "", std::size_t argument = 0) {
        if (!target.empty()) targets.emplace_back(script_.size(), target);
        script_.push_back({op, argument, 0, 0});
    };
    const auto calls = [&](const std::string& name, std::uint32_t charge) {
        script_.push_back({Op::call, number_of(name), 0, charge});
    };
    const auto label = [&](const std::string& name) { labels[name] = script_.size(); };
    const auto positive = [&](const std::string& word, const std::string& otherwise) {
        step(Op::if_positive, otherwise, place("out " + word).number);
    };
    const auto free = [&](std::uint32_t cycles) { return cycles > 0 ? cycles + root : 0; };
    const std::size_t secondary = std::max<std::size_t>(context.lights.sources.size(), 1);

    calls("place", 0);
    calls("normal", costs.normal_linear);
    calls("setup", costs.shade_setup + root);
    step(Op::first_light);
    label("view");
    step(Op::if_light, "viewed");
    calls("source", costs.source_view + root);
    positive("cosine", "averted");
    step(Op::faces);
    calls("shadow", start);
    step(Op::emit_light);
    label("averted");
    step(Op::next_light, "view");
    label("viewed");
    positive("reflects", "no reflection");
    calls("reflect", costs.reflect + root);
    calls("secondary", start);
    step(Op::emit, "", secondary);
    label("no reflection");
    positive("refracts", "no refraction");
    calls("refract", costs.refract + reciprocal + 2 * root);
    calls("secondary", start);
    step(Op::emit, "", secondary + 1);
    label("no refraction");
    step(Op::end_of_setup);

    shade_entry_ = script_.size();
    calls("ambient", costs.local_intensity);
    step(Op::if_any_lit, "lit");
    calls("lights", 0);
    positive("ks", "shines");
    positive("reflects", "mirrors");
    calls("kept", 0);
    step(Op::jump, "shines");
    label("mirrors");
    calls("mirrored", free(costs.mirrored));
    label("shines");
    step(Op::first_light);
    label("add");
    step(Op::if_light, "lit");
    step(Op::if_lit, "dark");
    calls("again", free(costs.light_again));
    calls("light", costs.per_lit_source + costs.power(operators));
    label("dark");
    step(Op::next_light, "add");
    label("lit");
    calls("total", 0);
    step(Op::end);
    for (const auto& [at, name] : targets) script_[at].target = labels.at(name);
}

void ShadingCalls::call(const std::string& name, const std::string& program, const Names& before,
                        const Names& after) {
    const ShadePlace any = found(program + "." + "");
    calls_.push_back({name, any.program, copies(before), copies(after)});
}

std::vector<ShadeCopy> ShadingCalls::copies(const Names& names) {
    std::vector<ShadeCopy> all;
    const auto add = [&](const std::string& from, const std::string& to) {
        const ShadeCopy copy{found(from), found(to)};
        const auto fraction = [&](const ShadePlace& p) {
            return programs_[p.program]->registers[p.number].fraction;
        };
        // A copy moves bits: what they are worth must not change. Outside of registers that is not stated.
        const bool from_register = copy.from.space == ShadeSpace::own;
        const bool to_register = copy.to.space == ShadeSpace::own;
        const int known = from_register                ? fraction(copy.from)
                          : fractions_.count(from) > 0 ? fractions_.at(from)
                          : to_register                ? fraction(copy.to)
                                                       : 0;
        if (!from_register) fractions_.emplace(from, known);
        const int there = to_register ? fraction(copy.to) : fractions_.emplace(to, known).first->second;
        if (there != known) throw std::logic_error(from + " has other last bits than " + to);
        all.push_back(copy);
    };
    for (const auto& [from, to] : names) {
        if (from.back() != '*') {
            add(from, to);
            continue;
        }
        for (const char axis : {'x', 'y', 'z'})
            add(from.substr(0, from.size() - 1) + axis, to.substr(0, to.size() - 1) + axis);
    }
    return all;
}

/// The place of that name, which is made unless it is a register. "setup." alone names a program.
ShadePlace ShadingCalls::found(const std::string& name) {
    for (std::size_t space = 1; space < shade_spaces; ++space) {
        const std::string before = std::string(space_names[space]) + " ";
        if (name.compare(0, before.size(), before) != 0) continue;
        std::vector<std::string>& words = words_[space];
        const std::string word = name.substr(before.size());
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
        break;
    }
    return place(name);
}

ShadePlace ShadingCalls::place(const std::string& name) const {
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos) {
        const std::size_t blank = name.find(' ');
        for (std::size_t space = 1; space < shade_spaces; ++space) {
            if (name.substr(0, blank) != space_names[space]) continue;
            const auto& words = words_[space];
            const auto at = std::find(words.begin(), words.end(), name.substr(blank + 1));
            if (at != words.end()) return {ShadeSpace(space), std::size_t(at - words.begin()), 0};
        }
    } else {
        for (std::size_t p = 0; p < programs_.size(); ++p) {
            if (programs_[p]->name != name.substr(0, dot)) continue;
            if (dot + 1 == name.size()) return {ShadeSpace::own, 0, p};
            return {ShadeSpace::own, programs_[p]->find(name.substr(dot + 1)), p};
        }
    }
    throw std::logic_error("the shading unit has no " + name);
}

std::int64_t ShadingCalls::word(const std::string& name, double value) const {
    const ShadePlace at = place(name);
    const int fraction = at.space == ShadeSpace::own ? programs_[at.program]->registers[at.number].fraction
                         : fractions_.count(name)    ? fractions_.at(name)
                                                     : 0;
    const double scaled = std::ldexp(value, fraction);
    if (scaled != std::floor(scaled)) throw std::logic_error("the shading unit has no such word for " + name);
    return std::int64_t(scaled);
}

std::size_t ShadingCalls::number(const ShadePlace& place) const {
    return place.space == ShadeSpace::own ? image_->first_register(place.program) + place.number
                                          : place.number;
}

std::size_t ShadingCalls::number_of(const std::string& call) const {
    for (std::size_t i = 0; i < calls_.size(); ++i) {
        if (calls_[i].name == call) return i;
    }
    throw std::logic_error("the shading unit has no call " + call);
}

}  // namespace raycell
