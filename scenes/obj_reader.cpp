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
#include "scenes/smooth_normals.hpp"

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
    std::size_t name = 0;     ///< of its material, index into ObjParser::names_
    std::uint32_t group = 0;  ///< for smoothing; 0: none
};

/// Feeds tinyobjloader with checked lines and takes their content from it.
class ObjParser : public LineFeed {
  public:
    ObjParser(TextSource source, const std::filesystem::path& folder, Diagnostics& diagnostics)
        : lines_(std::move(source)), libraries_(folder), diagnostics_(diagnostics) {}

    Scene parse();

  private:
    bool next_line(std::string& text) override;
    void check_place(const std::vector<std::string_view>& words, std::string& text);
    void check_extras(const std::vector<std::string_view>& words);
    void check_normal(const std::vector<std::string_view>& words, std::string& text);
    void check_face(const std::vector<std::string_view>& words, std::string& text);
    using Form = std::pair<bool, bool>;  ///< whether a corner has a texture coordinate, and a normal
    std::string check_corner(std::string_view corner, Form& form);
    std::string check_vertex_index(std::string_view digits, std::string_view corner) const;
    std::string check_other_index(std::string_view digits, const char* kind);
    void set_group(const std::vector<std::string_view>& words);
    void load_libraries();
    bool ignores(std::string_view key);

    void add_face(const tinyobj::index_t* indices, std::size_t count);
    std::string relative_fault(const char* what, int index, std::size_t count) const;
    void check_range(const Face& face, Corner& corner);
    bool has_normals(const Face& face) const;
    void take_vertices(const Face& face);
    void build(const Face& face);
    std::uint32_t material_of(std::size_t name, std::size_t line);
    std::uint32_t default_material();

    [[noreturn]] void fail(const std::string& what, const std::string& expected) const {
        throw InputError(lines_.file(), lines_.line(), what, expected);
    }
    void warn(const std::string& kind, const std::string& text, std::size_t shown = 5) {
        diagnostics_.warn(lines_.file(), lines_.line(), kind, text, shown);
    }
    void warn_normal(std::size_t line, const std::string& what) {
        diagnostics_.warn(lines_.file(), line, "normal index",
                          what + "; the face is drawn without the normals of the file");
    }
    void warn_texture(std::size_t line, const std::string& what) {
        diagnostics_.warn(lines_.file(), line, "texture index", what + "; ignored, textures are not read");
    }

    LineReader lines_;
    MaterialLibraries libraries_;
    Diagnostics& diagnostics_;
    Scene scene_;
    std::string line_;
    dvec3 numbers_{0, 0, 0};  ///< of the current `v` or `vn` line
    bool any_statement_ = false;
    UnknownWords unknown_;
    std::string first_unknown_;
    std::size_t first_unknown_line_ = 0;

    std::vector<dvec3> vertices_;
    std::vector<dvec3> normals_;
    std::size_t textures_ = 0;
    std::vector<Corner> corners_;
    std::vector<Face> faces_;
    std::uint32_t group_ = 0;
    SmoothNormals smooth_;
    std::vector<std::uint32_t> indices_;  ///< of the current face
    std::vector<dvec3> places_;
    std::map<std::string, std::size_t> name_index_;
    std::vector<std::string> names_{""};                ///< "": before any usemtl
    std::vector<std::int64_t> materials_of_names_{-1};  ///< -1: not looked up yet
    std::size_t name_ = 0;
    std::int64_t default_material_ = -1;
};

/// Known statements that are ignored, with the reason.
struct Ignored {
    const char* why;
    std::vector<std::string_view> words;
};
const Ignored ignored[] = {{" is not drawn: only faces are; ignored",
                            {"p", "l", "curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp", "res"}},
                           {" belongs to free-form curves and surfaces, which are not drawn; ignored",
                            {"vp", "mg", "cstype", "deg", "bmat", "step", "parm", "trim", "hole", "scrv",
                             "sp", "end", "con", "ctech", "stech"}},
                           {" is ignored: textures are not read", {"usemap", "maplib"}},
                           {" is ignored: no other file is read", {"call", "csh", "shadow_obj", "trace_obj"}},
                           {" is ignored", {"bevel", "lod", "c_interp", "d_interp"}}};

bool ObjParser::next_line(std::string& text) {
    text.clear();
    if (!lines_.next(line_)) return false;
    const std::vector<std::string_view> words = split(line_);
    if (words.empty()) return true;
    const std::string_view key = words[0];
    bool known = true;
    if (key == "v") {
        check_place(words, text);
    } else if (key == "vn") {
        check_normal(words, text);
    } else if (key == "vt") {
        ++textures_;
    } else if (key == "f") {
        check_face(words, text);
    } else if (key == "usemtl") {
        text = "usemtl " + std::string(rest_of(line_)) + "\n";
    } else if (key == "mtllib") {
        load_libraries();
    } else if (key == "s") {
        set_group(words);
    } else if (key != "g" && key != "o") {
        known = ignores(key);
    }
    any_statement_ = any_statement_ || known;
    return true;
}

/// Warns of a statement that is ignored; false if it is not a statement of OBJ.
bool ObjParser::ignores(std::string_view key) {
    for (const auto& [why, words] : ignored) {
        if (std::find(words.begin(), words.end(), key) == words.end()) continue;
        warn("statement " + std::string(key), "'" + std::string(key) + "'" + why, 1);
        return true;
    }
    const std::string kind = unknown_.kind(key);
    warn(kind, kind + "; the line is ignored", 1);
    if (first_unknown_line_ == 0) {
        first_unknown_ = printable(key);
        first_unknown_line_ = lines_.line();
    }
    return false;
}

/// Checks x, y and z of a vertex. A fault is an error, because the geometry depends on them.
void ObjParser::check_place(const std::vector<std::string_view>& words, std::string& text) {
    if (words.size() < 4) {
        fail("'v' has " + std::to_string(words.size() - 1) + " numbers",
             "3: x y z, perhaps followed by a weight or a colour");
    }
    for (std::size_t i = 1; i < 4; ++i) {
        double value = 0;
        const NumberFault fault = parse_number(words[i], value);
        if (fault != NumberFault::none) fail("'v': found '" + printable(words[i]) + "'", describe(fault));
        numbers_[static_cast<int>(i) - 1] = value;
    }
    check_extras(words);
    text = "v 0 0 0\n";  // the numbers themselves are in numbers_
}

/// Checks what follows x y z: a weight, a colour, or both; none of it is used.
void ObjParser::check_extras(const std::vector<std::string_view>& words) {
    const std::size_t extras = words.size() - 4;
    bool sound = extras == 0 || extras == 1 || extras == 3 || extras == 4;
    double value = 1;
    for (std::size_t i = 4; i < words.size() && sound; ++i) {
        sound = parse_number(words[i], value) == NumberFault::none;
    }
    if (!sound) {
        warn("vertex extras", "what follows x y z is neither a weight nor a colour of numbers; ignored");
    } else if (extras == 1 && value != 1) {
        warn("weight", "a weight (fourth number of 'v') other than 1; ignored");
    }
}

/// Checks a normal. One that can't be read becomes 0, and add_outline() replaces it by the face's own.
void ObjParser::check_normal(const std::vector<std::string_view>& words, std::string& text) {
    numbers_ = dvec3(0);
    bool sound = words.size() == 4;
    for (std::size_t i = 1; i < words.size() && sound; ++i) {
        sound = parse_number(words[i], numbers_[static_cast<int>(i) - 1]) == NumberFault::none;
    }
    if (!sound) {
        numbers_ = dvec3(0);
        warn("malformed normal", "'vn' is not 3 numbers x y z; taken as a normal without length");
    }
    text = "vn 0 0 0\n";
}

void ObjParser::set_group(const std::vector<std::string_view>& words) {
    const std::string_view word = words.size() > 1 ? words[1] : std::string_view();
    group_ = 0;
    if (word == "off") return;
    if (word == "on") {
        group_ = 1;
        return;
    }
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), group_);
    if (error == std::errc() && stop == word.data() + word.size()) return;
    group_ = 0;
    warn("smoothing group", "'s' names no smoothing group (a whole number, or off); taken as off");
}

void ObjParser::check_face(const std::vector<std::string_view>& words, std::string& text) {
    if (words.size() < 4) {
        const std::size_t count = words.size() - 1;
        return warn("few corners", "a face of " + std::to_string(count) +
                                       (count == 1 ? " corner" : " corners") + "; nothing to draw");
    }
    Form first, form;
    bool mixed = false;
    text = "f";
    for (std::size_t i = 1; i < words.size(); ++i) {
        text += " " + check_corner(words[i], form);
        if (i == 1) first = form;
        mixed = mixed || form != first;
    }
    text += "\n";
    if (mixed) {
        warn("mixed corners",
             "the corners of the face have different forms; its normals count only where all have one");
    }
}

/// Checks a corner v, v/vt, v//vn or v/vt/vn. Returns it for tinyobjloader, without unusable parts.
std::string ObjParser::check_corner(std::string_view corner, Form& form) {
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view left = corner;; ++count) {
        const std::size_t slash = std::min(left.find('/'), left.size());
        if (count < parts.size()) parts[count] = left.substr(0, slash);
        if (slash == left.size()) break;
        left.remove_prefix(slash + 1);
    }
    const std::string vertex = check_vertex_index(parts[0], corner);
    if (count >= parts.size()) {
        warn("long corner", "'" + printable(corner) + "' has more parts than v/vt/vn; the rest is ignored");
    } else if (count > 0 && parts[count].empty()) {
        warn("trailing slash", "'" + printable(corner) + "' ends with a slash; read without it");
    }
    form = {!parts[1].empty(), !parts[2].empty()};
    const std::string texture = check_other_index(parts[1], "texture coordinate");
    const std::string normal = check_other_index(parts[2], "normal");
    if (normal.empty()) return texture.empty() ? vertex : vertex + "/" + texture;
    return vertex + "/" + texture + "/" + normal;
}

/// Reads a whole number other than 0; false for anything else.
bool parse_index(std::string_view digits, std::int32_t& index) {
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    return error == std::errc() && stop == digits.data() + digits.size() && index != 0 &&
           index != std::numeric_limits<std::int32_t>::min();
}

std::string ObjParser::check_vertex_index(std::string_view digits, std::string_view corner) const {
    std::int32_t index = 0;
    if (parse_index(digits, index)) return std::string(digits);
    if (!digits.empty() && digits.find_first_not_of("-0123456789") == std::string_view::npos) {
        if (digits.find_first_not_of("-0") == std::string_view::npos)
            fail("'f' names index 0", "indices from 1, or from -1 backwards");
        fail("'f' names an index beyond any file: '" + printable(digits) + "'", "an index of this file");
    }
    fail("'f': found '" + printable(corner) + "'", "a corner v, v/vt, v//vn or v/vt/vn of whole numbers");
}

/// The index of a texture coordinate or a normal; empty, with a warning, if it is malformed.
std::string ObjParser::check_other_index(std::string_view digits, const char* kind) {
    std::int32_t index = 0;
    if (digits.empty()) return "";
    if (parse_index(digits, index)) return std::string(digits);
    const std::string what = "'f' names " + std::string(kind) + " '" + printable(digits) + "'";
    if (kind[0] == 't') {
        warn_texture(lines_.line(), what);
    } else {
        warn_normal(lines_.line(), what);
    }
    return "";
}

/// A line may name several libraries, or one whose name contains spaces.
void ObjParser::load_libraries() {
    const std::string rest(rest_of(line_));
    const Place place{lines_.file(), lines_.line()};
    const std::vector<std::string_view> names = split(rest);
    if (names.empty()) return warn("empty mtllib", "'mtllib' without a name; ignored");
    const auto ends_library = [](std::string_view name) {
        return name.size() > 4 &&
               (name.substr(name.size() - 4) == ".mtl" || name.substr(name.size() - 4) == ".MTL");
    };
    // "a.mtl b.mtl" names two libraries, "my scene.mtl" one.
    if (!std::all_of(names.begin(), names.end(), ends_library)) {
        return libraries_.load(rest, place, scene_, diagnostics_);
    }
    for (const std::string_view name : names) libraries_.load(name, place, scene_, diagnostics_);
}

Scene ObjParser::parse() {
    tinyobj::callback_t callbacks;
    // tinyobjloader's own numbers are wrong in their last digits; numbers_ has the exact ones.
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
    stream.exceptions(std::ios::badbit);  // otherwise the stream would swallow this feed's errors
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
    if (!any_statement_ && first_unknown_line_ > 0) {
        throw InputError(lines_.file(), first_unknown_line_, "unknown word '" + first_unknown_ + "'",
                         "an OBJ statement such as v, vn, vt, f, usemtl or mtllib");
    }
    if (!any_statement_) fail("the file holds no statement", "vertices and faces");
    for (const Face& face : faces_) {
        for (std::size_t i = 0; i < face.corners; ++i) check_range(face, corners_[face.first_corner + i]);
        if (face.group == 0 || has_normals(face)) continue;
        take_vertices(face);
        smooth_.add(face.group, indices_, places_);
    }
    for (const Face& face : faces_) build(face);
    return std::move(scene_);
}

/// Converts tinyobjloader's index to one from 0: `none` for its 0, below `none` for a relative index that
/// reaches before the first.
std::int32_t resolve(int index, std::size_t count) {
    if (index >= 0) return index - 1;
    const std::int64_t resolved = static_cast<std::int64_t>(count) + index;
    return static_cast<std::int32_t>(resolved < 0 ? none - 1 : resolved);
}

std::string ObjParser::relative_fault(const char* what, int index, std::size_t count) const {
    return "'f' names " + std::string(what) + " " + std::to_string(index) + ", " + std::to_string(count) +
           (count == 1 ? " is" : " are") + " defined so far";
}

/// Relative indices count back from the elements defined so far, so they are checked here.
void ObjParser::add_face(const tinyobj::index_t* indices, std::size_t count) {
    faces_.push_back({corners_.size(), count, lines_.line(), name_, group_});
    for (std::size_t i = 0; i < count; ++i) {
        const tinyobj::index_t& in = indices[i];
        Corner corner{resolve(in.vertex_index, vertices_.size()), resolve(in.normal_index, normals_.size()),
                      resolve(in.texcoord_index, textures_)};
        if (corner.vertex < none)
            fail(relative_fault("vertex", in.vertex_index, vertices_.size()),
                 "a relative index that does not reach before the first");
        if (corner.normal < none)
            warn_normal(lines_.line(), relative_fault("normal", in.normal_index, normals_.size()));
        if (corner.texture < none)
            warn_texture(lines_.line(), relative_fault("texture coordinate", in.texcoord_index, textures_));
        corners_.push_back(corner);
    }
}

void ObjParser::check_range(const Face& face, Corner& corner) {
    const auto beyond = [](std::int32_t index, std::size_t count) {
        return index > none && static_cast<std::size_t>(index) >= count;
    };
    const auto what = [](const char* kind, std::int32_t index) {
        return "'f' names " + std::string(kind) + " " + std::to_string(std::int64_t{index} + 1);
    };
    const auto all = [](std::size_t count) { return "one of the " + std::to_string(count) + " of the file"; };
    if (beyond(corner.vertex, vertices_.size()))
        throw InputError(lines_.file(), face.line, what("vertex", corner.vertex), all(vertices_.size()));
    if (beyond(corner.normal, normals_.size())) {
        warn_normal(face.line, what("normal", corner.normal) + ", not " + all(normals_.size()));
        corner.normal = none;
    }
    if (beyond(corner.texture, textures_))
        warn_texture(face.line, what("texture coordinate", corner.texture) + ", not " + all(textures_));
}

bool ObjParser::has_normals(const Face& face) const {
    for (std::size_t i = 0; i < face.corners; ++i) {
        if (corners_[face.first_corner + i].normal <= none) return false;
    }
    return true;
}

void ObjParser::take_vertices(const Face& face) {
    indices_.clear();
    places_.clear();
    for (std::size_t i = 0; i < face.corners; ++i) {
        const std::int32_t vertex = corners_[face.first_corner + i].vertex;
        indices_.push_back(static_cast<std::uint32_t>(vertex));
        places_.push_back(vertices_[static_cast<std::size_t>(vertex)]);
    }
}

void ObjParser::build(const Face& face) {
    take_vertices(face);
    std::vector<dvec3> normals;
    if (has_normals(face)) {
        for (std::size_t i = 0; i < face.corners; ++i) {
            const Corner& corner = corners_[face.first_corner + i];
            normals.push_back(normals_[static_cast<std::size_t>(corner.normal)]);
        }
    } else if (face.group > 0) {
        normals = smooth_.of(face.group, indices_, places_);
    }
    add_outline(scene_, material_of(face.name, face.line), places_, std::move(normals),
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

}  // namespace raycell
