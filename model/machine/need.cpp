#include "model/machine/need.hpp"

namespace raycell {
namespace {

Need ends_in(const Ray& ray, Answer::Kind answer) {
    const bool silent = ray.kind == RayKind::precast && answer == Answer::Kind::lit;  // silence means lit
    Need need;
    need.kind = silent ? Need::Kind::nothing : Need::Kind::response;
    need.answer = answer;
    return need;
}

Need ends_beyond(const Ray& ray) {
    Need need = ends_in(ray, is_shadow(ray.kind) ? Answer::Kind::lit : Answer::Kind::intensity);
    need.lost = true;
    return need;
}

Need goes_on(const Ray& ray, Side side, int x, int y, const BufferClasses& classes, const Context& context) {
    const Frame& frame = context.scene.frame;
    const int to_x = x + step_x(side);
    const int to_y = y + step_y(side);
    Need need;
    need.leaves = to_x < 0 || to_x >= frame.width || to_y < 0 || to_y >= frame.height;
    if (need.leaves) {
        const Face face = ray.outside ? face_of_depth(ray) : face_of(side);
        if (beyond_face(context, face) == Beyond::nothing) return ends_beyond(ray);
    }
    need.kind = Need::Kind::output;
    need.side = side;
    need.index = std::uint8_t(classes.ray(ray));
    return need;
}

}  // namespace

Need need_of(const Ray& ray, const Visit& visit, const CellStore& store, int x, int y,
             const BufferClasses& classes, const Context& context) {
    Need need;
    switch (visit.event) {
        case Visit::Event::forward:
            return goes_on(ray, visit.crossing.side, x, y, classes, context);
        case Visit::Event::reaches_source:
            return ends_in(ray, Answer::Kind::lit);
        case Visit::Event::leaves_cube:
            if (beyond_face(context, face_of_depth(ray)) == Beyond::nothing) return ends_beyond(ray);
            need.kind = Need::Kind::border_walk;
            break;
        case Visit::Event::hit:
            if (is_shadow(ray.kind)) return ends_in(ray, Answer::Kind::blocked);
            need.kind = may_wait(context, ray, store.voxels[visit.hit.voxel].object)
                            ? Need::Kind::slot
                            : Need::Kind::shading_unit;
            break;
    }
    return need;
}

}  // namespace raycell
