#include "scenes/emitters.hpp"

#include <algorithm>
#include <numeric>

namespace raycell {
namespace {

constexpr double before_face = 1.0 / 16;  ///< cells

double brightest(const dvec3& c) { return std::max({c.x, c.y, c.z}); }

double area_of(const LightSource& source) {
    const double whole = glm::length(glm::cross(source.edge_u, source.edge_v));
    return source.kind == SourceKind::triangle ? whole / 2 : whole;
}

bool is_convex(const std::vector<dvec3>& v) {
    dvec3 normal(0);
    for (std::size_t i = 1; i + 1 < v.size(); ++i) normal += glm::cross(v[i] - v[0], v[i + 1] - v[0]);
    const double slack = -1e-6 * glm::dot(normal, normal);
    for (std::size_t i = 0; i < v.size(); ++i) {
        const dvec3& a = v[i];
        const dvec3& b = v[(i + 1) % v.size()];
        const dvec3& c = v[(i + 2) % v.size()];
        if (glm::dot(glm::cross(b - a, c - b), normal) < slack) return false;
    }
    return true;
}

/// The colour is what the material emits.
void add_faces(std::vector<LightSource>& faces, const std::vector<dvec3>& v, const dvec3& emission) {
    LightSource face;
    face.colour = emission;
    face.position = v[0];
    face.before = before_face;
    const auto add = [&](SourceKind kind, const dvec3& u, const dvec3& w) {
        face.kind = kind;
        face.edge_u = u - v[0];
        face.edge_v = w - v[0];
        if (area_of(face) > 0) faces.push_back(face);
    };
    if (v.size() == 4 && glm::length(v[0] - v[1] + v[2] - v[3]) <=
                             1e-5 * (glm::length(v[2] - v[0]) + glm::length(v[3] - v[1])))
        return add(SourceKind::rectangle, v[1], v[3]);
    for (std::size_t i = 1; i + 1 < v.size(); ++i) add(SourceKind::triangle, v[i], v[i + 1]);
}

/// The most powerful ones, in their order.
void keep_most_powerful(std::vector<LightSource>& faces, const std::string& file, Diagnostics& diagnostics) {
    const auto power = [](const LightSource& face) { return brightest(*face.colour) * area_of(face); };
    if (faces.size() <= max_sources) return;
    std::vector<std::size_t> order(faces.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return power(faces[a]) > power(faces[b]); });
    order.resize(max_sources);
    std::sort(order.begin(), order.end());
    std::vector<LightSource> kept;
    for (const std::size_t i : order) kept.push_back(faces[i]);
    diagnostics.warn(file, 0, "many emitting faces",
                     std::to_string(faces.size()) + " faces and triangles emit light; the " +
                         std::to_string(max_sources) + " most powerful are sources");
    faces = std::move(kept);
}

}  // namespace

void add_emitters(Scene& scene, Diagnostics& diagnostics) {
    std::vector<LightSource> faces;
    for (const Primitive& primitive : scene.primitives) {
        const dvec3& emission = scene.materials[primitive.material].emission;
        const auto* polygon = std::get_if<PolygonPrimitive>(&primitive.shape);
        if (!polygon || emission == dvec3(0)) continue;
        if (is_convex(polygon->vertices)) {
            add_faces(faces, polygon->vertices, emission);
        } else {
            diagnostics.warn(scene.name, 0, "concave emitting face",
                             "a concave face emits light (Ke); it is no source", 1);
        }
    }
    if (faces.empty()) return;
    keep_most_powerful(faces, scene.name, diagnostics);
    double power = 0;
    for (const LightSource& face : faces) power += brightest(*face.colour) * area_of(face);
    for (LightSource& face : faces) face.colour = *face.colour * (area_of(face) / power);
    diagnostics.note(scene.name, "lit by " + std::to_string(faces.size()) + " of its own faces (Ke)");
    scene.sources.insert(scene.sources.end(), faces.begin(), faces.end());
}

}  // namespace raycell
