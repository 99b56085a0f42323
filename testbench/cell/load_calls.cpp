#include "testbench/cell/load_calls.hpp"

#include <algorithm>
#include <stdexcept>

#include "model/geometry/sources.hpp"
#include "model/machine/load_wire.hpp"
#include "model/microcode/programs.hpp"
#include "testbench/cell/visit_calls.hpp"

namespace raycell {
namespace {

using Names = UnitCalls::Names;
using List = std::vector<std::string>;

constexpr std::size_t most_edges = 4;

List with(List all, const List& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
}
List before(const std::string& prefix, const List& names) {
    List all;
    for (const std::string& name : names) all.push_back(prefix + name);
    return all;
}
Names pairs(const List& from, const List& to) {
    Names all;
    for (std::size_t i = 0; i < from.size(); ++i) all.emplace_back(from[i], to[i]);
    return all;
}
Names same(const List& names) { return pairs(names, names); }
Names joined(Names all, const Names& more) {
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

const List field_normals = {"bx", "by", "bz", "ux", "uy", "uz", "vx", "vy", "vz"};
/// What a piece has, and its voxel too, which keeps the first twelve.
const List piece_words =
    with(with({"near", "far", "c"}, field_normals),
         {"near level", "far level", "twice area", "point u", "point v", "plane u", "plane v"});
/// The same in the program that makes it.
const List made_words =
    with(with({"near", "far", "plane c"}, before("normal ", field_normals)),
         {"near level", "far level", "twice area", "point u", "point v", "plane u", "plane v"});

List edges_of(const List& words) {
    List all;
    for (std::size_t i = 0; i < most_edges; ++i) {
        for (const std::string& word : words) all.push_back(word + " " + std::to_string(i));
    }
    return all;
}

}  // namespace

LoadCalls::LoadCalls(const Context& context) {
    const PictureSettings& picture = context.settings;
    if (picture.hit != HitTest::edge || picture.normals != Normals::linear ||
        picture.display != Display::phong || picture.voxel_capacity != 0 ||
        picture.shadows != Shadows::per_hit || !SourceCounts(context.lights.sources, 1).points())
        throw std::invalid_argument(
            "loading in SystemVerilog: expected --hit edge, --normals linear, --display phong, "
            "--voxel-capacity "
            "0, --shadows per-hit and sources that are points");
    name_fields(context);
    find_parts(context);
    add_calls(context);
    write_messages();
    write_span();
    write_voxel();
    write_join();
    write_order();
    write_advance();
    write_finish();
    script_.finish();
}

/// Words that are moved together stand beside each other.
void LoadCalls::name_fields(const Context& context) {
    const VisitCalls visit(context);
    const auto add = [&](const List& names) {
        for (const std::string& name : names) unit_.add_field(name);
    };
    add(with(
        with({"type", "polygon", "x", "last", "axis", "negative", "nu", "nv", "c", "slack"}, field_normals),
        {"edges"}));
    add(edges_of({"edge a", "edge b", "edge c"}));
    add({"column", "drop x", "drop z"});
    stored_ =
        before("voxel ",
               with({"number", "polygon", "object", "drop x", "drop z", "nx", "ny", "nz", "edges", "first"},
                    {piece_words.begin(), piece_words.begin() + 12}));
    add(stored_);
    add(before("voxel ", {piece_words.begin() + 12, piece_words.end()}));
    add({"voxel pieces", "voxel place"});
    add(before("piece ", piece_words));
    add({"crossings"});
    for (std::size_t i = 0; i < most_edges; ++i) {
        for (const std::string& word : visit.edge_fields())
            unit_.add_field("kept " + word + " " + std::to_string(i));
    }
    edge_ = with(before("edge ", visit.edge_fields()), {"edge piece"});
    add(edge_);
    add({"line voxel", "line most", "line near"});
    object_ = {"cx", "cy", "cz", "kd", "ks", "transmit", "mirror", "shine", "ior"};
    add({"cx", "cy", "cz", "kd", "ks", "transmit", "shine exponent", "shine fraction", "ior", "mirrors"});
    source_ = {"sx", "sy", "sz", "source exponent", "ix", "iy", "iz"};
    add(source_);
    add({"sources", "source", "mirror", "shine", "made", "lines", "ends", "at", "place", "voxels end",
         "edges end", "table end", "lines end", "next number", "next object", "edge way"});
    for (const std::string& name : visit.voxel_fields())
        store_.push_back(name == "most" ? "line most" : "voxel " + name);
    shading_ = before(
        "voxel ", with({"object", "polygon", "near", "drop x", "drop z", "nx", "ny", "nz"}, field_normals));
}

void LoadCalls::find_parts(const Context& context) {
    const LoadWire wire(context.settings, context.arithmetic.formats());
    const auto find = [&](LoadType type, const Names& wanted, const std::string& repeats, bool with_sign) {
        int low = 0;
        int first = 0;
        std::vector<std::pair<std::string, LoadPart>> there;
        for (const WireField& field : wire.layout(type)) {
            there.push_back({field.name, {0, low, field.bits, with_sign}});
            low += field.bits;
            if (field.name == repeats) first = low;
        }
        for (const auto& [name, field] : wanted) {
            // The last of this name: behind "sources" some names come again.
            const auto at = std::find_if(there.rbegin(), there.rend(),
                                         [&, n = name](const auto& p) { return p.first == n; });
            LoadPart part = at->second;
            part.field = unit_.field(field);
            if (first > 0 && part.low >= first) part.stride = low - first;
            parts_.push_back(part);
        }
    };
    find(LoadType::span,
         {{"type", "type"},
          {"polygon", "polygon"},
          {"X1", "x"},
          {"Xr", "last"},
          {"axis", "axis"},
          {"sign", "negative"},
          {"edges", "edges"}},
         "", false);
    find(LoadType::span,
         joined({{"slope u", "nu"}, {"slope v", "nv"}, {"offset", "c"}, {"slack", "slack"}},
                pairs({"n x", "n y", "n z", "nu x", "nu y", "nu z", "nv x", "nv y", "nv z"}, field_normals)),
         "", true);
    for (std::size_t i = 0; i < most_edges; ++i) {
        const std::string number = " " + std::to_string(i);
        const std::size_t first = parts_.size();
        find(LoadType::span,
             {{"edge a", "edge a" + number}, {"edge b", "edge b" + number}, {"edge c", "edge c" + number}},
             "edges", true);
        for (std::size_t p = first; p < parts_.size(); ++p) {
            parts_[p].low += int(i) * parts_[p].stride;
            parts_[p].stride = 0;
        }
    }
    find(LoadType::features,
         {{"red", "cx"},
          {"green", "cy"},
          {"blue", "cz"},
          {"Kd", "kd"},
          {"Ks", "ks"},
          {"T", "transmit"},
          {"Shine exponent", "shine exponent"},
          {"Shine fraction", "shine fraction"},
          {"index", "ior"},
          {"mirror", "mirrors"}},
         "", false);
    find(LoadType::viewer, {{"sources", "sources"}}, "", false);
    find(LoadType::viewer,
         {{"place x", "sx"},
          {"place y", "sy"},
          {"place z", "sz"},
          {"place exponent", "source exponent"},
          {"red", "ix"},
          {"green", "iy"},
          {"blue", "iz"}},
         "sources", true);
}

void LoadCalls::add_calls(const Context& context) {
    MicroSetting s{context.settings.numbers, extent_of(context.scene.frame), {}};
    s.datapath = datapaths(s.numbers.word_bits, widest_operand(s.formats())).front();
    const DepthLevels levels{context.scene.frame.level(), context.scene.frame.depth_levels};
    const List all_edges = edges_of({"edge a", "edge b", "edge c"});
    const List kept = edges_of({"kept a", "kept b", "kept c"});
    unit_.add("voxel", voxel_program(s, levels, HitTest::edge, Normals::linear),
              same(with(with({"drop x", "drop z", "negative", "nu", "nv", "c", "slack", "edges"}, all_edges),
                        field_normals)),
              joined(joined({{"made", "made"}}, pairs(made_words, before("piece ", piece_words))),
                     joined({{"crossings", "crossings"}}, same(kept))),
              true);
    const List run = {"near level", "far level", "near", "point u", "point v", "twice area"};
    unit_.add("join", join_program(s, levels),
              joined(joined(pairs(before("voxel ", run), run), {{"drop z", "drop z"}}),
                     pairs(before("piece ", run), {"piece near level", "piece far level", "piece near",
                                                   "piece point u", "piece point v", "piece area"})),
              joined(joined(pairs(run, before("voxel ", run)), {{"far", "voxel far"}}),
                     same({"anchor v", "way", "piece way"})),
              false);
    unit_.add("plane", plane_of_voxel_program(s),
              joined(same({"nu", "nv", "c", "negative", "drop z", "anchor v"}),
                     {{"voxel near", "near"}, {"voxel point u", "point u"}}),
              {{"plane u", "voxel plane u"}, {"plane v", "voxel plane v"}, {"plane c", "voxel c"}}, false);
    unit_.add("normals", normal_of_voxel_program(s, Normals::linear),
              joined(same(with({"drop z", "anchor v"}, field_normals)),
                     {{"voxel near", "near"}, {"voxel point u", "point u"}, {"voxel point v", "point v"}}),
              pairs(before("normal ", field_normals), before("voxel ", field_normals)), false);
    unit_.add("components", components_program(s),
              joined(same({"negative", "drop x", "drop z"}),
                     {{"voxel plane u", "plane u"}, {"voxel plane v", "plane v"}}),
              {{"nx", "voxel nx"}, {"ny", "voxel ny"}, {"nz", "voxel nz"}}, false);
    unit_.add("move edge", move_edge_program(s), {{"edge b", "b"}, {"edge c", "c"}, {"edge way", "way"}},
              {{"c", "edge c"}}, false);
    unit_.add("widen", widen_program(s), {{"line most", "most"}, {"voxel far", "far"}},
              {{"most", "line most"}}, false);
    unit_.add(
        "order", order_program(s),
        {{"voxel near", "near"}, {"voxel far", "far"}, {"line near", "line near"}, {"line most", "most"}},
        {{"before", "before"}, {"most", "line most"}}, true);
    unit_.add("advance", advance_program(s, HitTest::edge, Normals::linear),
              same(with(with({"x", "last", "drop x", "negative", "nu", "c", "edges", "bx", "by", "bz", "ux",
                              "uy", "uz"},
                             edges_of({"edge a"})),
                        edges_of({"edge c"}))),
              same(with({"passes", "x", "c", "bx", "by", "bz"}, edges_of({"edge c"}))), true);
    unit_.add("shine", shine_program(s), {{"shine exponent", "exponent"}, {"shine fraction", "fraction"}},
              {{"shine", "shine"}}, false);
    unit_.add("source place", source_place_program(s),
              joined(same({"sx", "sy", "sz"}), {{"source exponent", "exponent"}}),
              joined(same({"sx", "sy", "sz"}), {{"exponent", "source exponent"}}), false);
}

std::string LoadCalls::constants() const {
    const auto number = [](const char* name, std::size_t value) {
        return constant_line(name, std::int64_t(value));
    };
    std::string text =
        script_.constants() + number("VOXEL_STRIDE", voxel_stride()) + number("EDGE_STRIDE", edge_stride()) +
        number("LINE_WORDS", line_stride()) + number("SHADING_VOXEL_WORDS", shading_.size()) +
        number("SHADING_OBJECT_WORDS", object_.size()) + number("SHADING_SOURCE_WORDS", source_.size());
    const auto order = [&](const char* whose, const List& names, std::size_t cut) {
        for (std::size_t i = 0; i < names.size(); ++i)
            text += number((std::string(whose) + constant_name(names[i].substr(cut))).c_str(), i);
    };
    order("V_", shading_, std::string("voxel ").size());
    order("O_", object_, 0);
    order("S_", source_, 0);
    return text;
}

}  // namespace raycell
