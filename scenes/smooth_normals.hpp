// Normals of smoothing groups.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "model/geometry/scene.hpp"

namespace raycell {

/// Vertex normals for faces that have none but are to look smooth: at each vertex, the mean of the normals of
/// the group's faces there, each weighted by its angle at the vertex, so that it does not matter how a face
/// is cut into triangles.
class SmoothNormals {
  public:
    /// Counts a face in. `indices` name its vertices, `vertices` are their places.
    void add(std::uint32_t group, const std::vector<std::uint32_t>& indices,
             const std::vector<dvec3>& vertices);

    /// Normals of a face that was added, after all were; not of unit length, 0 where the faces cancel out.
    /// Empty where all of them are the face's own, as in a group that lies in one plane.
    std::vector<dvec3> of(std::uint32_t group, const std::vector<std::uint32_t>& indices,
                          const std::vector<dvec3>& vertices) const;

  private:
    std::unordered_map<std::uint64_t, dvec3> sums_;  ///< by group and vertex
};

}  // namespace raycell
