// Normals of smoothing groups.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "model/geometry/scene.hpp"

namespace raycell {

/// Vertex normals for the faces of smoothing groups that have none. The normal at a vertex is the mean of the
/// normals of the group's faces there, each weighted by its angle at the vertex, so that it does not matter
/// how a face is cut into triangles.
class SmoothNormals {
  public:
    /// Adds a face. `indices` name its vertices, `vertices` are their positions.
    void add(std::uint32_t group, const std::vector<std::uint32_t>& indices,
             const std::vector<dvec3>& vertices);

    /// The unit normals at the vertices of a face; 0 where the faces cancel out. To be called when all faces
    /// have been added. Empty if all are the face's own normal, as in a group that lies in one plane.
    std::vector<dvec3> of(std::uint32_t group, const std::vector<std::uint32_t>& indices,
                          const std::vector<dvec3>& vertices) const;

  private:
    std::unordered_map<std::uint64_t, dvec3> sums_;  ///< by group and vertex
};

}  // namespace raycell
