#include "model/machine/untimed.hpp"

#include <cstdlib>
#include <stdexcept>

#include "model/tracing/pixel_sum.hpp"
#include "model/tracing/traffic.hpp"

namespace raycell {

void count_ray(RayCounts& counts, RayKind kind) {
    switch (kind) {
        case RayKind::primary:
            ++counts.primary;
            break;
        case RayKind::reflected:
            ++counts.reflected;
            break;
        case RayKind::refracted:
            ++counts.refracted;
            break;
        case RayKind::shadow:
        case RayKind::memo:
            ++counts.shadow;
            break;
        case RayKind::precast:
            ++counts.precast;
            break;
    }
}

UntimedMachine::UntimedMachine(const CellScene& scene, const PictureSettings& settings,
                               const ExteriorTracer* exterior, const SyntheticTraffic* traffic)
    : settings_(settings),
      context_(scene, settings_, traffic),
      exterior_(exterior),
      cells_(load_array(scene, settings_, context_.arithmetic, &loaded_)) {
    if (settings.exterior == ExteriorMode::host && settings.stage == RunStage::trace && !exterior) {
        throw std::invalid_argument("exterior 'host' needs a tracer for what lies outside the cube");
    }
    if (!traffic) return;
    for (int y = 0; y < scene.frame.height; ++y) {
        for (int x = 0; x < scene.frame.width; ++x) {
            SyntheticTraffic::furnish(cell({x, y}), scene.frame, x, y);
        }
    }
}

StorageCounts UntimedMachine::storage() const {
    const VoxelBits each = voxel_bits(settings_, context_.arithmetic.formats(), context_.lights.rays.size());
    StorageCounts counts;
    for (const CellStore& cell : cells_) counts.add(cell, each);
    return counts;
}

bool UntimedMachine::in_array(Place at) const {
    const Frame& frame = context_.scene.frame;
    return at.x >= 0 && at.x < frame.width && at.y >= 0 && at.y < frame.height;
}

void UntimedMachine::count_return(const Ray& ray, Place from, Pixel* pixel) {
    const unsigned hops = unsigned(std::abs(from.x - ray.home_x) + std::abs(from.y - ray.home_y));
    rays_.return_hops += hops;
    if (pixel) pixel->hops += hops;
}

Picture UntimedMachine::render(const std::function<void(int)>& progress) {
    const Frame& frame = context_.scene.frame;
    Picture picture(frame.picture_width(), frame.picture_height());
    const bool trace_rays = context_.settings.stage == RunStage::trace;
    if (trace_rays && context_.settings.shadows == Shadows::precast) precast();
    precast_hops_ = rays_.ray_hops + rays_.return_hops;
    for (int row = 0; row < picture.height; ++row) {
        for (int column = 0; column < picture.width; ++column) {
            const int x = column / frame.block_width;
            const int y = row / frame.block_height;
            const int number = row % frame.block_height * frame.block_width + column % frame.block_width;
            Pixel& pixel = picture.at(column, row);
            if (!trace_rays) {
                pixel = display_cell(context_, cell({x, y}), x, y, number);
                continue;
            }
            trace_pixel(pixel, x, y, number);
        }
        if (progress) progress(row);
    }
    return picture;
}

/// Fills a pixel of cell (x, y)'s block with the mean of its samples.
void UntimedMachine::trace_pixel(Pixel& pixel, int x, int y, int number) {
    record_background(pixel);
    const auto sample = [&](int k) {
        const Ray ray = primary_ray(context_, x, y, number * settings_.samples + k);
        count_ray(rays_, ray.kind);
        return trace(ray, x, y, &pixel).colour;
    };
    if (settings_.samples == 1) {
        pixel.colour = sample(0);
        return;
    }
    PixelSum sum;
    do {
        sum.add(sample(sum.count()), context_.arithmetic);
    } while (!is_complete(sum, settings_, context_.arithmetic));
    pixel.colour = sum.mean(context_.arithmetic);
    pixel.samples = std::uint32_t(sum.count());
}

void UntimedMachine::precast() {
    const Frame& frame = context_.scene.frame;
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            CellStore& store = cell({x, y});
            for (std::uint32_t v = 0; v < store.voxels.size(); ++v) {
                for (std::size_t s = 0; s < context_.lights.rays.size(); ++s) {
                    const Ray ray = voxel_shadow_ray(context_, store, v, s, RayKind::precast, x, y);
                    count_ray(rays_, ray.kind);
                    if (trace(ray, x, y, nullptr).blocked) store.lit[v] &= ~(std::uint64_t(1) << s);
                }
            }
        }
    }
}

UntimedMachine::Answer UntimedMachine::trace(Ray ray, int x, int y, Pixel* pixel) {
    Place at{x, y};
    for (;;) {
        const Visit visit = visit_cell(cell(at), ray, context_);
        rays_.ties += visit.event == Visit::Event::hit && visit.hit.tied;
        switch (visit.event) {
            case Visit::Event::hit:
                return answer_hit(ray, visit.hit, at, pixel);
            case Visit::Event::reaches_source:
                if (ray.kind != RayKind::precast) count_return(ray, at, pixel);
                return {};
            case Visit::Event::leaves_cube: {
                const Face face = face_of_depth(ray);
                if (beyond_face(context_, face) == Beyond::nothing) return leave(ray, face, {}, at, pixel);
                start_outside(ray, visit.hit.t, context_.arithmetic);
                continue;  // now this cell only passes it on
            }
            case Visit::Event::forward:
                break;
        }
        const Place next{at.x + step_x(visit.crossing.side), at.y + step_y(visit.crossing.side)};
        if (!in_array(next)) {
            const Face face = ray.outside ? face_of_depth(ray) : face_of(visit.crossing.side);
            return leave(ray, face, visit.crossing, at, pixel);
        }
        cross(ray, visit.crossing, context_.arithmetic);
        at = next;
        ++rays_.ray_hops;
        if (pixel) ++pixel->hops;
    }
}

UntimedMachine::Answer UntimedMachine::leave(const Ray& ray, Face face, const Crossing& crossing, Place at,
                                             Pixel* pixel) {
    Answer answer;
    if (beyond_face(context_, face) == Beyond::nothing) {
        ++rays_.lost;
        answer.colour = context_.background;
    } else {
        ++rays_.exterior;
        const ExteriorRequest request = exterior_request(context_, ray, crossing, at.x, at.y);
        if (is_shadow(ray.kind)) {
            answer.blocked = exterior_->blocked(request, ray);
        } else {
            answer.colour = exterior_answer(context_, exterior_->radiance(request, ray, pixel));
        }
        // One hop to the exterior over the border link, and one back if there is an answer.
        const unsigned hops = ray.kind == RayKind::precast && !answer.blocked ? 1 : 2;
        rays_.return_hops += hops;
        if (pixel) pixel->hops += hops;
    }
    if (ray.kind != RayKind::precast || answer.blocked) count_return(ray, at, pixel);
    return answer;
}

bool UntimedMachine::source_visible(const Ray& ray, const CellHit& hit, const HitSetup& setup,
                                    std::size_t source, Place at, Pixel* pixel) {
    CellStore& store = cell(at);
    const std::uint64_t bit = std::uint64_t(1) << source;
    if (context_.settings.shadows == Shadows::per_hit) {
        const Ray child = shadow_ray(context_, store, ray, hit, setup, source, at.x, at.y);
        count_ray(rays_, child.kind);
        return !trace(child, at.x, at.y, pixel).blocked;
    }
    if (context_.settings.shadows == Shadows::memo && !(store.known[hit.voxel] & bit)) {
        const Ray child = voxel_shadow_ray(context_, store, hit.voxel, source, RayKind::memo, at.x, at.y);
        count_ray(rays_, child.kind);
        if (trace(child, at.x, at.y, pixel).blocked) store.lit[hit.voxel] &= ~bit;
        store.known[hit.voxel] |= bit;
    }
    return store.lit[hit.voxel] & bit;
}

UntimedMachine::Answer UntimedMachine::answer_hit(const Ray& ray, const CellHit& hit, Place at,
                                                  Pixel* pixel) {
    Answer answer;
    count_return(ray, at, pixel);
    if (is_shadow(ray.kind)) {
        answer.blocked = true;
        return answer;
    }
    CellStore& store = cell(at);
    const Voxel& voxel = store.voxels[hit.voxel];
    const HitSetup setup = set_up_hit(context_, store, ray, hit, at.x, at.y);
    if (shows_first_hit(ray)) record_first_hit(*pixel, setup, voxel.polygon);
    std::uint64_t lit = 0;
    for (std::size_t s = 0; s < context_.lights.rays.size(); ++s) {
        const std::uint64_t bit = std::uint64_t(1) << s;
        if ((setup.facing & bit) && source_visible(ray, hit, setup, s, at, pixel)) lit |= bit;
    }
    dvec3 reflected{0, 0, 0};
    dvec3 refracted{0, 0, 0};
    const auto follow = [&](const Ray& child) {
        count_ray(rays_, child.kind);
        return trace(child, at.x, at.y, pixel).colour;
    };
    if (setup.reflects) {
        reflected = follow(reflected_ray(context_, store, ray, hit, setup, at.x, at.y));
    }
    if (setup.refracts) {
        refracted = follow(refracted_ray(context_, store, ray, hit, setup, at.x, at.y));
    }
    answer.colour = shade_hit(context_, setup, voxel.object, lit, reflected, refracted);
    return answer;
}

}  // namespace raycell
