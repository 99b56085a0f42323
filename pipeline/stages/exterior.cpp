#include "pipeline/stages/exterior.hpp"

#include <algorithm>

namespace raycell {
namespace {

/// Calls `join_cell` for every side of a cell at the array's border, in the order of the ports.
template <typename F>
void for_border(const Environment& env, const F& join_cell) {
    for (int y = 0; y < env.height(); ++y) {
        join_cell(0, y, Side::west);
        join_cell(env.width() - 1, y, Side::east);
    }
    for (int x = 0; x < env.width(); ++x) {
        join_cell(x, 0, Side::north);
        join_cell(x, env.height() - 1, Side::south);
    }
}

std::string name_border(int x, int y, const char* way) {
    return "border_" + std::to_string(x) + "_" + std::to_string(y) + way;
}

}  // namespace

Exterior::Exterior(sc_core::sc_module_name name, Environment& environment, const ExteriorTracer& tracer)
    : Stage(name, environment), tracer_(tracer) {}

void Exterior::join(Array& array, RankExchange* ranks) {
    Environment& env = environment();
    for_border(env, [&](int x, int y, Side side) {
        SplitLinks* split = env.share.contains(y) ? nullptr : ranks->links_to(ranks->owner(y));
        const auto make = [&](const char* way) {
            links_.push_back(
                std::make_unique<Link>(env.scheduler, env.classes.count, env.machine.buffer_depth));
            links_.back()->set_name(name_border(x, y, way));
            return links_.back().get();
        };
        Link* out = make(".out");
        Link* in = make(".in");
        out->connect_sink(*this);
        out->report_arrivals(*this, std::uint32_t(ports_.size()));
        in->connect_source(*this);
        env.stall(*in, in->name());
        if (split) {
            split->add_sink(*out);
            split->add_source(*in);
        } else {
            env.stall(*out, out->name());
            out->connect_source(array.client(x, y));
            in->connect_sink(array.client(x, y));
            array.join_border(x, y, side, *in, *out);
        }
        ports_.push_back({x, y, out, in});
    });
}

void Exterior::join_remote(Array& array, Environment& env, RankExchange& ranks) {
    SplitLinks& split = *ranks.links_to(0);
    const int classes = env.classes.count;
    for_border(env, [&](int x, int y, Side side) {
        if (!env.share.contains(y)) return;
        Link& out = split.make_source(env.scheduler, classes, env.machine.buffer_depth);
        out.set_name(name_border(x, y, ".out"));
        env.stall(out, out.name());
        Link& in = split.make_sink(env.scheduler, classes, env.machine.buffer_depth);
        out.connect_source(array.client(x, y));
        in.connect_sink(array.client(x, y));
        array.join_border(x, y, side, in, out);
    });
}

void Exterior::arrives(std::uint32_t port, int index, Cycle visible) {
    waiting_.emplace(visible, port, index);
}

/// The idle processor with the lowest number.
std::uint32_t Exterior::take_idle() {
    if (idle_.empty()) {
        processors_.emplace_back();
        return std::uint32_t(processors_.size() - 1);
    }
    const std::uint32_t number = idle_.top();
    idle_.pop();
    return number;
}

void Exterior::begin(std::uint32_t number, std::uint32_t port, int index, Cycle now) {
    Environment& env = environment();
    Processor& processor = processors_[number];
    const BorderPort& border = ports_[port];
    RayPacket* packet = border.from_cell->front(index).ray;
    const Ray& ray = packet->ray;
    const ExteriorRequest request =
        exterior_request(env.context, ray, border_crossing(ray, env.context.arithmetic), border.x, border.y);
    processor = Processor();
    processor.busy = true;
    processor.port = port;
    processor.done = now + Cycle(env.machine.exterior_latency);
    if (is_shadow(ray.kind)) {
        const bool blocked = tracer_.blocked(request, ray);
        processor.answer = answer_to(ray, blocked ? Answer::Kind::blocked : Answer::Kind::lit);
        processor.silent = ray.kind == RayKind::precast && !blocked;
    } else {
        Pixel* pixel = shows_first_hit(ray) ? &env.picture.pixels[pixel_of(ray.id)] : nullptr;
        processor.answer = answer_to(ray, Answer::Kind::intensity);
        processor.answer.colour = exterior_answer(env.context, tracer_.radiance(request, ray, pixel));
    }
    border.from_cell->pop(index);
    env.pools.rays.give_back(packet);
    statistics_.busy_cycles += std::uint64_t(env.machine.exterior_latency);
    ++statistics_.items;
    ++working_;
    at_work_.push_back(number);
}

StageStatistics Exterior::statistics() const {
    StageStatistics so_far = statistics_;
    const Cycle now = environment().scheduler.now();
    for (const std::uint32_t number : at_work_) {
        const Cycle done = processors_[number].done;
        if (done > now) so_far.busy_cycles -= done - now;
    }
    return so_far;
}

/// Sends a processor's answer; false if it can't leave yet.
bool Exterior::answer(Processor& processor, Cycle now, Cycle& retry) {
    Environment& env = environment();
    if (processor.silent) {
        ++env.meters.counters.rays_silent;
        if (env.meters.observer) env.meters.observer->exterior_silent(now, processor.answer.id);
        env.meters.counters.last_progress = now;
        return true;
    }
    const BorderPort& port = ports_[processor.port];
    if (!port.to_cell->can_send(env.classes.answer, retry)) return false;
    const bool intensity = processor.answer.kind == Answer::Kind::intensity;
    if (env.meters.observer) env.meters.observer->exterior_answered(port.x, port.y, now, processor.answer);
    Answer* answer = env.pools.answers.take();
    *answer = processor.answer;
    env.over_wire(*answer);
    port.to_cell->send(env.classes.answer, Message(answer),
                       env.cycles_for(intensity ? env.bits.intensity : env.bits.verdict), env.answer_routing);
    ++env.meters.counters.rays_answered;
    ++env.meters.counters.answers_sent;
    ++env.meters.counters.rays.return_hops;
    env.count_hop(processor.answer.id);
    return true;
}

Cycle Exterior::step(Cycle now) {
    Cycle next = never;
    for (; !at_work_.empty() && processors_[at_work_.front()].done <= now; at_work_.pop_front())
        done_.insert(at_work_.front());
    for (auto number = done_.begin(); number != done_.end();) {
        Processor& processor = processors_[*number];
        if (!answer(processor, now, next)) {
            ++number;
            continue;
        }
        processor.busy = false;
        --working_;
        idle_.push(*number);
        number = done_.erase(number);
    }
    while (!waiting_.empty() && working_ < environment().machine.exterior_processors) {
        const auto [visible, port, index] = *waiting_.begin();
        if (visible > now) {
            next = std::min(next, visible);
            break;
        }
        waiting_.erase(waiting_.begin());
        begin(take_idle(), port, index, now);
    }
    return at_work_.empty() ? next : std::min(next, processors_[at_work_.front()].done);
}

}  // namespace raycell
