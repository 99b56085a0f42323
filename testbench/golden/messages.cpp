#include "testbench/golden/messages.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "testbench/golden/fields.hpp"

namespace raycell {
namespace {

constexpr const char* ray_kinds[] = {"primary", "reflected", "refracted", "shadow", "memo", "precast"};
constexpr const char* answer_types[] = {"intensity", "lit", "blocked", "postponed"};
constexpr const char* load_types[] = {"setup",   "features", "polygon",     "surface",
                                      "trapeze", "span",     "end_of_scene"};

// The fields of rays and answers: those of the tables in docs/reference/messages.md, in their order.

/// Where an answer belongs. Returns whether that is the pixel.
template <typename A, typename M>
bool address_of(A& a, M& message, bool of_pixel) {
    a.number("home_x", message.home_x, 4095);
    a.number("home_y", message.home_y, 4095);
    a.slot("slot", message.slot, of_pixel);
    a.number("child", message.child, 63);
    return of_pixel;
}

template <typename A, typename R>
bool fields_of_ray(A& a, R& ray, bool shadow) {
    const Formats& f = a.formats();
    a.word("x", ray.position.x, f.unit);
    a.word("y", ray.position.y, f.unit);
    a.word("z", ray.position.z, f.depth);
    fields_of_vector(a, {"dx", "dy", "dz"}, ray.direction, f.unit);
    a.reciprocal("1/dx", ray.inverse_x, ray.direction.x);
    a.reciprocal("1/dy", ray.inverse_y, ray.direction.y);
    if (shadow) {
        a.reach("reach", ray.reach);
    } else {
        a.word("weight", ray.weight, f.unit);
    }
    a.polygon("polygon_left", ray.leaves);
    if (!shadow) a.number("generation", ray.generation, 63);
    a.number("outside", ray.outside, 1);
    return address_of(a, ray, ray.kind == RayKind::primary);
}

template <typename A, typename T>
bool fields_of_answer(A& a, T& answer) {
    if (answer.kind == Answer::Kind::intensity)
        fields_of_vector(a, {"red", "green", "blue"}, answer.colour, a.formats().intensity);
    return address_of(a, answer, answer.ray_kind == RayKind::primary);
}

// The fields of load messages.

template <typename A, typename N>
void fields_of_normal(A& a, N& normal) {
    const Format& f = a.formats().loading;
    fields_of_vector(a, {"n0x", "n0y", "n0z"}, normal.base, f);
    fields_of_vector(a, {"nux", "nuy", "nuz"}, normal.du, f);
    fields_of_vector(a, {"nvx", "nvy", "nvz"}, normal.dv, f);
}

template <typename A, typename S>
void fields_of_span(A& a, S& span) {
    const Format& f = a.formats().loading;
    a.number("polygon", span.polygon, no_polygon - 1);
    a.number("x1", span.x, 4095);
    a.number("xr", span.last, 4095);
    if (a.form().hit == HitTest::depth) {
        a.word("z", span.z, f);
        a.word("dz", span.dz, f);
        a.number("axis", span.drop, 2);
        fields_of_vector(a, {"nx", "ny", "nz"}, span.plane.n, a.formats().unit);
        if (a.form().normals == Normals::voxel) {
            fields_of_vector(a, {"ncx", "ncy", "ncz"}, span.n, f);
            fields_of_vector(a, {"dncx", "dncy", "dncz"}, span.dn, f);
        } else {
            fields_of_normal(a, span.normal);
        }
    } else {
        a.number("axis", span.drop, 2);
        fields_of_vector(a, {"nx", "ny", "nz"}, span.plane.n, f);
        a.word("c", span.plane.c, f);
        a.word("slack", span.slack[span.drop], f);
        fields_of_normal(a, span.normal);
        a.number("edges", span.edge_count, 4);
        for (int i = 0; i < span.edge_count; ++i) {
            auto& edge = span.edges[std::size_t(i)];
            a.word("a", edge.a, f);
            a.word("b", edge.b, f);
            a.word("c", edge.c, f);
        }
    }
    if (!a.form().gouraud) return;
    fields_of_vector(a, {"red", "green", "blue"}, span.intensity, f);
    fields_of_vector(a, {"d_red", "d_green", "d_blue"}, span.d_intensity, f);
}

template <typename A, typename L>
void fields_of_load(A& a, L& item) {
    if (item.kind == LoadItem::Kind::features) a.number("object", item.object, 0xffffffffU);
    if (item.kind == LoadItem::Kind::span) fields_of_span(a, item.span);
}

std::string id_text(std::uint64_t id, RayKind kind) {
    return "pixel " + std::to_string(pixel_of(id)) + " branch " + std::to_string(branch_of(id)) + " kind " +
           ray_kinds[std::size_t(kind)];
}

/// A reader of the remark with this name, or none.
std::optional<FieldReader> remark(const Words& words, const std::vector<std::string>& remarks,
                                  const char* name) {
    const auto at = std::find(remarks.begin(), remarks.end(), name);
    if (at == remarks.end()) return std::nullopt;
    return FieldReader(words, remarks, std::size_t(at - remarks.begin()) + 1);
}

std::uint64_t read_id(const Words& words, const std::vector<std::string>& remarks) {
    std::uint64_t pixel = 0;
    std::uint64_t branch = 0;
    if (auto reader = remark(words, remarks, "pixel")) reader->number("pixel", pixel, 0xffffffffU);
    if (auto reader = remark(words, remarks, "branch")) reader->number("branch", branch, 0xffffffffU);
    return ray_id(pixel, std::uint32_t(branch));
}

RayKind shadow_kind(const KindRules& rules) {
    if (rules.precast) return RayKind::precast;
    return rules.shadows == Shadows::memo ? RayKind::memo : RayKind::shadow;
}

RayKind kind_of_child(bool of_pixel, unsigned child) {
    if (of_pixel) return RayKind::primary;
    return child == 0 ? RayKind::reflected : RayKind::refracted;
}

Ray read_ray(FieldReader& reader, bool shadow, const KindRules& rules) {
    Ray ray;
    ray.fresh = false;
    const bool of_pixel = fields_of_ray(reader, ray, shadow);
    if (of_pixel && shadow) throw GoldenError("field 'slot': expected a number: a shadow ray is of no pixel");
    if (!shadow && of_pixel != (ray.generation == 0))
        throw GoldenError("field 'slot': expected '" + std::string(pixel_slot) +
                          "' for a ray of generation 0, a number for all others");
    ray.kind = shadow ? shadow_kind(rules) : kind_of_child(of_pixel, ray.child);
    return ray;
}

Answer read_answer(FieldReader& reader, Answer::Kind kind, const KindRules& rules) {
    Answer answer;
    answer.kind = kind;
    const bool of_pixel = fields_of_answer(reader, answer);
    const bool verdict = kind == Answer::Kind::lit || kind == Answer::Kind::blocked;
    if (of_pixel && verdict) throw GoldenError("field 'slot': expected a number: a verdict is of no pixel");
    answer.ray_kind = verdict ? shadow_kind(rules) : kind_of_child(of_pixel, answer.child);
    return answer;
}

LoadItem read_load(const Words& words, FieldReader& reader, LoadItem::Kind kind,
                   const std::vector<std::string>& remarks) {
    LoadItem item;
    item.kind = kind;
    fields_of_load(reader, item);
    if (kind != LoadItem::Kind::span) return item;
    if (auto other = remark(words, remarks, "object")) other->number("object", item.span.object, 0xffffffffU);
    const double dominant = std::abs(item.span.plane.n[item.span.drop]);
    if (!words.exact() && dominant != 1)
        throw GoldenError("field 'axis': expected that of the component of the normal that is 1 or -1");
    return item;
}

template <typename T>
Message kept(const T& content, Pool<T>& pool) {
    T* place = pool.take();
    *place = content;
    return Message(place);
}

template <std::size_t N>
std::size_t index_of(const char* const (&names)[N], const std::string& name) {
    return std::size_t(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}

bool is_ray_type(const std::string& type) { return type == "ray" || type == "shadow_ray"; }

}  // namespace

std::string text_of(const Words& words, const Message& message) {
    FieldWriter writer(words);
    switch (message.kind) {
        case Message::Kind::ray: {
            const Ray& ray = message.ray->ray;
            fields_of_ray(writer, ray, is_shadow(ray.kind));
            return (is_shadow(ray.kind) ? "shadow_ray" : "ray") + writer.text;
        }
        case Message::Kind::answer: {
            const Answer& answer = *message.answer;
            fields_of_answer(writer, answer);
            return answer_types[std::size_t(answer.kind)] + writer.text;
        }
        case Message::Kind::load: {
            const LoadItem& item = *message.load;
            fields_of_load(writer, item);
            return load_types[std::size_t(item.kind)] + writer.text;
        }
        case Message::Kind::none:
            break;
    }
    return "none";
}

std::string remarks_of(const Message& message) {
    switch (message.kind) {
        case Message::Kind::ray:
            return id_text(message.ray->ray.id, message.ray->ray.kind);
        case Message::Kind::answer:
            return id_text(message.answer->id, message.answer->ray_kind);
        case Message::Kind::load: {
            if (message.load->kind != LoadItem::Kind::span) return "";
            return "object " + std::to_string(message.load->span.object);
        }
        case Message::Kind::none:
            break;
    }
    return "";
}

std::vector<std::string> field_names(const Words& words, const std::vector<std::string>& tokens) {
    FieldNames names(words);
    const std::string& type = tokens.at(0);
    const std::size_t answer_type = index_of(answer_types, type);
    if (is_ray_type(type)) {
        Ray ray;
        fields_of_ray(names, ray, type != "ray");
    } else if (answer_type < std::size(answer_types)) {
        Answer answer;
        answer.kind = Answer::Kind(answer_type);
        fields_of_answer(names, answer);
    } else {
        LoadItem item;
        const std::size_t load_type = index_of(load_types, type);
        if (load_type < std::size(load_types)) item.kind = LoadItem::Kind(load_type);
        fields_of_load(names, item);
        // The text says how many edges follow.
        const auto at =
            std::size_t(std::find(names.all.begin(), names.all.end(), "edges") - names.all.begin());
        const std::string& count = at + 1 < tokens.size() ? tokens[at + 1] : "";
        if (count.size() == 1 && count[0] >= '0' && count[0] <= '4') item.span.edge_count = count[0] - '0';
        names.all.clear();
        fields_of_load(names, item);
    }
    return names.all;
}

Message read_message(const Words& words, const std::vector<std::string>& tokens,
                     const std::vector<std::string>& remarks, const KindRules& rules, MessagePools& pools) {
    FieldReader reader(words, tokens);
    const std::string& type = tokens.at(0);
    if (is_ray_type(type)) {
        RayPacket packet;
        packet.ray = read_ray(reader, type != "ray", rules);
        packet.ray.id = read_id(words, remarks);
        reader.finish();
        return kept(packet, pools.rays);
    }
    const std::size_t answer_type = index_of(answer_types, type);
    if (answer_type < std::size(answer_types)) {
        Answer answer = read_answer(reader, Answer::Kind(answer_type), rules);
        answer.id = read_id(words, remarks);
        reader.finish();
        return kept(answer, pools.answers);
    }
    const std::size_t load_type = index_of(load_types, type);
    const auto kind = LoadItem::Kind(load_type);
    if (load_type == std::size(load_types) || kind == LoadItem::Kind::polygon ||
        kind == LoadItem::Kind::surface || kind == LoadItem::Kind::trapeze)
        throw GoldenError("'" + type.substr(0, 60) +
                          "': expected ray, shadow_ray, intensity, lit, blocked, postponed, setup, features, "
                          "span or end_of_scene");
    const LoadItem item = read_load(words, reader, kind, remarks);
    reader.finish();
    return kept(item, pools.loads);
}

std::string difference(const Words& words, const std::vector<std::string>& is,
                       const std::vector<std::string>& expected) {
    if (is.size() != expected.size() || is.empty() || is[0] != expected[0]) return "";
    return difference(is, expected, field_names(words, is));
}

std::string difference(const std::vector<std::string>& is, const std::vector<std::string>& expected,
                       const std::vector<std::string>& names) {
    for (std::size_t i = 1; i < is.size(); ++i) {
        if (expected[i] == is[i]) continue;
        const std::string name = i - 1 < names.size() ? names[i - 1] : "number " + std::to_string(i);
        return "field '" + name + "' is " + is[i] + ", expected " + expected[i];
    }
    return "";
}

void give_back(const Message& message, MessagePools& pools) {
    if (message.kind == Message::Kind::ray) pools.rays.give_back(message.ray);
    if (message.kind == Message::Kind::answer) pools.answers.give_back(message.answer);
    if (message.kind == Message::Kind::load) pools.loads.give_back(message.load);
}

}  // namespace raycell
