#include "scenes/nff_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "model/shading/shading.hpp"
#include "scenes/outline.hpp"
#include "scenes/token_reader.hpp"

namespace raycell {

namespace {

constexpr double max_intensity = 1e6;  ///< of a colour channel; its sums and products still fit a float pixel
constexpr double min_ior = 0.01;       ///< below it the quotient of two indices has no optical meaning
constexpr double min_angle = 1e-3;     ///< degrees
constexpr double max_angle = 179.99;   ///< degrees
constexpr double min_relative_size =
    1e-14;  ///< relative to an object's coordinates; smaller sizes are lost in rounding

double largest_component(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The unit vector, or nothing for a vector without direction. Scales the largest component to 1 first, so
/// that tiny and huge vectors keep their direction.
std::optional<dvec3> unit(dvec3 v) {
    const double largest = largest_component(v);
    if (!(largest > 1e-100)) return std::nullopt;
    return glm::normalize(v / largest);
}

class NffParser {
  public:
    NffParser(TextSource source, bool keep_primitives, Diagnostics& diagnostics)
        : in_(std::move(source)), keep_primitives_(keep_primitives), diagnostics_(diagnostics) {}

    Scene parse() {
        if (in_.kind() == TokenReader::Kind::end) {
            throw InputError(in_.file(), in_.line(), "the file holds no entity", "b, v, l, f, s, c, p or pp");
        }
        while (in_.kind() != TokenReader::Kind::end) entity();
        return std::move(scene_);
    }

    std::size_t last_line() const { return in_.line(); }

  private:
    void entity() {
        static constexpr std::string_view words[] = {"b", "v", "l", "f", "s", "c", "p", "pp"};
        const std::string_view* word = std::find(std::begin(words), std::end(words), in_.text());
        if (word == std::end(words)) fail_unknown();
        entity_ = {*word, in_.line()};
        in_.advance();
        if (*word == "b") background();
        if (*word == "v") view();
        if (*word == "l") light();
        if (*word == "f") material();
        if (*word == "s") sphere();
        if (*word == "c") cone();
        if (*word == "p") polygon(false);
        if (*word == "pp") polygon(true);
    }

    [[noreturn]] void fail_unknown() const {
        std::string what =
            in_.kind() == TokenReader::Kind::number ? "a number too many, '" : "unknown word '";
        what += printable(in_.text()) + "'";
        if (entity_.line > 0) what += " after " + TokenReader::describe(entity_);
        throw InputError(in_.file(), in_.line(), what, "b, v, l, f, s, c, p or pp");
    }

    void warn(const std::string& kind, const std::string& text) {
        diagnostics_.warn(in_.file(), entity_.line, kind, text);
    }

    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        throw InputError(in_.file(), entity_.line, what, expected);
    }

    double number(const char* expected) { return in_.number(entity_, expected); }
    dvec3 point(const char* expected) {
        const double x = number(expected), y = number(expected), z = number(expected);
        return {x, y, z};
    }

    /// Reads all numbers up to the next word, so that an entity with too few never takes those of the next.
    /// Returns their count.
    template <std::size_t capacity>
    std::size_t numbers(std::array<double, capacity>& out, const char* expected) {
        std::size_t count = 0;
        for (; in_.kind() == TokenReader::Kind::number; ++count) {
            const double value = number(expected);
            if (count < capacity) out[count] = value;
        }
        return count;
    }

    [[noreturn]] void fail_count(std::size_t count, const std::string& expected) const {
        fail("'" + std::string(entity_.word) + "' has " + std::to_string(count) +
                 (count == 1 ? " number" : " numbers"),
             expected);
    }

    dvec3 colour(dvec3 c, bool warn_above_one) {
        for (int i = 0; i < 3; ++i) {
            if (std::abs(c[i]) > max_intensity) fail("a colour channel beyond 1e6", "0 to 1");
            if (c[i] < 0) warn("negative colour", "a negative colour channel; taken as 0");
            if (c[i] > 1 && warn_above_one) warn("bright colour", "a colour channel above 1; kept");
            c[i] = std::max(c[i], 0.0);
        }
        return c;
    }

    double share(double value, const char* name) {
        if (value >= 0 && value <= 1) return value;
        warn(std::string("share ") + name,
             std::string(name) + " outside 0 to 1; brought to the nearest of them");
        return std::clamp(value, 0.0, 1.0);
    }

    void warn_if_late() {
        if (primitives_ == 0) return;
        warn("late entity",
             "'" + std::string(entity_.word) + "' after objects; it holds for the whole scene");
    }

    void background() {
        std::array<double, 3> c{};
        const std::size_t count = numbers(c, "r g b");
        if (count != 3) fail_count(count, "3: r g b");
        warn_if_late();
        if (has_background_) warn("second background", "a second 'b'; the last one holds");
        has_background_ = true;
        scene_.background = colour({c[0], c[1], c[2]}, true);
    }

    void view();

    void light() {
        std::array<double, 6> n{};
        const std::size_t count = numbers(n, "x y z [r g b]");
        if (count != 3 && count != 6) fail_count(count, "3 or 6: x y z [r g b]");
        warn_if_late();
        if (scene_.sources.size() == max_sources) {
            fail("more light sources than a verdict word has bits", std::to_string(max_sources) + " at most");
        }
        LightSource source;
        source.position = {n[0], n[1], n[2]};
        if (count == 6) source.colour = colour({n[3], n[4], n[5]}, false);
        scene_.sources.push_back(source);
    }

    void material() {
        std::array<double, 8> n{};
        const std::size_t count = numbers(n, "r g b Kd Ks Shine T ior");
        if (count != 8) fail_count(count, "8: r g b Kd Ks Shine T ior");
        Material m;
        m.colour = colour({n[0], n[1], n[2]}, true);
        m.diffuse = share(n[3], "Kd");
        m.specular = share(n[4], "Ks");
        if (n[5] < 0) warn("negative shine", "Shine below 0; taken as 0");
        m.shine = std::max(n[5], 0.0);
        m.transmit = share(n[6], "T");
        m.ior = n[7];
        if (m.ior < min_ior) {
            if (m.transmit > 0) warn("index of refraction", "index of refraction below 0.01; taken as 1");
            m.ior = 1;
        }
        scene_.materials.push_back(m);
        has_material_ = true;
    }

    /// Counts the next primitive and returns its material.
    std::uint32_t material_here() {
        if (!has_material_) {
            if (scene_.materials.empty()) scene_.materials.emplace_back();
            warn("no material", "an object before any 'f'; it gets the default material (grey 0.7, Kd 0.8)");
        }
        ++primitives_;
        return static_cast<std::uint32_t>(scene_.materials.size() - 1);
    }

    void sphere() {
        const dvec3 centre = point("the centre x y z");
        const double r = number("the radius");
        const std::uint32_t m = material_here();
        if (std::abs(r) < 1e-100 || std::abs(r) < min_relative_size * largest_component(centre)) {
            return warn("sphere without extent", "the sphere's radius is 0 beside its coordinates; dropped");
        }
        add(m, SpherePrimitive{centre, std::abs(r), r < 0});
    }

    void cone() {
        const dvec3 base = point("the base x y z");
        const double base_radius = number("the base radius");
        const dvec3 apex = point("the apex x y z");
        const double apex_radius = number("the apex radius");
        const std::uint32_t m = material_here();
        if ((base_radius < 0 && apex_radius > 0) || (base_radius > 0 && apex_radius < 0)) {
            fail("the radii of 'c' have opposite signs",
                 "both positive, or both negative (seen from inside)");
        }
        const double farthest = std::max(largest_component(base), largest_component(apex));
        const double least = std::max(1e-100, min_relative_size * farthest);
        if (largest_component(apex - base) < least) {
            return warn("cone without axis", "the cone's base and apex coincide; dropped");
        }
        if (std::max(std::abs(base_radius), std::abs(apex_radius)) < least) {
            return warn("cone without radius",
                        "both radii of the cone are 0 beside its coordinates; dropped");
        }
        const bool inward = base_radius < 0 || apex_radius < 0;
        add(m, ConePrimitive{base, std::abs(base_radius), apex, std::abs(apex_radius), inward});
    }

    void polygon(bool patch) {
        const long long count =
            in_.integer(entity_, "a whole number of vertices, 3 or more", 3, 1000000000000LL);
        // The count is only the file's claim: memory must grow with the vertices really there.
        std::vector<dvec3> vertices, normals;
        const auto sensible = static_cast<std::size_t>(std::min(count, 1024LL));
        vertices.reserve(sensible);
        if (patch) normals.reserve(sensible);
        for (long long i = 0; i < count; ++i) {
            if (in_.kind() != TokenReader::Kind::number) fail_vertex(i, count);
            vertices.push_back(point("a vertex x y z"));
            if (patch) normals.push_back(point("a vertex normal x y z"));
        }
        const std::uint32_t m = material_here();
        if (!keep_primitives_) return;
        add_outline(scene_, m, std::move(vertices), std::move(normals), {in_.file(), entity_.line},
                    diagnostics_);
    }

    [[noreturn]] void fail_vertex(long long have, long long count) const {
        in_.fail(entity_,
                 std::to_string(count) + " vertices, of which " + std::to_string(have) + " are there");
    }

    template <typename Shape>
    void add(std::uint32_t material, const Shape& shape) {
        if (keep_primitives_) scene_.primitives.push_back({material, shape});
    }

    TokenReader in_;
    bool keep_primitives_;
    Diagnostics& diagnostics_;
    Scene scene_;
    Entity entity_;
    bool has_material_ = false;
    bool has_background_ = false;
    std::size_t primitives_ = 0;  ///< read so far, dropped ones included
};

void NffParser::view() {
    static constexpr std::string_view keywords[] = {"from", "at", "up", "angle", "hither", "resolution"};
    constexpr std::size_t count = std::size(keywords);
    View v;
    std::array<bool, count> seen{};
    bool in_order = true;
    for (std::size_t read = 0; read < count; ++read) {
        const std::size_t which = static_cast<std::size_t>(
            std::find(std::begin(keywords), std::end(keywords), in_.text()) - std::begin(keywords));
        if (which == count || seen[which]) {
            const auto missing =
                static_cast<std::size_t>(std::find(seen.begin(), seen.end(), false) - seen.begin());
            in_.fail(entity_, "'" + std::string(keywords[missing]) +
                                  "' (a view has from, at, up, angle, hither and resolution, once each)");
        }
        in_order = in_order && which == read;
        seen[which] = true;
        in_.advance();
        switch (which) {
            case 0:
                v.from = point("'from' x y z");
                break;
            case 1:
                v.at = point("'at' x y z");
                break;
            case 2:
                v.up = point("'up' x y z");
                break;
            case 3:
                v.angle = number("'angle' in degrees");
                break;
            case 4:
                v.hither = number("'hither', a distance");
                break;
            default:
                v.width = static_cast<int>(
                    in_.integer(entity_, "'resolution', a whole number from 1 to 65536", 1, max_resolution));
                v.height = static_cast<int>(in_.integer(
                    entity_, "'resolution', two whole numbers from 1 to 65536", 1, max_resolution));
        }
    }
    if (const std::optional<ViewFault> fault = fault_of(v)) fail(fault->what, fault->expected);
    warn_if_late();
    if (!in_order) warn("order of v", "the lines of 'v' are not in the order of the format");
    if (scene_.view) warn("second view", "a second 'v'; the last one holds");
    scene_.view = v;
}

Scene read(TextSource source, const std::string& scene_name, Diagnostics& diagnostics) {
    NffParser parser(std::move(source), true, diagnostics);
    Scene scene = parser.parse();
    scene.name = scene_name;
    return scene;
}

}  // namespace

std::optional<ViewFault> fault_of(const View& v) {
    if (v.angle < min_angle || v.angle > max_angle) {
        return ViewFault{"'angle' of the view is out of range", "0.001 to 179.99 degrees"};
    }
    if (v.hither < 0) return ViewFault{"'hither' of the view is negative", "a distance, 0 or more"};
    const double farthest = std::max(largest_component(v.from), largest_component(v.at));
    const auto forward = unit(v.at - v.from);
    if (!forward || largest_component(v.at - v.from) < min_relative_size * farthest) {
        return ViewFault{"'from' and 'at' of the view coincide", "two points"};
    }
    const auto up = unit(v.up);
    if (!up) return ViewFault{"'up' of the view has no length", "a direction"};
    if (glm::length(glm::cross(*forward, *up)) < 1e-9) {
        return ViewFault{"'up' of the view is parallel to its direction", "another direction"};
    }
    return std::nullopt;
}

Scene read_nff(const std::filesystem::path& path, Diagnostics& diagnostics) {
    return read(TextSource(path), printable_path(path.filename()), diagnostics);
}

Scene read_nff_text(std::string_view text, const std::string& name, Diagnostics& diagnostics) {
    return read(TextSource(text, name), name, diagnostics);
}

Scene read_view_file(const std::filesystem::path& path, Diagnostics& diagnostics) {
    TextSource source(path);
    const std::string file = source.name();
    NffParser parser(std::move(source), false, diagnostics);
    Scene scene = parser.parse();
    if (!scene.view) throw InputError(file, parser.last_line(), "the view file has no 'v'", "a 'v' entity");
    scene.name = printable_path(path.filename());
    return scene;
}

}  // namespace raycell
