#include "model/truth/clip.hpp"

#include <algorithm>

namespace raycell {

CellScene clip_scene(const CellScene& scene) {
    CellScene clipped = scene;
    clipped.beyond = {};
    const Box cube = scene.frame.cube();
    clipped.within = cube;
    std::vector<Polygon>& polygons = clipped.polygons;
    for (Polygon& polygon : polygons) polygon.vertices = clip_to_box(std::move(polygon.vertices), cube);
    polygons.erase(
        std::remove_if(polygons.begin(), polygons.end(), [](const Polygon& p) { return p.vertices.empty(); }),
        polygons.end());
    return clipped;
}

}  // namespace raycell
