#include "model/machine/load_wire.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/numbers/bits.hpp"
#include "model/numbers/field_widths.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {
namespace {

/// One list of fields serves for writing, reading and naming them.
class Packer {
  public:
    WireBits bits;
    LoadType type(LoadType type) {
        bits.put(std::uint64_t(type), field::type);
        return type;
    }
    void word(const char* name, double& value, const Format& format, const char*) {
        put_word(bits, name, value, format, format.bits());
    }
    void unsigned_word(const char* name, double& value, const Format& format, const char*) {
        put_number(bits, name, std::uint64_t(value / format.step()), format.bits() - 1);
    }
    template <typename T>
    void number(const char* name, T& value, int width, const char*) {
        put_number(bits, name, std::uint64_t(value), width);
    }
    void exponent(const char* name, int& value, int width, const char*) {
        const int limit = 1 << unsigned(width - 1);
        if (value < -limit || value >= limit) refuse_value(name, value, width);
        bits.put_signed(value, width);
    }
    template <typename List>
    void count(const char* name, List&, int size, int width, const char* meaning) {
        number(name, size, width, meaning);
    }
    static constexpr bool reads = false;
};

class Unpacker {
  public:
    explicit Unpacker(const WireBits& packed) : bits(packed) {}
    WireBits bits;
    LoadType type(LoadType) { return LoadType(bits.get(field::type)); }
    void word(const char*, double& value, const Format& format, const char*) {
        value = get_word(bits, format, format.bits());
    }
    void unsigned_word(const char*, double& value, const Format& format, const char*) {
        value = double(bits.get(format.bits() - 1)) * format.step();
    }
    template <typename T>
    void number(const char*, T& value, int width, const char*) {
        value = T(bits.get(width));
    }
    void exponent(const char*, int& value, int width, const char*) { value = int(bits.get_signed(width)); }
    template <typename List>
    void count(const char*, List& list, int, int width, const char*) {
        list.resize(bits.get(width));
    }
    static constexpr bool reads = true;
};

class Namer {
  public:
    std::vector<WireField> all;
    LoadType type(LoadType type) {
        all.push_back({"type", field::type, std::to_string(int(type))});
        return type;
    }
    void word(const char* name, double&, const Format& format, const char* meaning) {
        all.push_back({name, format.bits(), meaning});
    }
    void unsigned_word(const char* name, double&, const Format& format, const char* meaning) {
        all.push_back({name, format.bits() - 1, meaning});
    }
    template <typename T>
    void number(const char* name, T&, int width, const char* meaning) {
        all.push_back({name, width, meaning});
    }
    void exponent(const char* name, int&, int width, const char* meaning) {
        all.push_back({name, width, meaning});
    }
    template <typename List>
    void count(const char* name, List&, int, int width, const char* meaning) {
        all.push_back({name, width, meaning});
    }
    static constexpr bool reads = false;
};

template <typename Archive>
void vector(Archive& a, const std::array<const char*, 3>& names, dvec3& v, const Format& format,
            const char* meaning) {
    for (int axis = 0; axis < 3; ++axis) a.word(names[std::size_t(axis)], v[axis], format, meaning);
}

/// The axis that the plane drops, the sign of its component there (which is 1 or -1), two slopes.
template <typename Archive>
void fields_of_slopes(Archive& a, Plane& plane, int& drop, const Format& word, const char* format) {
    a.number("axis", drop, field::axis, "0 x, 1 y, 2 z: the plane's largest component");
    if (drop > 2) throw std::length_error("load message: axis 3; expected 0 to 2");
    bool negative = plane.n[drop] < 0;
    a.number("sign", negative, 1, "1: this component is -1, not 1");
    plane.n[drop] = negative ? -1 : 1;
    const Projection axes = projection(drop);
    a.word("slope u", plane.n[axes.u], word, format);
    a.word("slope v", plane.n[axes.v], word, format);
}

template <typename Archive>
void fields_of_plane(Archive& a, Plane& plane, int& drop, const Format& word) {
    fields_of_slopes(a, plane, drop, word, "loading: component of the normal");
    a.word("offset", plane.c, word, "loading: normal · place of a point on it");
}

template <typename Archive>
void fields_of_normal(Archive& a, NormalField& normal, const Format& word) {
    vector(a, {"n x", "n y", "n z"}, normal.base, word, "loading: normal at u = v = 0");
    vector(a, {"nu x", "nu y", "nu z"}, normal.du, word, "loading: its change with u");
    vector(a, {"nv x", "nv y", "nv z"}, normal.dv, word, "loading: its change with v");
}

/// Edges of a trapeze or a span.
template <typename Archive>
void fields_of_edges(Archive& a, std::array<EdgeFunction, 4>& edges, int& count, const Format& word) {
    a.number("edges", count, field::edges, "how many follow");
    if (count > 4)
        throw std::length_error("load message: " + std::to_string(count) + " edges; expected at most 4");
    for (int i = 0; i < count; ++i) {
        EdgeFunction& edge = edges[std::size_t(i)];
        a.word("edge a", edge.a, word, "loading: a · u + b · v + c >= 0 inside");
        a.word("edge b", edge.b, word, "loading: b");
        a.word("edge c", edge.c, word, "loading: c, a distance");
    }
}

/// The smallest exponent with which every mantissa is from -1 up and below 1.
int exponent_of_place(const dvec3& place) {
    const double least = std::min({place.x, place.y, place.z});
    const double most = std::max({place.x, place.y, place.z});
    if (!(most > 0) && !(least < 0)) return 0;
    const double largest = std::max(most, -least);
    const int exponent = exponent_of(largest);
    return least == -scale_by(1, exponent) && most < scale_by(1, exponent) ? exponent : exponent + 1;
}

/// Three mantissas with one exponent.
template <typename Archive>
void fields_of_place(Archive& a, dvec3& place, const Formats& formats) {
    const Format mantissa(1, formats.word_bits + 11);
    int exponent = exponent_of_place(place);
    dvec3 scaled{scale_by(place.x, -exponent), scale_by(place.y, -exponent), scale_by(place.z, -exponent)};
    vector(a, {"place x", "place y", "place z"}, scaled, mantissa, "mantissa, below 1");
    a.exponent("place exponent", exponent, Formats::exponent_bits, "of all three");
    if constexpr (Archive::reads) {
        for (int axis = 0; axis < 3; ++axis) place[axis] = scale_by(scaled[axis], exponent);
    }
}

template <typename Archive>
void fields_of_level(Archive& a, double& level) {
    int exponent = level > 0 ? exponent_of(level) : 0;
    const int shift = field::level_mantissa - 1;
    auto mantissa = std::uint32_t(scale_by(level, shift - exponent));
    a.number("level", mantissa, field::level_mantissa, "height of a depth level: mantissa m, m · 2^(e - 15)");
    a.exponent("level exponent", exponent, Formats::exponent_bits, "e");
    if constexpr (Archive::reads) level = scale_by(mantissa, exponent - shift);
}

/// A float of `bits` bits: 0 is 0, else 5 bits of exponent from 2^-8 on, counted from 1.
template <typename Archive>
void fields_of_shine(Archive& a, double& shine, const Formats& formats,
                     const std::array<const char*, 2>& names) {
    const int fraction = formats.shine_bits - Formats::shine_exponent_bits;
    int exponent = shine > 0 ? exponent_of(shine) + 9 : 0;
    auto rest = std::uint32_t(shine > 0 ? scale_by(scale_by(shine, 9 - exponent) - 1, fraction) : 0);
    a.number(names[0], exponent, Formats::shine_exponent_bits, "e: 2^(e - 9); 0: no power");
    a.number(names[1], rest, fraction, "behind the leading 1");
    if constexpr (Archive::reads)
        shine = exponent == 0 ? 0 : scale_by(1 + scale_by(rest, -fraction), exponent - 9);
}

}  // namespace

ViewerMessage viewer_of(const Context& context) {
    const Frame& frame = context.scene.frame;
    return {context.eye,
            frame.viewer_at_infinity,
            context.scene.beyond,
            context.background,
            frame.depth_levels,
            frame.level(),
            context.lights.sources,
            !SourceCounts(context.lights.sources, 1).points(),
            context.lights.samples,
            context.lights.share};
}

LoadWire::LoadWire(const PictureSettings& picture, const Formats& formats)
    : formats_(formats),
      hit_(picture.hit),
      normals_(picture.normals),
      gouraud_(picture.display == Display::gouraud),
      x_bits_(bits_for(picture.width)),
      y_bits_(bits_for(picture.height)) {}

namespace {

/// Of an area: its place, and what its points are sums of, mantissas of the same exponent.
template <typename Archive>
void fields_of_extent(Archive& a, Source& source, const Formats& formats) {
    const Format mantissa(1, formats.word_bits + 11);
    const auto scaled = [&](dvec3& v, const std::array<const char*, 3>& names) {
        dvec3 m{scale_by(v.x, -source.exponent), scale_by(v.y, -source.exponent),
                scale_by(v.z, -source.exponent)};
        vector(a, names, m, mantissa, "mantissa, below 1");
        if constexpr (Archive::reads) {
            for (int axis = 0; axis < 3; ++axis) v[axis] = scale_by(m[axis], source.exponent);
        }
    };
    a.exponent("place exponent", source.exponent, Formats::exponent_bits, "of all mantissas");
    scaled(source.position, {"place x", "place y", "place z"});
    if (source.kind != SourceKind::sphere) {
        scaled(source.edge_u, {"u x", "u y", "u z"});
        scaled(source.edge_v, {"v x", "v y", "v z"});
        return;
    }
    double radius = scale_by(source.radius, -source.exponent);
    a.word("radius", radius, mantissa, "mantissa, below 1");
    if constexpr (Archive::reads) source.radius = scale_by(radius, source.exponent);
}

/// The pattern of an area's samples.
template <typename Archive>
void fields_of_pattern(Archive& a, int& samples, double& share, const Formats& formats) {
    a.number("samples", samples, field::samples, "how many");
    if (samples < 1 || std::size_t(samples) > max_sources)
        throw std::length_error("load message: " + std::to_string(samples) + " samples; expected 1 to 64");
    SamplePlace step = step_of(samples);
    a.number("step u", step.u, field::sample_place, "fraction: from each sample to the next");
    a.number("step v", step.v, field::sample_place, "fraction");
    // 1 has the mantissa one half.
    int exponent = exponent_of(share) + 1;
    double mantissa = scale_by(share, -exponent);
    a.word("share", mantissa, Format(1, formats.word_bits - 1), "mantissa, below 1: 1 / samples");
    a.exponent("share exponent", exponent, Formats::exponent_bits, "its exponent");
    if constexpr (Archive::reads) share = scale_by(mantissa, exponent);
}

/// A source behind its kind.
template <typename Archive>
void fields_of_source(Archive& a, Source& source, ViewerMessage& viewer, const Formats& formats) {
    const SourceKind kind = source.kind;
    if (is_area(kind)) {
        fields_of_extent(a, source, formats);
    } else if (kind != SourceKind::directional) {
        fields_of_place(a, source.position, formats);
    }
    if (kind != SourceKind::point && kind != SourceKind::sphere)
        vector(a, {"axis x", "axis y", "axis z"}, source.axis, formats.unit,
               "unit: against the way of its light");
    if (kind == SourceKind::spot) {
        a.word("cut-off", source.cut_off, formats.unit, "unit: cosine at the edge of its cone");
        fields_of_shine(a, source.falloff, formats, {"falloff exponent", "falloff fraction"});
    }
    if (is_area(kind)) fields_of_pattern(a, viewer.samples, viewer.share, formats);
    vector(a, {"red", "green", "blue"}, source.intensity, formats.intensity, "intensity");
}

template <typename Archive>
void field_of_kind(Archive& a, SourceKind& kind) {
    int code = int(kind);
    a.number("kind", code, field::source_kind,
             "0 point, 1 directional, 2 spot, 3 rectangle, 4 triangle, 5 sphere");
    if (code >= source_kinds)
        throw std::length_error("load message: a source of kind " + std::to_string(code) +
                                "; expected 0 to " + std::to_string(source_kinds - 1));
    kind = SourceKind(code);
}

}  // namespace

template <typename Archive>
void LoadWire::fields(Archive& a, ViewerMessage& v) const {
    const LoadType type = v.tells_kinds ? LoadType::viewer_of_kinds : LoadType::viewer;
    v.tells_kinds = a.type(type) == LoadType::viewer_of_kinds;
    fields_of_place(a, v.eye, formats_);
    a.number("at infinity", v.at_infinity, 1, "1: the place has no meaning");
    constexpr const char* faces[] = {"beyond left",   "beyond right", "beyond top",
                                     "beyond bottom", "beyond front", "beyond back"};
    for (std::size_t i = 0; i < v.beyond.size(); ++i)
        a.number(faces[i], v.beyond[i], 1, "1: something of the scene lies behind this face of the cube");
    vector(a, {"red", "green", "blue"}, v.background, formats_.intensity, "intensity: the background");
    int more = v.depth_levels - 1;
    a.number("levels", more, field::level_count, "depth levels of the cube, less one");
    v.depth_levels = more + 1;
    fields_of_level(a, v.level);
    a.count("sources", v.sources, int(v.sources.size()), field::source_count, "how many follow");
    for (Source& source : v.sources) {
        if (v.tells_kinds) field_of_kind(a, source.kind);
        fields_of_source(a, source, v, formats_);
    }
}

template <typename Archive>
void LoadWire::fields(Archive& a, Material& m) const {
    a.type(LoadType::features);
    const Format& feature = formats_.feature;
    a.unsigned_word("red", m.colour.x, feature, "feature: colour");
    a.unsigned_word("green", m.colour.y, feature, "feature");
    a.unsigned_word("blue", m.colour.z, feature, "feature");
    a.unsigned_word("Kd", m.diffuse, feature, "feature: share of diffuse light");
    a.unsigned_word("Ks", m.specular, feature, "feature: share of the highlight and the mirrored ray");
    a.unsigned_word("T", m.transmit, feature, "feature: share of the refracted ray");
    fields_of_shine(a, m.shine, formats_, {"Shine exponent", "Shine fraction"});
    a.unsigned_word("index", m.ior, formats_.ior, "index of refraction");
    a.number("mirror", m.mirror, 1, "0: Ks makes a highlight only");
}

template <typename Archive>
void LoadWire::fields(Archive& a, Polygon& p) const {
    a.type(LoadType::polygon);
    const Format& word = formats_.loading;
    a.number("polygon", p.id, field::polygon_id, "its id");
    fields_of_plane(a, p.plane, p.drop, word);
    a.word("slack", p.slack, word, "loading: how far its corners may lie off the plane");
    fields_of_normal(a, p.normal, word);
    a.count("vertices", p.vertices, int(p.vertices.size()), field::vertices, "how many follow");
    for (dvec3& vertex : p.vertices) vector(a, {"x", "y", "z"}, vertex, word, "loading");
}

template <typename Archive>
void LoadWire::fields(Archive& a, Surface& s) const {
    a.type(LoadType::surface);
    const Format& word = formats_.loading;
    a.number("polygon", s.polygon, field::polygon_id, "its id");
    a.number("last row", s.last_row, y_bits_, "of its trapezes");
    fields_of_plane(a, s.plane, s.drop, word);
    a.word("slack", s.slack[s.drop], word, "loading: how far the part may lie off the plane");
    fields_of_normal(a, s.normal, word);
}

template <typename Archive>
void LoadWire::fields(Archive& a, Trapeze& t, CornerIntensities& intensities) const {
    a.type(LoadType::trapeze);
    a.number("first row", t.rows.first, y_bits_, "that it touches");
    a.number("last row", t.rows.last, y_bits_, "that it touches");
    a.number("first column", t.columns.first, x_bits_, "that it touches");
    a.number("last column", t.columns.last, x_bits_, "that it touches");
    fields_of_edges(a, t.edges, t.edge_count, formats_.loading);
    if (!gouraud_) return;
    a.number("corners", t.corner_count, field::edges, "how many of four count");
    for (std::size_t i = 0; i < t.corners.size(); ++i) {
        vector(a, {"x", "y", "z"}, t.corners[i], formats_.loading, "loading");
        vector(a, {"red", "green", "blue"}, intensities[i], formats_.loading, "loading");
    }
}

template <typename Archive>
void LoadWire::fields(Archive& a, Span& s) const {
    a.type(LoadType::span);
    const Format& word = formats_.loading;
    a.number("polygon", s.polygon, field::polygon_id, "its id");
    a.number("X1", s.x, x_bits_, "column that it is relative to");
    a.number("Xr", s.last, x_bits_, "its last column");
    if (hit_ == HitTest::depth) {
        a.word("Z", s.z, word, "loading: depth at the pixel's centre");
        a.word("DZ", s.dz, word, "loading: its change from cell to cell");
        fields_of_slopes(a, s.plane, s.drop, formats_.unit, "unit");
        if (normals_ == Normals::voxel) {
            vector(a, {"N x", "N y", "N z"}, s.n, word, "loading: normal there");
            vector(a, {"DN x", "DN y", "DN z"}, s.dn, word, "loading: its change from cell to cell");
        } else {
            fields_of_normal(a, s.normal, word);
        }
    } else {
        fields_of_plane(a, s.plane, s.drop, word);
        a.word("slack", s.slack[s.drop], word, "loading: how far the part may lie off the plane");
        fields_of_normal(a, s.normal, word);
        fields_of_edges(a, s.edges, s.edge_count, word);
    }
    if (!gouraud_) return;
    vector(a, {"I red", "I green", "I blue"}, s.intensity, word, "loading: intensity at the pixel's centre");
    vector(a, {"DI red", "DI green", "DI blue"}, s.d_intensity, word,
           "loading: its change from cell to cell");
}

// The list of fields is an unpacker's, too: a packer gets copies that it may write to.
template <typename... Parts>
WireBits LoadWire::packed(Parts... parts) const {
    Packer packer;
    fields(packer, parts...);
    return packer.bits;
}
template <typename Message>
Message LoadWire::unpacked(const WireBits& bits) const {
    Unpacker unpacker(bits);
    Message message;
    fields(unpacker, message);
    return message;
}

WireBits LoadWire::pack(const ViewerMessage& viewer) const { return packed(viewer); }
WireBits LoadWire::pack(const Material& features) const { return packed(features); }
WireBits LoadWire::pack(const Polygon& polygon) const { return packed(polygon); }
WireBits LoadWire::pack(const Surface& surface) const { return packed(surface); }
WireBits LoadWire::pack(const Trapeze& trapeze, const CornerIntensities& intensities) const {
    return packed(trapeze, intensities);
}
WireBits LoadWire::pack(const Span& span) const { return packed(span); }
WireBits LoadWire::end_of_scene() const {
    Packer packer;
    packer.type(LoadType::end_of_scene);
    return packer.bits;
}

ViewerMessage LoadWire::unpack_viewer(const WireBits& bits) const { return unpacked<ViewerMessage>(bits); }
Material LoadWire::unpack_features(const WireBits& bits) const { return unpacked<Material>(bits); }
Polygon LoadWire::unpack_polygon(const WireBits& bits) const { return unpacked<Polygon>(bits); }
Surface LoadWire::unpack_surface(const WireBits& bits) const { return unpacked<Surface>(bits); }
Trapeze LoadWire::unpack_trapeze(const WireBits& bits, CornerIntensities& intensities) const {
    Unpacker unpacker(bits);
    Trapeze trapeze;
    fields(unpacker, trapeze, intensities);
    return trapeze;
}
Span LoadWire::unpack_span(const WireBits& bits) const { return unpacked<Span>(bits); }

std::vector<WireField> LoadWire::layout(LoadType type, SourceKind kind) const {
    Namer namer;
    ViewerMessage viewer;
    viewer.sources.resize(1);
    viewer.sources[0].kind = kind;
    viewer.tells_kinds = type == LoadType::viewer_of_kinds;
    Material features;
    Polygon polygon;
    polygon.vertices.resize(1);
    Trapeze trapeze;
    trapeze.edge_count = 1;
    CornerIntensities intensities{};
    Span span;
    span.edge_count = 1;
    switch (type) {
        case LoadType::viewer:
        case LoadType::viewer_of_kinds:
            fields(namer, viewer);
            break;
        case LoadType::features:
            fields(namer, features);
            break;
        case LoadType::polygon:
            fields(namer, polygon);
            break;
        case LoadType::surface:
            fields(namer, static_cast<Surface&>(trapeze));
            break;
        case LoadType::trapeze:
            fields(namer, trapeze, intensities);
            break;
        case LoadType::span:
            fields(namer, span);
            break;
        case LoadType::end_of_scene:
            namer.type(type);
            break;
    }
    return namer.all;
}

}  // namespace raycell
