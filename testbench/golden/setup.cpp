// The head of golden vectors: what a cell knows before anything happens.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "testbench/golden/file.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {
namespace {

/// Reads one line, word by word. All readers throw GoldenError.
class Line {
  public:
    Line(const std::string& file, const GoldenFile::Line& line) : file_(file), line_(line) {}
    [[noreturn]] void fail(const std::string& what) const {
        throw GoldenError(file_ + ":" + std::to_string(line_.number) + ": " + line_.tokens[0] + ": " + what);
    }
    const std::string& next() {
        if (at_ == line_.tokens.size()) fail("a word is missing");
        return line_.tokens[at_++];
    }
    bool done() const { return at_ == line_.tokens.size(); }
    void finish() const {
        if (!done()) fail("'" + line_.tokens[at_].substr(0, 60) + "': expected no more");
    }
    int whole(int most) {
        const std::string& token = next();
        int value = -1;
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, value);
        if (stop != end || error != std::errc() || value < 0 || value > most)
            fail("'" + token.substr(0, 60) + "': expected a number from 0 to " + std::to_string(most));
        return value;
    }
    template <typename F>
    double number(F&& read) {
        const std::string& token = next();
        try {
            return read(token);
        } catch (const GoldenError& error) {
            fail(error.what());
        }
    }
    int exponent() {
        const std::string& token = next();
        int value = 0;
        const char* const end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, value);
        if (stop != end || error != std::errc() || value < -32 || value > 31)
            fail("'" + token.substr(0, 60) + "': expected an exponent from -32 to 31");
        return value;
    }
    /// The kind of a source: a point if its word is missing.
    SourceKind kind() {
        for (int i = 1; i < source_kinds; ++i) {
            if (at_ == line_.tokens.size() || line_.tokens[at_] != name_of(SourceKind(i))) continue;
            ++at_;
            return SourceKind(i);
        }
        return SourceKind::point;
    }
    double hexadecimal() { return number(Words::read_hexadecimal); }
    double word(const Words& words, const Format& format) {
        return number([&](const std::string& t) { return words.read_word(format, t); });
    }
    double floating(const Words& words, int bits) {
        return number([&](const std::string& t) { return words.read_floating(bits, t); });
    }
    dvec3 vector(const Words& words, const Format& format) {
        const double x = word(words, format), y = word(words, format);
        return {x, y, word(words, format)};
    }

  private:
    const std::string& file_;
    const GoldenFile::Line& line_;
    std::size_t at_ = 1;
};

std::string vector_text(const Words& words, const Format& format, const dvec3& v) {
    return " " + words.word(format, v.x) + " " + words.word(format, v.y) + " " + words.word(format, v.z);
}

std::string place_text(const Words& words, const dvec3& v) {
    const int bits = words.formats().word_bits + 12;
    return " " + words.floating(bits, v.x) + " " + words.floating(bits, v.y) + " " +
           words.floating(bits, v.z);
}

std::string object_text(const Words& words, const Material& m) {
    const Formats& f = words.formats();
    return vector_text(words, f.feature, m.colour) + " " + words.word(f.feature, m.diffuse) + " " +
           words.word(f.feature, m.specular) + " " + words.word(f.feature, m.transmit) + " " +
           words.floating(f.shine_bits - 4, m.shine) + " " + words.word(f.ior, m.ior) + " " +
           (m.mirror ? "1" : "0");
}

Material read_object(Line& line, const Words& words) {
    const Formats& f = words.formats();
    Material m;
    m.colour = line.vector(words, f.feature);
    m.diffuse = line.word(words, f.feature);
    m.specular = line.word(words, f.feature);
    m.transmit = line.word(words, f.feature);
    m.shine = line.floating(words, f.shine_bits - 4);
    m.ior = line.word(words, f.ior);
    m.mirror = line.whole(1) == 1;
    return m;
}

/// Mantissas of one exponent: the place, the edges or the radius; then the exponent.
std::string extent_text(const Words& words, const Source& source) {
    const Format mantissa(1, words.formats().word_bits + 11);
    const auto text = [&](const dvec3& v) {
        return vector_text(words, mantissa,
                           {scale_by(v.x, -source.exponent), scale_by(v.y, -source.exponent),
                            scale_by(v.z, -source.exponent)});
    };
    const std::string extent = source.kind == SourceKind::sphere
                                   ? " " + words.word(mantissa, scale_by(source.radius, -source.exponent))
                                   : text(source.edge_u) + text(source.edge_v);
    return text(source.position) + extent + " " + std::to_string(source.exponent);
}

void read_extent(Line& line, const Words& words, Source& source) {
    const Format mantissa(1, words.formats().word_bits + 11);
    source.position = line.vector(words, mantissa);
    if (source.kind == SourceKind::sphere) {
        source.radius = line.word(words, mantissa);
    } else {
        source.edge_u = line.vector(words, mantissa);
        source.edge_v = line.vector(words, mantissa);
    }
    source.exponent = line.exponent();
    const double scale = scale_by(1, source.exponent);
    source.position *= scale, source.edge_u *= scale, source.edge_v *= scale, source.radius *= scale;
}

/// A point is its place and its intensity; another source begins with the word for its kind.
std::string source_text(const Words& words, const Source& source) {
    const Formats& f = words.formats();
    std::string text;
    if (source.kind != SourceKind::point) text += std::string(" ") + name_of(source.kind);
    if (is_area(source.kind))
        text += extent_text(words, source);
    else if (source.kind != SourceKind::directional)
        text += place_text(words, source.position);
    if (source.kind != SourceKind::point && source.kind != SourceKind::sphere)
        text += vector_text(words, f.unit, source.axis);
    if (source.kind == SourceKind::spot)
        text +=
            " " + words.word(f.unit, source.cut_off) + " " + words.floating(f.shine_bits - 4, source.falloff);
    return text + vector_text(words, f.intensity, source.intensity);
}

Source read_source(Line& line, const Words& words) {
    const Formats& f = words.formats();
    Source source;
    source.kind = line.kind();
    if (is_area(source.kind)) {
        read_extent(line, words, source);
    } else if (source.kind != SourceKind::directional) {
        const int bits = f.word_bits + 12;
        const double x = line.floating(words, bits), y = line.floating(words, bits);
        source.position = {x, y, line.floating(words, bits)};
    }
    if (source.kind != SourceKind::point && source.kind != SourceKind::sphere)
        source.axis = line.vector(words, f.unit);
    if (source.kind == SourceKind::spot) {
        source.cut_off = line.word(words, f.unit);
        source.falloff = line.floating(words, f.shine_bits - 4);
    }
    source.intensity = line.vector(words, f.intensity);
    return source;
}

/// Reads the lines of the head: first the cell's place, links and frame, which its number formats depend on,
/// then the rest.
class SetupReader {
  public:
    SetupReader(const GoldenFile& file, CellSetup& setup) : file_(file), setup_(setup) {}

    void read() {
        Frame& frame = setup_.scene.frame;
        frame.width = setup_.picture.width;
        frame.height = setup_.picture.height;
        frame.depth_levels = setup_.picture.depth_levels;
        for (const auto& line : file_.head) where(line);
        for (const char* name : {"cell", "links", "frame"}) {
            if (seen_.count(name)) continue;
            throw GoldenError(file_.name + ": line '" + name + "' is missing in the head");
        }
        const Arithmetic arithmetic(setup_.picture.numbers, extent_of(frame));
        const Words words(arithmetic);
        for (const auto& line : file_.head) what(line, words);
        const Context context(setup_.scene, setup_.picture);
        const Packing packing(context, setup_.machine);
        for (const auto& line : file_.head) check_layout(line, packing.layouts());
        check_links();
    }

  private:
    void where(const GoldenFile::Line& tokens) {
        Line line(file_.name, tokens);
        const std::string& name = tokens.tokens[0];
        if (name == "cell") {
            setup_.x = line.whole(setup_.picture.width - 1);
            setup_.y = line.whole(setup_.picture.height - 1);
        } else if (name == "links") {
            while (!line.done()) {
                const std::string& side = line.next();
                int i = 0;
                while (i < side_count && side != name_of_side(i)) ++i;
                if (i == side_count)
                    line.fail("'" + side.substr(0, 60) + "': expected east, south, west, north");
                setup_.linked[std::size_t(i)] = true;
            }
        } else if (name == "frame") {
            read_frame(line);
        } else if (name == "beyond") {
            for (bool& face : setup_.scene.beyond) face = line.whole(1) == 1;
        } else if (name != "format" && name != "layout" && name != "background" && name != "object" &&
                   name != "source") {
            line.fail(
                "expected cell, links, frame, beyond, format, layout, background, object, source or begin");
        } else {
            return;
        }
        if (!seen_.insert(name).second) line.fail("expected it once");
        line.finish();
    }

    void read_frame(Line& line) {
        Frame& frame = setup_.scene.frame;
        frame.depth = line.hexadecimal();
        if (!(frame.depth > 0 && frame.depth < 1e9)) line.fail("expected a depth from 0 to 1e9 cell widths");
        frame.viewer_at_infinity = line.whole(1) == 1;
        for (int axis = 0; axis < 3; ++axis) {
            frame.eye[axis] = line.hexadecimal();
            if (!(std::abs(frame.eye[axis]) < 1e9))
                line.fail("expected a viewer less than 1e9 cell widths away");
        }
    }

    void what(const GoldenFile::Line& tokens, const Words& words) {
        Line line(file_.name, tokens);
        const std::string& name = tokens.tokens[0];
        CellScene& scene = setup_.scene;
        if (name == "background") {
            scene.background = line.vector(words, words.formats().intensity);
        } else if (name == "object") {
            scene.objects.push_back(read_object(line, words));
        } else if (name == "source") {
            if (scene.sources.size() == max_sources) line.fail("expected 64 at most");
            scene.sources.push_back(read_source(line, words));
        } else if (name == "format") {
            const std::string& of = line.next();
            const std::string& is = line.next();
            const auto all = words.formats().names();
            const auto known =
                std::find_if(all.begin(), all.end(), [&](const auto& f) { return f.first == of; });
            if (known == all.end()) line.fail("'" + of.substr(0, 60) + "': no such format");
            if (known->second != is)
                line.fail(of + " is '" + is.substr(0, 60) + "': expected " + known->second +
                          ", by the configuration");
        } else {
            return;
        }
        line.finish();
    }

    /// A layout must be that of the configuration.
    void check_layout(const GoldenFile::Line& tokens, const std::vector<std::string>& layouts) const {
        if (tokens.tokens[0] != "layout") return;
        Line line(file_.name, tokens);
        std::string text = line.next();
        while (!line.done()) text += " " + line.next();
        if (std::find(layouts.begin(), layouts.end(), text) == layouts.end())
            line.fail("'" + text.substr(0, 60) + "': no message of this configuration has this layout");
    }

    void check_links() const {
        const bool host =
            setup_.picture.exterior == ExteriorMode::host && setup_.picture.stage == RunStage::trace &&
            std::any_of(setup_.scene.beyond.begin(), setup_.scene.beyond.end(), [](bool b) { return b; });
        for (int side = 0; side < side_count; ++side) {
            const int x = setup_.x + step_x(Side(side));
            const int y = setup_.y + step_y(Side(side));
            const bool inside = x >= 0 && x < setup_.picture.width && y >= 0 && y < setup_.picture.height;
            if (setup_.linked[std::size_t(side)] == (inside || host)) continue;
            throw GoldenError(file_.name + ": links: expected " + (inside || host ? "one" : "none") +
                              " in the " + name_of_side(side) + " of this cell");
        }
    }

    const GoldenFile& file_;
    CellSetup& setup_;
    std::set<std::string> seen_;
};

}  // namespace

std::string setup_text(const CellSetup& setup, const Context& context, const std::string& configuration) {
    const Words words(context.arithmetic);
    const Frame& frame = context.scene.frame;
    std::ostringstream text;
    text << golden_version << '\n';
    if (setup.traversal) text << traversal_part << '\n';
    std::istringstream lines(configuration);
    for (std::string line; std::getline(lines, line);) text << "config " << line << '\n';
    text << "cell " << setup.x << ' ' << setup.y << "\nlinks";
    for (int side = 0; side < side_count; ++side) {
        if (setup.linked[std::size_t(side)]) text << ' ' << name_of_side(side);
    }
    text << "\nframe " << Words::hexadecimal(frame.depth) << ' ' << frame.viewer_at_infinity;
    for (int axis = 0; axis < 3; ++axis) text << ' ' << Words::hexadecimal(frame.eye[axis]);
    text << "\nbeyond";
    for (const bool face : context.scene.beyond) text << ' ' << face;
    text << '\n';
    for (const auto& [name, format] : words.formats().names())
        text << "format " << name << ' ' << format << '\n';
    for (const std::string& layout : Packing(context, setup.machine).layouts())
        text << "layout " << layout << '\n';
    text << "background" << vector_text(words, words.formats().intensity, context.background) << '\n';
    for (const Material& object : context.objects) text << "object" << object_text(words, object) << '\n';
    for (const Source& source : context.lights.sources) {
        text << "source" << source_text(words, source) << '\n';
    }
    text << "begin\n";
    return text.str();
}

void read_setup(const GoldenFile& file, CellSetup& setup) { SetupReader(file, setup).read(); }

}  // namespace raycell
