#include "scenes/obj_materials.hpp"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <istream>
#include <utility>
#include <vector>

#include "model/files/input_file.hpp"
#include "scenes/obj_lines.hpp"

namespace raycell {

namespace {

constexpr double max_intensity = 1e6;
constexpr double min_ior = 0.01;
constexpr double usual_shine = 1000;  ///< upper end of MTL's own range of Ns

/// Facts about an MTL material that tinyobjloader does not pass on.
struct Facts {
    std::string name;
    std::size_t line = 0;
    bool has_diffuse = false;
    bool has_filter = false;  ///< Tf
    bool has_illum = false;
    bool ambient = false;                ///< Ka is not black
    std::optional<double> dissolve;      ///< d
    std::optional<double> transparency;  ///< Tr
};

/// Feeds tinyobjloader with the relevant lines, complete and checked.
class MtlFeed : public LineFeed {
  public:
    MtlFeed(TextSource source, const std::map<std::string, std::uint32_t>& known, Diagnostics& diagnostics)
        : lines_(std::move(source)), known_(known), diagnostics_(diagnostics) {}

    const std::vector<Facts>& facts() const { return facts_; }

    void warn(std::size_t line, const std::string& kind, const std::string& text) {
        diagnostics_.warn(lines_.file(), line, kind, text);
    }

  private:
    bool next_line(std::string& text) override {
        text.clear();
        if (!lines_.next(line_)) return false;
        const std::vector<std::string_view> words = split(line_);
        if (words.empty()) return true;
        const std::string_view key = words[0];
        if (key == "newmtl") {
            begin_material(text);
        } else if (key == "Kd" || key == "Ks" || key == "Ke" || key == "Tf") {
            colour(words, text);
        } else if (key == "Ns" || key == "Ni" || key == "d" || key == "Tr") {
            scalar(words, text);
        } else if (key == "illum") {
            illumination(words, text);
        } else {
            leave_out(words);
        }
        return true;
    }

    /// Warns of statements that are not read, once per kind.
    void leave_out(const std::vector<std::string_view>& words) {
        const std::string_view key = words[0];
        const auto is_one_of = [&](std::initializer_list<std::string_view> keys) {
            return std::find(keys.begin(), keys.end(), key) != keys.end();
        };
        const auto name = [&](const std::string& why) {
            const std::string quoted = "'" + printable(key) + "'";
            diagnostics_.warn(lines_.file(), lines_.line(), "ignored " + quoted, quoted + why, 1);
        };
        if (key == "Ka") {
            const bool black = std::none_of(words.begin() + 1, words.end(), [](std::string_view word) {
                double value = 0;
                return parse_number(word, value) == NumberFault::none && value > 0;
            });
            if (in_material_) facts_.back().ambient = !black;
        } else if (key.substr(0, 4) == "map_" || is_one_of({"bump", "norm", "disp", "decal", "refl"})) {
            name(" is ignored: textures are not read");
        } else if (is_one_of({"Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor"})) {
            name(" is ignored: a material has Kd, Ks, Ns, Ni and d, no physically based values");
        } else if (key == "sharpness") {
            name(" is ignored: reflections are sharp");
        } else {
            // Before its first material the file may be of any kind, so no message quotes its text.
            const std::string kind = facts_.empty() ? "unknown word" : unknown_.kind(key);
            diagnostics_.warn(lines_.file(), lines_.line(), kind, kind + "; the line is ignored", 1);
        }
    }

    void begin_material(std::string& text) {
        const std::string name(rest_of(line_));
        const auto same = [&](const Facts& f) { return f.name == name; };
        in_material_ = false;
        if (name.empty()) return ignore("newmtl without a name");
        if (known_.count(name) > 0 || std::any_of(facts_.begin(), facts_.end(), same)) {
            return warn(lines_.line(), "material twice",
                        "a material of this name was defined before; the first holds");
        }
        in_material_ = true;
        Facts facts;
        facts.name = name;
        facts.line = lines_.line();
        facts_.push_back(std::move(facts));
        text = "newmtl " + name + "\n";
    }

    void ignore(const std::string& what) {
        warn(lines_.line(), "material line", what + "; the line is ignored");
    }

    /// The number, or nothing if the word is none. Messages then do not quote the text: the file may turn out
    /// not to be a material library.
    static std::optional<double> number(std::string_view word) {
        double value = 0;
        if (parse_number(word, value) != NumberFault::none) return std::nullopt;
        return value;
    }

    void colour(const std::vector<std::string_view>& words, std::string& text) {
        std::vector<double> values;
        for (std::size_t i = 1; i < words.size(); ++i) {
            const auto value = number(words[i]);
            if (!value) return ignore("not a colour of numbers");
            values.push_back(*value);
        }
        if (values.empty()) return ignore("a colour without numbers");
        if (!in_material_) return;
        if (values.size() != 3) {
            warn(lines_.line(), "colour components",
                 "a colour of other than 3 numbers; missing ones repeat the last, more are left out");
            values.resize(3, values.back());
        }
        char out[128];
        std::snprintf(out, sizeof out, " %.17g %.17g %.17g\n", values[0], values[1], values[2]);
        text = std::string(words[0]) + out;
        facts_.back().has_diffuse |= words[0] == "Kd";
        facts_.back().has_filter |= words[0] == "Tf";
    }

    void scalar(const std::vector<std::string_view>& words, std::string& text) {
        const std::size_t at = words.size() > 1 && words[1] == "-halo" ? 2 : 1;
        const auto value = words.size() > at ? number(words[at]) : std::nullopt;
        if (!value) return ignore("not a number");
        if (!in_material_) return;
        char out[64];
        std::snprintf(out, sizeof out, " %.17g\n", *value);
        text = std::string(words[0]) + out;
        if (words[0] == "d") facts_.back().dissolve = value;
        if (words[0] == "Tr") facts_.back().transparency = value;
    }

    void illumination(const std::vector<std::string_view>& words, std::string& text) {
        int model = -1;
        const std::string_view word = words.size() > 1 ? words[1] : std::string_view();
        const auto result = std::from_chars(word.data(), word.data() + word.size(), model);
        if (!in_material_) return;
        if (result.ec != std::errc() || result.ptr != word.data() + word.size() || model < 0 || model > 10) {
            warn(lines_.line(), "illumination model", "illum is not one of 0 to 10; taken as 2");
            model = 2;
        }
        facts_.back().has_illum = true;
        text = "illum " + std::to_string(model) + "\n";
    }

    LineReader lines_;
    const std::map<std::string, std::uint32_t>& known_;
    Diagnostics& diagnostics_;
    std::vector<Facts> facts_;
    UnknownWords unknown_;
    std::string line_;
    bool in_material_ = false;
};

double mean(const tinyobj::real_t (&c)[3]) { return (c[0] + c[1] + c[2]) / 3; }

Material convert(const tinyobj::material_t& in, const Facts& facts, MtlFeed& feed) {
    const auto warn = [&](const char* kind, const char* text) { feed.warn(facts.line, kind, text); };
    const auto share = [&](double value, const char* name) {
        if (value < 0 || value > 1) warn(name, name);
        return std::clamp(value, 0.0, 1.0);
    };
    Material m;
    if (facts.has_diffuse) {
        m.diffuse = 1;
        for (int i = 0; i < 3; ++i) m.colour[i] = std::clamp(double(in.diffuse[i]), 0.0, max_intensity);
        if (m.colour != dvec3(in.diffuse[0], in.diffuse[1], in.diffuse[2])) {
            warn("colour range", "Kd below 0 or above 1e6; brought to the nearest of them");
        }
    } else {
        warn("no Kd", "a material without Kd; it gets the default colour (grey 0.7, Kd 0.8)");
    }
    if (facts.has_diffuse && m.colour == dvec3(0) && facts.ambient)
        warn("Ka", "Ka is ignored: ambient light takes the colour of Kd, which is black");
    for (int i = 0; i < 3; ++i) m.emission[i] = std::clamp(double(in.emission[i]), 0.0, max_intensity);
    if (m.emission != dvec3(in.emission[0], in.emission[1], in.emission[2]))
        warn("emission range", "Ke below 0 or above 1e6; brought to the nearest of them");
    m.specular = share(mean(in.specular), "the mean of Ks is outside 0 to 1; brought to the nearest of them");
    m.mirror = in.illum >= 3 && in.illum <= 9;
    if (in.shininess < 0) warn("negative Ns", "Ns below 0; taken as 0");
    if (in.shininess > usual_shine)
        warn("large Ns", "Ns above 1000; kept, the highlight may be too small to see");
    m.shine = std::max(double(in.shininess), 0.0);
    m.ior = in.ior;
    if (m.ior < min_ior) {
        warn("Ni", "Ni below 0.01; taken as 1");
        m.ior = 1;
    }

    const bool refracts = in.illum == 4 || in.illum == 6 || in.illum == 7 || in.illum == 9;
    if (facts.dissolve && facts.transparency && std::abs(*facts.dissolve + *facts.transparency - 1) > 1e-6) {
        warn("d and Tr", "d and Tr disagree (Tr is 1 - d); d holds");
    }
    const bool says_opacity = facts.dissolve || facts.transparency;
    if (refracts && !says_opacity && facts.has_filter) {
        warn("Tf", "illum asks for refraction without d or Tr; the mean of Tf is the transmitted share");
    }
    const dvec3 filter(in.transmittance[0], in.transmittance[1], in.transmittance[2]);
    if (refracts && says_opacity && facts.has_filter && filter != dvec3(1)) {
        warn("Tf ignored", "Tf is ignored where d or Tr is given: glass has no colour of its own");
    }
    const double through = says_opacity ? 1 - in.dissolve : facts.has_filter ? mean(in.transmittance) : 0;
    if (refracts) {
        m.transmit =
            share(through, "the transmitted share is outside 0 to 1; brought to the nearest of them");
    } else if (says_opacity && through > 0) {
        warn("opaque",
             facts.has_illum
                 ? "d or Tr lets light through, but illum asks for no refraction; opaque"
                 : "d or Tr lets light through, but no illum is given; opaque, as only illum 4, 6, 7 "
                   "and 9 refract");
    }
    return m;
}

}  // namespace

MaterialLibraries::MaterialLibraries(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (folder_.empty()) folder_ = ".";
}

void MaterialLibraries::load(std::string_view name, const Place& place, Scene& scene,
                             Diagnostics& diagnostics) {
    const auto refuse = [&](const std::string& why) {
        incomplete_ = true;
        diagnostics.warn(
            place.file, place.line, "material library",
            "material library '" + printable(name) + "' " + why + "; its materials become the default");
    };
    std::string portable(name);
    std::replace(portable.begin(), portable.end(), '\\', '/');
    const std::filesystem::path relative(portable);
    std::error_code error;
    const auto root = std::filesystem::weakly_canonical(folder_, error);
    if (error || portable.empty()) return refuse("can't be found");
    const auto path = std::filesystem::weakly_canonical(folder_ / relative, error);
    if (error) return refuse("can't be found");
    const auto from_root = path.lexically_relative(root);
    if (relative.is_absolute() || from_root.empty() || *from_root.begin() == "..") {
        return refuse("is outside the scene's folder and not opened");
    }
    if (!std::filesystem::exists(path, error)) return refuse("can't be found");
    const std::string fault = input_fault(path);
    if (!fault.empty()) return refuse(fault);
    if (!loaded_.insert(path).second) return;
    scene.libraries.push_back(path.string());

    std::map<std::string, int> indices;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;  // unused: the feed has warned, with line numbers
    std::optional<MtlFeed> reading;
    try {
        reading.emplace(TextSource(folder_ / relative), by_name_, diagnostics);
        std::istream stream(&*reading);
        stream.exceptions(std::ios::badbit);  // otherwise the stream would swallow the feed's errors
        tinyobj::LoadMtl(&indices, &materials, &stream, &warnings, &errors);
    } catch (const InputError& fault_in_text) {
        return refuse(std::string("can't be read (") + fault_in_text.what() + ")");
    }
    MtlFeed& feed = *reading;
    for (const Facts& facts : feed.facts()) {
        const auto found = indices.find(facts.name);
        if (found == indices.end()) continue;
        by_name_[facts.name] = static_cast<std::uint32_t>(scene.materials.size());
        scene.materials.push_back(
            convert(materials.at(static_cast<std::size_t>(found->second)), facts, feed));
    }
    if (feed.facts().empty()) refuse("defines no material");
}

std::optional<std::uint32_t> MaterialLibraries::find(const std::string& name) const {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) return std::nullopt;
    return found->second;
}

}  // namespace raycell
