#include "testbench/golden/messages.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

namespace raycell {
namespace {

constexpr const char* ray_kinds[] = {"primary", "reflected", "refracted", "shadow", "memo", "precast"};
constexpr const char* answer_kinds[] = {"intensity", "lit", "blocked", "postponed"};
constexpr const char* load_kinds[] = {"setup",   "features", "polygon",     "surface",
                                      "trapeze", "span",     "end_of_scene"};

struct Choice {
    const char* const* words;
    std::size_t count;
};
constexpr Choice ray_kind_names{ray_kinds, std::size(ray_kinds)};
constexpr Choice answer_kind_names{answer_kinds, std::size(answer_kinds)};

class Writer {
  public:
    explicit Writer(const Words& words) : words_(words) {}
    const Formats& formats() const { return words_.formats(); }
    void word(const char*, double value, const Format& format) { add(words_.word(format, value)); }
    void floating(const char*, double value, int bits) { add(words_.floating(bits, value)); }
    template <typename T>
    void number(const char*, T value, std::uint64_t) {
        add(std::to_string(value));
    }
    /// -1: none.
    void polygon(const char*, std::uint32_t value) {
        add(value == no_polygon ? "-1" : std::to_string(value));
    }
    template <typename E>
    void choice(const char*, E value, const Choice& names) {
        add(names.words[std::size_t(value)]);
    }
    std::string text;

  private:
    void add(const std::string& token) { text += " " + token; }
    const Words& words_;
};

class Reader {
  public:
    Reader(const Words& words, const std::vector<std::string>& tokens) : words_(words), tokens_(tokens) {}
    const Formats& formats() const { return words_.formats(); }
    void word(const char* name, double& value, const Format& format) {
        const std::string& token = next(name);
        named(name, [&] { value = words_.read_word(format, token); });
    }
    void floating(const char* name, double& value, int bits) {
        const std::string& token = next(name);
        named(name, [&] { value = words_.read_floating(bits, token); });
    }
    template <typename T>
    void number(const char* name, T& value, std::uint64_t most) {
        const std::string& token = next(name);
        std::uint64_t read = 0;
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, read);
        if (stop != end || error != std::errc() || read > most)
            refuse(name, token, "a number from 0 to " + std::to_string(most));
        value = T(read);
    }
    void polygon(const char* name, std::uint32_t& value) {
        if (at_ < tokens_.size() && tokens_[at_] == "-1") {
            ++at_;
            value = no_polygon;
        } else {
            number(name, value, no_polygon - 1);
        }
    }
    template <typename E>
    void choice(const char* name, E& value, const Choice& names) {
        const std::string& token = next(name);
        std::string all;
        for (std::size_t i = 0; i < names.count; ++i) {
            if (token == names.words[i]) {
                value = E(i);
                return;
            }
            all += std::string(i ? ", " : "") + names.words[i];
        }
        refuse(name, token, "one of " + all);
    }
    void finish() const {
        if (at_ == tokens_.size()) return;
        throw GoldenError("'" + tokens_[at_].substr(0, 60) + "': expected no more fields");
    }

  private:
    const std::string& next(const char* name) {
        if (at_ == tokens_.size()) throw GoldenError(std::string("field '") + name + "' is missing");
        return tokens_[at_++];
    }
    template <typename F>
    void named(const char* name, F&& read) {
        try {
            read();
        } catch (const GoldenError& error) {
            throw GoldenError(std::string("field '") + name + "': " + error.what());
        }
    }
    [[noreturn]] static void refuse(const char* name, const std::string& token, const std::string& expected) {
        throw GoldenError(std::string("field '") + name + "': '" + token.substr(0, 60) + "': expected " +
                          expected);
    }
    const Words& words_;
    const std::vector<std::string>& tokens_;
    std::size_t at_ = 1;  ///< after the kind
};

class Names {
  public:
    const Formats& formats() const { return formats_; }
    void word(const char* name, double, const Format&) { add(name); }
    void floating(const char* name, double, int) { add(name); }
    template <typename T>
    void number(const char* name, T, std::uint64_t) {
        add(name);
    }
    void polygon(const char* name, std::uint32_t) { add(name); }
    template <typename E>
    void choice(const char* name, E, const Choice&) {
        add(name);
    }
    std::vector<std::string> all;

  private:
    void add(const char* name) { all.emplace_back(name); }
    Formats formats_;
};

template <typename A, typename V>
void vector(A& a, const std::array<const char*, 3>& names, V& v, const Format& format) {
    for (int axis = 0; axis < 3; ++axis) a.word(names[std::size_t(axis)], v[axis], format);
}

/// A ray's id: the pixel whose tree it belongs to and its branch there. Only the model has it; the cell's
/// messages have no such field.
template <typename A, typename Id>
void id_of(A& a, Id& id) {
    std::uint64_t pixel = pixel_of(id);
    std::uint64_t branch = branch_of(id);
    a.number("pixel", pixel, 0xffffffffU);
    a.number("branch", branch, 0xffffffffU);
    if constexpr (!std::is_const_v<Id>) id = ray_id(pixel, std::uint32_t(branch));
}

template <typename A, typename R>
void fields_of_ray(A& a, R& ray) {
    const Formats& f = a.formats();
    id_of(a, ray.id);
    a.choice("kind", ray.kind, ray_kind_names);
    a.number("generation", ray.generation, 63);
    a.number("home_x", ray.home_x, 4095);
    a.number("home_y", ray.home_y, 4095);
    a.number("slot", ray.slot, 0xffffffffU);
    a.number("child", ray.child, 63);
    a.word("x", ray.position.x, f.unit);
    a.word("y", ray.position.y, f.unit);
    a.word("z", ray.position.z, f.depth);
    vector(a, {"dx", "dy", "dz"}, ray.direction, f.unit);
    a.floating("rx", ray.inverse_x, f.word_bits);
    a.floating("ry", ray.inverse_y, f.word_bits);
    a.word("weight", ray.weight, f.unit);
    a.word("reach", ray.reach, f.reach);
    a.polygon("leaves", ray.leaves);
    a.number("leaves_front", ray.leaves_front, 1);
    a.number("fresh", ray.fresh, 1);
    a.number("outside", ray.outside, 1);
}

template <typename A, typename T>
void fields_of_answer(A& a, T& answer) {
    id_of(a, answer.id);
    a.choice("answer", answer.kind, answer_kind_names);
    a.choice("kind", answer.ray_kind, ray_kind_names);
    a.number("home_x", answer.home_x, 4095);
    a.number("home_y", answer.home_y, 4095);
    a.number("slot", answer.slot, 0xffffffffU);
    a.number("child", answer.child, 63);
    vector(a, {"red", "green", "blue"}, answer.colour, a.formats().intensity);
}

template <typename A, typename S>
void fields_of_span(A& a, S& span) {
    const Format& f = a.formats().loading;
    a.number("polygon", span.polygon, no_polygon - 1);
    a.number("object", span.object, 0xffffffffU);
    a.number("x1", span.x, 4095);
    a.number("xr", span.last, 4095);
    a.number("drop", span.drop, 2);
    vector(a, {"nx", "ny", "nz"}, span.plane.n, f);
    a.word("c", span.plane.c, f);
    vector(a, {"slack_x", "slack_y", "slack_z"}, span.slack, f);
    vector(a, {"n0x", "n0y", "n0z"}, span.normal.base, f);
    vector(a, {"nux", "nuy", "nuz"}, span.normal.du, f);
    vector(a, {"nvx", "nvy", "nvz"}, span.normal.dv, f);
    a.word("z", span.z, f);
    a.word("dz", span.dz, f);
    vector(a, {"ncx", "ncy", "ncz"}, span.n, f);
    vector(a, {"dncx", "dncy", "dncz"}, span.dn, f);
    vector(a, {"red", "green", "blue"}, span.intensity, f);
    vector(a, {"d_red", "d_green", "d_blue"}, span.d_intensity, f);
    a.number("edges", span.edge_count, 4);
    for (int i = 0; i < span.edge_count; ++i) {
        auto& edge = span.edges[std::size_t(i)];
        a.word("a", edge.a, f);
        a.word("b", edge.b, f);
        a.word("c", edge.c, f);
    }
}

template <typename A, typename L>
void fields_of_load(A& a, L& item) {
    if (item.kind == LoadItem::Kind::features) a.number("object", item.object, 0xffffffffU);
    if (item.kind == LoadItem::Kind::span) fields_of_span(a, item.span);
}

}  // namespace

std::string text_of(const Words& words, const Message& message) {
    Writer writer(words);
    switch (message.kind) {
        case Message::Kind::ray:
            fields_of_ray(writer, message.ray->ray);
            return "ray" + writer.text;
        case Message::Kind::answer:
            fields_of_answer(writer, *message.answer);
            return "answer" + writer.text;
        case Message::Kind::load:
            fields_of_load(writer, *message.load);
            return load_kinds[std::size_t(message.load->kind)] + writer.text;
        case Message::Kind::none:
            break;
    }
    return "none";
}

std::vector<std::string> field_names(const std::vector<std::string>& tokens) {
    Names names;
    const std::string& kind = tokens.at(0);
    if (kind == "ray") {
        Ray ray;
        fields_of_ray(names, ray);
    } else if (kind == "answer") {
        Answer answer;
        fields_of_answer(names, answer);
    } else {
        LoadItem item;
        for (std::size_t i = 0; i < std::size(load_kinds); ++i) {
            if (kind == load_kinds[i]) item.kind = LoadItem::Kind(i);
        }
        fields_of_load(names, item);
        // The text says how many edges follow.
        const auto at =
            std::size_t(std::find(names.all.begin(), names.all.end(), "edges") - names.all.begin());
        const std::string& number = at + 1 < tokens.size() ? tokens[at + 1] : "";
        if (number.size() == 1 && number[0] >= '0' && number[0] <= '4') {
            item.span.edge_count = number[0] - '0';
            names.all.clear();
            fields_of_load(names, item);
        }
    }
    return names.all;
}

Message read_message(const Words& words, const std::vector<std::string>& tokens, MessagePools& pools) {
    Reader reader(words, tokens);
    const std::string& kind = tokens.at(0);
    if (kind == "ray") {
        RayPacket packet;
        fields_of_ray(reader, packet.ray);
        reader.finish();
        RayPacket* kept = pools.rays.take();
        *kept = packet;
        return Message(kept);
    }
    if (kind == "answer") {
        Answer answer;
        fields_of_answer(reader, answer);
        reader.finish();
        Answer* kept = pools.answers.take();
        *kept = answer;
        return Message(kept);
    }
    for (std::size_t i = 0; i < std::size(load_kinds); ++i) {
        const auto load = LoadItem::Kind(i);
        if (kind != load_kinds[i] || load == LoadItem::Kind::polygon || load == LoadItem::Kind::surface ||
            load == LoadItem::Kind::trapeze)
            continue;
        LoadItem item;
        item.kind = load;
        fields_of_load(reader, item);
        reader.finish();
        LoadItem* kept = pools.loads.take();
        *kept = item;
        return Message(kept);
    }
    throw GoldenError("'" + kind.substr(0, 60) +
                      "': expected ray, answer, setup, features, span or end_of_scene");
}

}  // namespace raycell
