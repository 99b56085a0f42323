#include "scenes/obj_reader.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <istream>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "scenes/obj_lines.hpp"
#include "scenes/obj_materials.hpp"
#include "scenes/outline.hpp"

namespace raycell {

namespace {

constexpr std::int32_t none = -1;

/// One corner of a face: indices from 0.
struct Corner {
    std::int32_t vertex = none;
    std::int32_t normal = none;
    std::int32_t texture = none;
};

struct Face {
    std::size_t first_corner = 0;
    std::size_t corners = 0;
    std::size_t line = 0;
    std::size_t name = 0;  ///< of its material, index into ObjParser::names_
};

/// Feeds tinyobjloader with checked lines, and takes from it what they hold.
class ObjParser : public LineFeed {
  public:
    ObjParser(TextSource source, const std::filesystem::path& folder, Diagnostics& diagnostics)
        : lines_(std::move(source)), libraries_(folder), diagnostics_(diagnostics) {}

    Scene parse();

  private:
    bool next_line(std::string& text) override;
    void check_numbers(const std::vector<std::string_view>& words, std::string& text);
    void check_vertex(const std::vector<std::string_view>& words, std::string& text);
    void check_face(const std::vector<std::string_view>& words, std::string& text);
    void check_corner(std::string_view corner) const;
    void load_libraries();
    void ignore(std::string_view key);

    void add_face(const tinyobj::index_t* indices, std::size_t count);
    std::int32_t resolve(int index, std::size_t count, const char* what) const;
    void check_range(std::int32_t index, std::size_t count, const char* what, std::size_t line) const;
    void build(const Face& face);
    std::uint32_t material_of(std::size_t name, std::size_t line);
    std::uint32_t default_material();

    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        throw InputError(lines_.file(), lines_.line(), what, expected);
    }
    void warn(const std::string& kind, const std::string& text, std::size_t shown = 5) {
        diagnostics_.warn(lines_.file(), lines_.line(), kind, text, shown);
    }

    LineReader lines_;
    MaterialLibraries libraries_;
    Diagnostics& diagnostics_;
    Scene scene_;
    std::string line_;
    dvec3 numbers_{0, 0, 0};  ///< of the current `v` or `vn` line
    bool any_statement_ = false;

    std::vector<dvec3> vertices_;
    std::vector<dvec3> normals_;
    std::size_t textures_ = 0;
    std::vector<Corner> corners_;
    std::vector<Face> faces_;
    std::map<std::string, std::size_t> name_index_;
    std::vector<std::string> names_{""};                ///< "": before any usemtl
    std::vector<std::int64_t> materials_of_names_{-1};  ///< -1: not looked up yet
    std::size_t name_ = 0;
    std::int64_t default_material_ = -1;
};

constexpr std::string_view silent[] = {"g", "o", "s", "vp", "mg"};
constexpr std::string_view unsupported[] = {
    "p",         "l",      "cstype", "deg",  "bmat",  "step",  "curv",     "curv2",    "surf",
    "parm",      "trim",   "hole",   "scrv", "sp",    "end",   "con",      "bevel",    "lod",
    "maplib",    "usemap", "call",   "csh",  "ctech", "stech", "c_interp", "d_interp", "shadow_obj",
    "trace_obj", "bzp",    "bsp",    "cdc",  "cdp",   "res"};

template <std::size_t n>
bool is_one_of(std::string_view key, const std::string_view (&keys)[n]) {
    return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
}

bool ObjParser::next_line(std::string& text) {
    text.clear();
    if (!lines_.next(line_)) return false;
    const std::vector<std::string_view> words = split(line_);
    if (words.empty()) return true;
    any_statement_ = true;
    const std::string_view key = words[0];
    if (key == "v") {
        check_vertex(words, text);
    } else if (key == "vn") {
        if (words.size() != 4) fail("'vn' has " + std::to_string(words.size() - 1) + " numbers", "3: x y z");
        check_numbers(words, text);
    } else if (key == "vt") {
        ++textures_;
    } else if (key == "f") {
        check_face(words, text);
    } else if (key == "usemtl") {
        text = "usemtl " + std::string(rest_of(line_)) + "\n";
    } else if (key == "mtllib") {
        load_libraries();
    } else {
        ignore(key);
    }
    return true;
}

void ObjParser::ignore(std::string_view key) {
    if (is_one_of(key, silent)) return;
    if (!is_one_of(key, unsupported)) {
        fail("unknown word '" + printable(key) + "'",
             "an OBJ statement such as v, vn, vt, f, usemtl or mtllib");
    }
    warn("statement " + std::string(key), "'" + std::string(key) + "' is not drawn: only faces are; ignored",
         1);
}

/// Checks all the numbers of a line and hands on the first three.
void ObjParser::check_numbers(const std::vector<std::string_view>& words, std::string& text) {
    for (std::size_t i = 1; i < words.size(); ++i) {
        double value = 0;
        const NumberFault fault = parse_number(words[i], value);
        if (fault != NumberFault::none) {
            fail("'" + std::string(words[0]) + "': found '" + printable(words[i]) + "'", describe(fault));
        }
        if (i <= 3) numbers_[static_cast<int>(i) - 1] = value;
        if (words[0] == "v" && words.size() == 5 && i == 4 && value != 1) {
            warn("weight", "a weight (fourth number of 'v') other than 1; ignored");
        }
    }
    for (std::size_t i = 0; i < 4; ++i) (text += words[i]) += i < 3 ? ' ' : '\n';
}

void ObjParser::check_vertex(const std::vector<std::string_view>& words, std::string& text) {
    const std::size_t count = words.size() - 1;
    if (count != 3 && count != 4 && count != 6 && count != 7) {
        fail("'v' has " + std::to_string(count) + " numbers",
             "3: x y z, perhaps followed by a weight or a colour");
    }
    check_numbers(words, text);
}

void ObjParser::check_face(const std::vector<std::string_view>& words, std::string& text) {
    if (words.size() < 4) {
        fail("'f' has " + std::to_string(words.size() - 1) + " corners", "3 or more");
    }
    for (std::size_t i = 1; i < words.size(); ++i) check_corner(words[i]);
    text = line_ + "\n";
}

/// v, v/vt, v//vn or v/vt/vn; tinyobjloader would take anything else for index 0.
void ObjParser::check_corner(std::string_view corner) const {
    const auto malformed = [&]() {
        fail("'f': found '" + printable(corner) + "'", "a corner v, v/vt, v//vn or v/vt/vn of whole numbers");
    };
    std::string_view left = corner;
    for (int part = 0; part < 3; ++part) {
        const std::size_t slash = std::min(left.find('/'), left.size());
        const std::string_view digits = left.substr(0, slash);
        const bool may_be_empty = part == 1 && slash < left.size();
        if (digits.empty() && !may_be_empty) malformed();
        if (!digits.empty()) {
            std::int32_t index = 0;
            const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
            if (error == std::errc::invalid_argument || stop != digits.data() + digits.size()) malformed();
            if (error != std::errc() || index == std::numeric_limits<std::int32_t>::min()) {
                fail("'f' names an index beyond any file: '" + printable(digits) + "'",
                     "an index of this file");
            }
            if (index == 0) fail("'f' names index 0", "indices from 1, or from -1 backwards");
        }
        if (slash == left.size()) return;
        left.remove_prefix(slash + 1);
    }
    malformed();
}

/// A line may name several libraries, or one whose name holds spaces.
void ObjParser::load_libraries() {
    const std::string rest(rest_of(line_));
    const Place place{lines_.file(), lines_.line()};
    const std::vector<std::string_view> names = split(rest);
    if (names.empty()) return warn("empty mtllib", "'mtllib' without a name; ignored");
    const auto ends_library = [](std::string_view name) {
        return name.size() > 4 &&
               (name.substr(name.size() - 4) == ".mtl" || name.substr(name.size() - 4) == ".MTL");
    };
    // "a.mtl b.mtl" are two, "my scene.mtl" is one.
    if (!std::all_of(names.begin(), names.end(), ends_library)) {
        return libraries_.load(rest, place, scene_, diagnostics_);
    }
    for (const std::string_view name : names) libraries_.load(name, place, scene_, diagnostics_);
}

Scene ObjParser::parse() {
    tinyobj::callback_t callbacks;
    // tinyobjloader's own numbers are off in their last digits; the check has read them exactly.
    callbacks.vertex_cb = [](void* self, double, double, double, double) {
        static_cast<ObjParser*>(self)->vertices_.push_back(static_cast<ObjParser*>(self)->numbers_);
    };
    callbacks.normal_cb = [](void* self, double, double, double) {
        static_cast<ObjParser*>(self)->normals_.push_back(static_cast<ObjParser*>(self)->numbers_);
    };
    callbacks.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
        static_cast<ObjParser*>(self)->add_face(indices, static_cast<std::size_t>(count));
    };
    callbacks.usemtl_cb = [](void* self, const char* name, int) {
        auto& parser = *static_cast<ObjParser*>(self);
        const auto [entry, is_new] = parser.name_index_.emplace(name, parser.names_.size());
        if (is_new) {
            parser.names_.emplace_back(name);
            parser.materials_of_names_.push_back(-1);
        }
        parser.name_ = entry->second;
    };
    std::istream stream(this);
    stream.exceptions(std::ios::badbit);  // else the stream would swallow this feed's errors
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
    if (!any_statement_) fail("the file holds no statement", "vertices and faces");
    for (const Face& face : faces_) build(face);
    return std::move(scene_);
}

void ObjParser::add_face(const tinyobj::index_t* indices, std::size_t count) {
    faces_.push_back({corners_.size(), count, lines_.line(), name_});
    for (std::size_t i = 0; i < count; ++i) {
        Corner corner;
        corner.vertex = resolve(indices[i].vertex_index, vertices_.size(), "vertex");
        corner.normal = resolve(indices[i].normal_index, normals_.size(), "normal");
        corner.texture = resolve(indices[i].texcoord_index, textures_, "texture coordinate");
        corners_.push_back(corner);
    }
}

/// Index from 0, `none` for 0. Relative indices count from here, so they are checked here.
std::int32_t ObjParser::resolve(int index, std::size_t count, const char* what) const {
    if (index >= 0) return index - 1;
    const std::int64_t resolved = static_cast<std::int64_t>(count) + index;
    if (resolved < 0) {
        fail("'f' names " + std::string(what) + " " + std::to_string(index) + ", " + std::to_string(count) +
                 (count == 1 ? " is" : " are") + " defined so far",
             "a relative index that does not reach before the first");
    }
    return static_cast<std::int32_t>(resolved);
}

void ObjParser::check_range(std::int32_t index, std::size_t count, const char* what, std::size_t line) const {
    if (index == none || static_cast<std::size_t>(index) < count) return;
    throw InputError(lines_.file(), line,
                     "'f' names " + std::string(what) + " " + std::to_string(std::int64_t{index} + 1),
                     "one of the " + std::to_string(count) + " of the file");
}

void ObjParser::build(const Face& face) {
    std::vector<dvec3> vertices, normals;
    vertices.reserve(face.corners);
    std::size_t with_normal = 0;
    for (std::size_t i = 0; i < face.corners; ++i) {
        const Corner& corner = corners_[face.first_corner + i];
        check_range(corner.vertex, vertices_.size(), "vertex", face.line);
        check_range(corner.normal, normals_.size(), "normal", face.line);
        check_range(corner.texture, textures_, "texture coordinate", face.line);
        vertices.push_back(vertices_[static_cast<std::size_t>(corner.vertex)]);
        if (corner.normal != none) ++with_normal;
    }
    if (with_normal == face.corners) {
        for (std::size_t i = 0; i < face.corners; ++i) {
            const Corner& corner = corners_[face.first_corner + i];
            normals.push_back(normals_[static_cast<std::size_t>(corner.normal)]);
        }
    } else if (with_normal > 0) {
        diagnostics_.warn(lines_.file(), face.line, "missing normal",
                          "some corners of the face have no normal; it is drawn flat");
    }
    add_outline(scene_, material_of(face.name, face.line), std::move(vertices), std::move(normals),
                {lines_.file(), face.line}, diagnostics_);
}

std::uint32_t ObjParser::material_of(std::size_t name, std::size_t line) {
    std::int64_t& material = materials_of_names_[name];
    if (material < 0) {
        const auto found = libraries_.find(names_[name]);
        material = found ? *found : default_material();
        if (!found && name != 0 && !libraries_.incomplete()) {
            diagnostics_.warn(lines_.file(), line, "unknown material",
                              "no library defines material '" + printable(names_[name]) +
                                  "'; the default is taken (grey 0.7, Kd 0.8)");
        }
    }
    return static_cast<std::uint32_t>(material);
}

std::uint32_t ObjParser::default_material() {
    if (default_material_ < 0) {
        default_material_ = static_cast<std::int64_t>(scene_.materials.size());
        scene_.materials.emplace_back();
    }
    return static_cast<std::uint32_t>(default_material_);
}

struct Bounds {
    dvec3 low{std::numeric_limits<double>::infinity()};
    dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const dvec3& centre, double radius) {
        low = glm::min(low, centre - dvec3(radius));
        high = glm::max(high, centre + dvec3(radius));
    }
    void add(const PolygonPrimitive& polygon) {
        for (const dvec3& v : polygon.vertices) add(v, 0);
    }
    void add(const SpherePrimitive& sphere) { add(sphere.centre, sphere.radius); }
    void add(const ConePrimitive& cone) {
        add(cone.base, cone.base_radius);
        add(cone.apex, cone.apex_radius);
    }
};

}  // namespace

Scene read_obj(const std::filesystem::path& path, Diagnostics& diagnostics) {
    Scene scene = ObjParser(TextSource(path), path.parent_path(), diagnostics).parse();
    scene.name = printable_path(path.filename());
    return scene;
}

Scene read_obj_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                    Diagnostics& diagnostics) {
    Scene scene = ObjParser(TextSource(text, name), folder, diagnostics).parse();
    scene.name = name;
    return scene;
}

void add_default_view(Scene& scene, Diagnostics& diagnostics) {
    Bounds bounds;
    for (const Primitive& primitive : scene.primitives) {
        std::visit([&](const auto& shape) { bounds.add(shape); }, primitive.shape);
    }
    if (scene.primitives.empty()) bounds.add(dvec3(0), 1);
    const dvec3 centre = (bounds.low + bounds.high) * 0.5;
    double radius = glm::length(bounds.high - bounds.low) * 0.5;
    if (!(radius > 0)) radius = 1;

    View view;
    // Slightly from the side and above: a box open to the front is seen into, and depth shows.
    const dvec3 towards_viewer = glm::normalize(dvec3(0.15, 0.1, 1));
    view.from = centre + towards_viewer * (radius / std::sin(glm::radians(view.angle / 2)));
    view.at = centre;
    scene.view = view;
    scene.sources.assign(1, LightSource{view.from, std::nullopt});
    diagnostics.note(scene.name,
                     "no view given: the bounding box is framed from the side of +z, with one light at "
                     "the viewer");
}

void take_view(Scene& scene, const Scene& view_scene) {
    scene.background = view_scene.background;
    if (view_scene.view) scene.view = view_scene.view;
    if (!view_scene.sources.empty()) scene.sources = view_scene.sources;
}

}  // namespace raycell
