// The scene as the user wrote it: world coordinates, no array yet. Filled by the readers in scenes/.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace raycell {

using glm::dvec2;
using glm::dvec3;

/// An object's features as the machine loads them (paper, section 3.1): everything shading needs.
struct Material {
    dvec3 colour{0.7, 0.7, 0.7};  ///< C, each channel 0..1 (larger values are kept)
    double diffuse = 0.8;         ///< Kd, share of diffuse light
    double specular = 0.0;        ///< Ks, share of the highlight, and of the mirrored ray where `mirror`
    double shine = 1.0;           ///< Phong power, >= 0
    double transmit = 0.0;        ///< T, share of the refracted ray, 0..1
    double ior = 1.0;             ///< index of refraction, > 0 wherever transmit > 0
    bool mirror = true;           ///< false: Ks makes a highlight only (OBJ materials without reflection)
    dvec3 emission{0, 0, 0};      ///< makes sources of its faces (scenes/emitters.hpp); no cell has it
};

constexpr std::size_t max_sources = 64;  ///< one bit each in a 64-bit verdict word

enum class SourceKind : std::uint8_t {
    point,
    directional,  ///< infinitely far away: everywhere the same direction
    spot,         ///< a point that shines into a cone
    rectangle,    ///< or any parallelogram: its front shines, by Lambert's law
    triangle,     ///< the same
    sphere        ///< as bright from everywhere
};
constexpr int source_kinds = 6;
/// Whether it has an extent: then it is as many points as there are samples.
constexpr bool is_area(SourceKind kind) { return kind >= SourceKind::rectangle; }
/// As files and records name it.
constexpr const char* name_of(SourceKind kind) {
    constexpr const char* names[] = {"point", "directional", "spot", "rectangle", "triangle", "sphere"};
    return names[int(kind)];
}

/// A light source without attenuation.
struct LightSource {
    dvec3 position{0, 0, 0};  ///< not of directional ones; of a rectangle or triangle a corner, of a sphere
                              ///< the middle
    std::optional<dvec3> colour;  ///< absent: 1/sqrt(n) in each channel, n sources in the scene
    SourceKind kind = SourceKind::point;
    dvec3 direction{0, 0, 0};  ///< directional, spot: where its light goes, any length but 0
    double angle = 90;         ///< spot: of its cone, from the axis to the edge, degrees, 0 < angle <= 90
    double falloff = 1;        ///< spot: power of the cosine to the axis, >= 0
    dvec3 edge_u{0, 0, 0};     ///< rectangle, triangle: from the corner to a neighbour
    dvec3 edge_v{0, 0, 0};     ///< to the other one; its front is where u x v points to
    double radius = 0;         ///< sphere: > 0
    double before = 0;         ///< rectangle, triangle: so far before its own face, cells, so that it lights
};

/// The viewer of an NFF `v` entity.
struct View {
    dvec3 from{0, 0, 1};
    dvec3 at{0, 0, 0};
    dvec3 up{0, 1, 0};  ///< not parallel to at - from; need not be unit or perpendicular
    double angle = 45;  ///< degrees, centre of the first to centre of the last pixel row, 0 < angle < 180
    double hither = 0;  ///< world units, >= 0; nothing nearer along the axis is seen directly
    int width = 512;    ///< resolution asked for by the file; the array's size decides
    int height = 512;
};

/// r < 0 in the file becomes inward = true: the normals point inwards (surfaces stay two-sided).
struct SpherePrimitive {
    dvec3 centre{0, 0, 0};
    double radius = 1;  ///< > 0
    bool inward = false;
};

/// Cone or cylinder without caps.
struct ConePrimitive {
    dvec3 base{0, 0, 0};
    double base_radius = 1;  ///< >= 0, not both 0
    dvec3 apex{0, 0, 1};     ///< differs from base
    double apex_radius = 0;  ///< >= 0
    bool inward = false;
};

/// A planar polygon, possibly concave, counter-clockwise seen from its front.
struct PolygonPrimitive {
    std::vector<dvec3> vertices;  ///< at least 3, finite, not all on one line
    std::vector<dvec3> normals;   ///< empty (flat) or one unit normal per vertex, on the front side
};

struct Primitive {
    std::uint32_t material = 0;  ///< index into Scene::materials
    std::variant<PolygonPrimitive, SpherePrimitive, ConePrimitive> shape;
};

struct Scene {
    std::string name;                    ///< for messages: the file's name
    std::vector<std::string> libraries;  ///< material files that were read as well
    dvec3 background{0, 0, 0};
    std::optional<View> view;
    std::vector<LightSource> sources;
    std::vector<Material> materials;
    std::vector<Primitive> primitives;
};

}  // namespace raycell
