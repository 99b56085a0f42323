// The part of a polygon that lies over a box: what a row, or a cell, finds out from a plane and edges.
#pragma once

#include "model/loading/trapeze.hpp"

namespace raycell {

/// A convex part of a polygon: the area inside its edges and a box.
struct Part {
    dvec3 low{0, 0, 0};     ///< bounds of its corners, cells
    dvec3 high{0, 0, 0};    ///< the same
    dvec3 middle{0, 0, 0};  ///< mean of its corners, on the plane; inside the part
    double area = 0;        ///< in the projection of the plane, square cells
    int corners = 0;        ///< 3 to 10; 0: there is no such part
    bool empty() const { return corners == 0; }
};

/// What encloses a part: a plane, and edges in the projection that drops the plane's axis `drop`.
struct PartBounds {
    const Plane& plane;
    int drop;
    const EdgeFunction* edges;
    int edge_count;
};

/// The part inside the edges and the box; z has no bounds where it is dropped. Edges
/// count with a tolerance of a last bit of a word in a cell (exact arithmetic: exact_hair), so that a part is
/// never smaller than the polygon there. In fixed arithmetic everything is a loading word: sums are cut off
/// (towards minus infinity), and so are the quotients that tell where an edge cuts a side.
Part part_in(const PartBounds& bounds, const Box& box, const Arithmetic& arithmetic);

}  // namespace raycell
