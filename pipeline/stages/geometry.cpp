#include "pipeline/stages/geometry.hpp"

#include "model/loading/loading.hpp"

namespace raycell {

bool Geometry::find_polygon() {
    const Environment& env = environment();
    const std::vector<Polygon>& polygons = env.context.scene.polygons;
    const Cycle skip = env.costs().geometry_skip;
    const bool all_rows = rows_.first == 0 && rows_.last + 1 == env.height();
    const auto here = [&](std::size_t i) {
        return all_rows || may_touch_rows(polygons[i], rows_, env.context.arithmetic);
    };
    for (; polygon_ < polygons.size(); ++polygon_) {
        if (polygon_ >= looked_up_to_) {  // an object that none of its polygons brings here is one look
            std::size_t end = polygon_;
            bool any = false;
            for (; end < polygons.size() && polygons[end].object == polygons[polygon_].object; ++end)
                any = any || here(end);
            looked_up_to_ = end;
            if (!any) {
                work_ += skip;
                polygon_ = end - 1;
                continue;
            }
        }
        if (here(polygon_)) return true;
        work_ += skip;
    }
    return false;
}

LoadItem* Geometry::next_item() {
    Environment& env = environment();
    const CellScene& scene = env.context.scene;
    const auto make = [&](LoadItem::Kind kind) {
        LoadItem* item = env.pools.loads.take();
        item->kind = kind;
        return item;
    };
    work_ = 1;
    if (!setup_sent_) {
        setup_sent_ = true;
        return make(LoadItem::Kind::setup);
    }
    while (find_polygon()) {
        const Polygon& next = scene.polygons[polygon_];
        Polygon polygon = next;
        if (!clip_to_cube(polygon, scene.frame.cube(), environment().context.arithmetic)) {
            ++polygon_;
            work_ += env.costs().geometry_polygon;  // finding that it lies outside costs the same
            continue;
        }
        if (std::int64_t(next.object) != object_) {
            object_ = next.object;
            LoadItem* item = make(LoadItem::Kind::features);
            item->object = next.object;
            return item;
        }
        ++polygon_;
        work_ += env.costs().geometry_polygon;
        ++statistics_.items;
        LoadItem* item = make(LoadItem::Kind::polygon);
        item->polygon = std::move(polygon);
        return item;
    }
    if (end_sent_) return nullptr;
    end_sent_ = true;
    return make(LoadItem::Kind::end_of_scene);
}

Cycle Geometry::step(Cycle now) {
    Environment& env = environment();
    if (!item_) {
        item_ = next_item();
        if (!item_) return never;
        ready_ = now + work_;
        work(now, work_);
    }
    if (now < ready_) return ready_;
    Cycle retry = never;
    if (!out->can_send(0, retry)) return retry;
    send_feed(*out.operator->(), *item_, env);
    item_ = nullptr;
    return now + 1;
}

}  // namespace raycell
