#include "cells/passing.hpp"

#include <algorithm>

namespace raycell {

RayPacket* launch(const Ray& ray, Environment& environment) {
    const Cycle now = environment.scheduler.now();
    RayPacket* packet = environment.pools.rays.take();
    packet->ray = ray;
    packet->launched = now;
    packet->wait = {now, Stall::traversal};
    ++environment.meters.counters.rays_sent;
    return packet;
}

Answer response_of(const RayPacket& packet, const Context& context) {
    Answer answer = answer_to(packet.ray, packet.need.answer);
    if (packet.need.lost) answer.colour = context.background;
    return answer;
}

void end_ray(RayPacket& packet, Environment& environment, CellMeter& meter) {
    Counters& counters = environment.meters.counters;
    if (packet.need.kind == Need::Kind::nothing) {
        meter.ended_silently(counters, environment.scheduler.now());
    } else {
        ++counters.rays_answered;
    }
    counters.rays.lost += packet.need.lost;
    environment.pools.rays.give_back(&packet);
}

Cycle start_of_primaries(const Environment& environment, int x, int y) {
    const std::uint64_t first = environment.context.scene.frame.pixel_index(x, y, 0);
    return environment.phase_start + 1 + Retry::first_start(environment.machine, ray_id(first, 0));
}

void begin_tracing(Injector& injector, const Environment& environment, int pixel, int last, Cycle start) {
    const PictureSettings& settings = environment.settings;
    injector.begin_phase(pixel * settings.samples, last * settings.samples, start);
    if (may_stop_early(settings))
        injector.go_on(pixel * settings.samples, pixel * settings.samples + first_samples);
}

Ray begin_primary(unsigned number, Injector& injector, Environment& environment, int x, int y) {
    const Cycle made = environment.scheduler.now() + Cycle(environment.primary_cycles);
    const bool first = injector.primary_sent(number, made);
    Ray ray = primary_ray(environment.context, x, y, injector.sample(number));
    ray.slot = number;
    if (first) {
        ++environment.meters.counters.rays.primary;
        if (sample_of_id(ray.id) == 0) {
            record_background(environment.picture.pixels[pixel_of(ray.id)]);
            if (!environment.sums.empty()) environment.sums[pixel_of(ray.id)] = PixelSum();
        }
    }
    return ray;
}

namespace {

/// Adds a sample to its pixel. True if the pixel is complete.
bool add_sample(Pixel& pixel, PixelSum& sum, const dvec3& intensity, int number, Injector& injector,
                const Context& context) {
    const PictureSettings& settings = context.settings;
    sum.add(intensity, context.arithmetic);
    const bool complete = is_complete(sum, settings, context.arithmetic);
    if (may_stop_early(settings) && sum.count() == first_samples) {
        const int next = (number / settings.samples + 1) * settings.samples;  // the next pixel's first
        injector.go_on(complete ? next : next - settings.samples + first_samples, next + first_samples);
    }
    if (!complete) return false;
    pixel.colour = sum.mean(context.arithmetic);
    pixel.samples = std::uint32_t(sum.count());
    return true;
}

}  // namespace

void end_primary(const Answer& answer, Injector& injector, Environment& environment, int x, int y) {
    const Cycle now = environment.scheduler.now();
    if (answer.kind == Answer::Kind::postponed) {
        injector.primary_postponed(answer.slot, environment.machine, answer.id, now);
        return;
    }
    const Context& context = environment.context;
    const int number = injector.sample(answer.slot);
    const std::size_t at = context.scene.frame.pixel_index(x, y, number / context.settings.samples);
    Pixel& pixel = environment.picture.pixels[at];
    injector.primary_answered(answer.slot);
    if (environment.sums.empty()) {
        pixel.colour = answer.colour;
    } else if (!add_sample(pixel, environment.sums[at], answer.colour, number, injector, context)) {
        return;
    }
    pixel.cycle = std::uint32_t(now - environment.phase_start);
    ++environment.meters.counters.pixels_done;
}

void send_load(LinkOut& out, LoadItem& item, Environment& environment) {
    const int bits = environment.load_bits(item);
    environment.over_wire(item, bits);
    out.send(0, Message(&item), environment.cycles_for(bits));
}

void send_feed(LinkOut& out, LoadItem& item, Environment& environment) {
    const int bits = environment.load_bits(item);
    environment.over_wire(item, bits);
    out.send(0, Message(&item), environment.feed_cycles(bits));
}

namespace {

/// Counts a cell's spans kept, and the bits of its memory of voxels: voxels that are made, and spans that
/// wait. Those at work stand in registers, one for each unit. Each span kept is taken to make a voxel: the
/// last ones stored.
void count_kept(Environment& environment, const CellStore& store, int kept, int units) {
    Counters& all = environment.meters.counters;
    all.most_kept = std::max(all.most_kept, std::uint64_t(kept));
    const std::size_t made = store.voxels.size() - std::min(store.voxels.size(), std::size_t(kept));
    const std::uint64_t edges =
        made < store.voxels.size() ? store.voxels[made].first_edge : store.edges.size();
    const std::uint64_t bits =
        made * std::uint64_t(environment.voxel_bits.base) +
        edges * std::uint64_t(environment.voxel_bits.per_edge) +
        std::uint64_t(std::max(kept - units, 0)) * std::uint64_t(environment.kept_span_bits);
    all.most_load_bits = std::max(all.most_load_bits, bits);
}

}  // namespace

void keep_span(LoadingUnits& unit, std::uint32_t lines, const CellStore& store, Environment& environment,
               CellMeter& meter) {
    const Cycle now = environment.scheduler.now();
    const Cycle making = environment.costs().load_voxel(environment.context.settings.hit);
    unit.keep(making, lines * environment.costs().load_order, now);
    meter.kept(making);
    count_kept(environment, store, unit.kept(making, now), unit.count());
    environment.scheduler.sample_at(unit.made(), unit.made());
}

std::optional<LoadItem::Kind> pass_load(LoadingUnits& unit, LinkIn& from, LinkOut* east, CellStore& store,
                                        Environment& environment, CellMeter& meter, int x, Wakeup& wakeup) {
    const Cycle now = environment.scheduler.now();
    if (unit.closes(now, wakeup)) meter.loaded(environment.meters.counters, now);
    LoadItem* item = unit.work(from, x, environment.costs(), now, wakeup);
    if (!item) return std::nullopt;
    const LoadItem::Kind kind = item->kind;
    const bool makes = LoadingUnits::makes_voxel(*item, x);
    const Cycle making = environment.costs().load_voxel(environment.context.settings.hit);
    if (makes && !unit.has_room(environment.machine.load_queue, making, now, wakeup)) return std::nullopt;
    // Asked before take(), which advances a span to the next column.
    const bool ends = LoadingUnits::ends_at(*item, x, environment.width());
    if (!ends && !east->can_send(0, wakeup.next)) return std::nullopt;
    meter.load_passed(environment.meters.counters, ends);
    const std::uint32_t lines = LoadingUnits::take(*item, x, store, environment.context);
    from.pop(0);
    unit.finish();
    if (makes) {
        keep_span(unit, lines, store, environment, meter);
    } else if (kind == LoadItem::Kind::end_of_scene) {
        unit.close();
        if (unit.closes(now, wakeup)) meter.loaded(environment.meters.counters, now);
    }
    if (ends) {
        environment.pools.loads.give_back(item);
    } else {
        send_load(*east, *item, environment);
    }
    if (from.front(0).kind != Message::Kind::none) wakeup.at(now + 1);
    return kind;
}

}  // namespace raycell
