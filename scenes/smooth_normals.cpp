#include "scenes/smooth_normals.hpp"

#include <algorithm>
#include <cmath>

namespace raycell {

namespace {

std::uint64_t key_of(std::uint32_t group, std::uint32_t vertex) {
    return std::uint64_t(group) << 32 | vertex;
}

/// The unit vector, or 0 for a vector without direction; tiny and huge vectors keep theirs.
dvec3 direction(const dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0 ? glm::normalize(v / largest) : dvec3(0);
}

dvec3 face_normal(const std::vector<dvec3>& vertices) {
    double size = 0;
    for (const dvec3& v : vertices) {
        const dvec3 extent = glm::abs(v - vertices[0]);
        size = std::max({size, extent.x, extent.y, extent.z});
    }
    if (!(size > 1e-100)) return dvec3(0);
    dvec3 area{0, 0, 0};
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        area += glm::cross((vertices[i] - vertices[0]) / size, (vertices[i + 1] - vertices[0]) / size);
    }
    return direction(area);
}

}  // namespace

void SmoothNormals::add(std::uint32_t group, const std::vector<std::uint32_t>& indices,
                        const std::vector<dvec3>& vertices) {
    const dvec3 normal = face_normal(vertices);
    const std::size_t n = vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
        const dvec3 before = direction(vertices[(i + n - 1) % n] - vertices[i]);
        const dvec3 after = direction(vertices[(i + 1) % n] - vertices[i]);
        if (before == dvec3(0) || after == dvec3(0)) continue;  // a repeated vertex
        double angle = std::acos(std::clamp(glm::dot(before, after), -1.0, 1.0));
        if (glm::dot(glm::cross(after, before), normal) < 0) angle = 2 * std::acos(-1.0) - angle;
        sums_[key_of(group, indices[i])] += angle * normal;
    }
}

std::vector<dvec3> SmoothNormals::of(std::uint32_t group, const std::vector<std::uint32_t>& indices,
                                     const std::vector<dvec3>& vertices) const {
    const dvec3 normal = face_normal(vertices);
    std::vector<dvec3> normals;
    bool flat = true;
    for (const std::uint32_t index : indices) {
        const auto sum = sums_.find(key_of(group, index));
        normals.push_back(sum == sums_.end() ? dvec3(0) : direction(sum->second));
        flat = flat && glm::dot(normals.back(), normal) > 1 - 1e-12;
    }
    if (flat) normals.clear();
    return normals;
}

}  // namespace raycell
