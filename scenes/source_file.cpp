#include "scenes/source_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "scenes/text_source.hpp"

namespace raycell {
namespace {

constexpr double max_intensity = 1e6;

/// The keys of a kind, in the order in which they are asked for; every source may have a colour.
std::vector<std::string> keys_of(SourceKind kind) {
    switch (kind) {
        case SourceKind::point:
            return {"position"};
        case SourceKind::directional:
            return {"direction"};
        case SourceKind::spot:
            return {"position", "direction", "angle", "falloff"};
        case SourceKind::rectangle:
        case SourceKind::triangle:
            return {"corner", "u", "v"};
        case SourceKind::sphere:
            return {"centre", "radius"};
    }
    return {};
}

std::string list_of(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
    return list;
}

/// Reads one table of a file.
class TableReader {
  public:
    TableReader(const std::string& file, const toml::table& table) : file_(file), table_(table) {}

    [[noreturn]] void fail(const toml::node& at, const std::string& what, const std::string& expected) const {
        throw InputError(file_, at.source().begin.line, what, expected);
    }

    /// Refuses keys that are not among `known`.
    void only(std::vector<std::string> known) const {
        for (const auto& [key, node] : table_) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) == known.end())
                fail(node, "unknown key '" + printable(name) + "'", list_of(known));
        }
    }

    const toml::node* find(const char* key) const { return table_.get(key); }

    const toml::node& need(const char* key, const std::string& expected) const {
        const toml::node* node = find(key);
        if (!node) fail(table_, std::string("'") + key + "' is missing", expected);
        return *node;
    }

    double real(const toml::node& node, const char* key, const std::string& expected) const {
        const auto value = node.value<double>();
        if (!value || !node.is_number() || !std::isfinite(*value) || std::abs(*value) > max_magnitude)
            fail(node, std::string("'") + key + "' is no such number", expected);
        return *value;
    }

    dvec3 vector(const char* key, const std::string& expected) const {
        const toml::node& node = need(key, expected);
        const toml::array* list = node.as_array();
        if (!list || list->size() != 3)
            fail(node, std::string("'") + key + "' is no list of three", expected);
        dvec3 v;
        for (std::size_t i = 0; i < 3; ++i) v[int(i)] = real((*list)[i], key, expected);
        return v;
    }

    dvec3 direction(const char* key) const {
        const std::string expected = "three numbers [x, y, z], not all 0";
        const dvec3 v = vector(key, expected);
        // Its length must survive squaring.
        const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        if (!(largest > 0)) fail(need(key, expected), std::string("'") + key + "' is 0", expected);
        return v / largest;
    }

    /// `otherwise` if it is not given.
    double ranged(const char* key, double otherwise, double least, double most, bool open,
                  const std::string& expected) const {
        const toml::node* node = find(key);
        if (!node) return otherwise;
        const double value = real(*node, key, expected);
        if (value < least || value > most || (open && value == least))
            fail(*node, std::string("'") + key + "' is out of range", expected);
        return value;
    }

    std::string word(const char* key, const std::string& expected) const {
        const toml::node& node = need(key, expected);
        const auto text = node.value_exact<std::string>();
        if (!text) fail(node, std::string("'") + key + "' is no word", expected);
        return *text;
    }

  private:
    const std::string& file_;
    const toml::table& table_;
};

SourceKind kind_of(const TableReader& table) {
    std::vector<std::string> names;
    for (int i = 0; i < source_kinds; ++i) names.emplace_back(name_of(SourceKind(i)));
    const std::string expected = list_of(names);
    const std::string word = table.word("kind", expected);
    for (int i = 0; i < source_kinds; ++i) {
        if (word == name_of(SourceKind(i))) return SourceKind(i);
    }
    table.fail(table.need("kind", expected), "'kind' is '" + printable(word) + "'", expected);
}

std::optional<dvec3> colour_of(const TableReader& table) {
    if (!table.find("colour")) return std::nullopt;
    const std::string expected = "three numbers [red, green, blue] from 0 to 1e6";
    const dvec3 colour = table.vector("colour", expected);
    for (int i = 0; i < 3; ++i) {
        if (colour[i] < 0 || colour[i] > max_intensity)
            table.fail(*table.find("colour"), "'colour' is out of range", expected);
    }
    return colour;
}

/// Whether two edges are apart by more than the last digits of what they were printed with.
bool has_area(const dvec3& u, const dvec3& v) {
    const double a = glm::length(u), b = glm::length(v);
    return a > 0 && b > 0 && glm::length(glm::cross(u / a, v / b)) > 1e-9;
}

LightSource read_source(const TableReader& table) {
    const char* const point = "three numbers [x, y, z]";
    LightSource source;
    source.kind = kind_of(table);
    std::vector<std::string> known = keys_of(source.kind);
    known.insert(known.begin(), {"kind", "colour"});
    table.only(known);
    source.colour = colour_of(table);
    switch (source.kind) {
        case SourceKind::spot:
            source.angle = table.ranged("angle", 90, 0, 90, true, "degrees above 0, up to 90");
            source.falloff = table.ranged("falloff", 1, 0, 1000, false, "a power from 0 to 1000");
            source.position = table.vector("position", point);
            source.direction = table.direction("direction");
            break;
        case SourceKind::directional:
            source.direction = table.direction("direction");
            break;
        case SourceKind::point:
            source.position = table.vector("position", point);
            break;
        case SourceKind::sphere:
            source.position = table.vector("centre", point);
            table.need("radius", "a length above 0");
            source.radius = table.ranged("radius", 0, 0, max_magnitude, true, "a length above 0");
            break;
        case SourceKind::rectangle:
        case SourceKind::triangle:
            source.position = table.vector("corner", point);
            source.edge_u = table.vector("u", point);
            source.edge_v = table.vector("v", point);
            if (!has_area(source.edge_u, source.edge_v))
                table.fail(table.need("v", point), "'u' and 'v' span no area", "two directions apart");
    }
    return source;
}

toml::table parse(const std::string& text, const std::string& name) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw InputError(name, error.source().begin.line, printable(error.description(), 120), "TOML");
    }
}

SourceFile read(const std::string& text, const std::string& name) {
    const toml::table all = parse(text, name);
    const TableReader file(name, all);
    file.only({"add", "source"});
    SourceFile result;
    if (const toml::node* add = file.find("add")) {
        if (!add->is_boolean()) file.fail(*add, "'add' is no truth value", "true or false");
        result.add = *add->value<bool>();
    }
    const toml::node* list = file.find("source");
    const std::string expected = "one table [[source]] or more";
    if (!list) throw InputError(name, 0, "no sources", expected);
    if (!list->is_array_of_tables()) file.fail(*list, "'source' is no list of tables", expected);
    for (const toml::node& node : *list->as_array()) {
        if (result.sources.size() == max_sources)
            file.fail(node, "more light sources than a verdict word has bits",
                      std::to_string(max_sources) + " at most");
        result.sources.push_back(read_source(TableReader(name, *node.as_table())));
    }
    return result;
}

}  // namespace

SourceFile read_sources_text(std::string_view text, const std::string& name) {
    return read(std::string(text), name);
}

SourceFile read_sources(const std::filesystem::path& path) {
    TextSource source(path);  // refuses what is no text
    std::string text;
    for (int c = 0; (c = source.get()) != TextSource::end;) text += char(c);
    return read(text, source.name());
}

void take_sources(Scene& scene, SourceFile file) {
    if (!file.add) scene.sources.clear();
    scene.sources.insert(scene.sources.end(), file.sources.begin(), file.sources.end());
}

}  // namespace raycell
