// A cell of one's own in a running array: a plain SystemC module that passes load messages, rays and answers
// on and sends its pixel's primary ray. It stands where no voxel lies, and the picture and the cycles are
// those of the array's own cells (testbench/tests/cells/own_cell_test.cpp).
#pragma once

#include <algorithm>

#include "cells/environment.hpp"
#include "cells/hosts/cell_socket.hpp"
#include "cells/units/injector.hpp"
#include "cells/units/loading_unit.hpp"
#include "cells/units/router.hpp"
#include "cells/units/traversal_unit.hpp"

namespace raycell {

class OwnCell : public CellSocket {
  public:
    SC_HAS_PROCESS(OwnCell);
    OwnCell(sc_core::sc_module_name name, Environment& environment, int x, int y)
        : CellSocket(name), env_(environment), x_(x), y_(y) {
        SC_METHOD(run);
        sensitive << woken();
        dont_initialize();
    }
    void begin_phase() override { injector_.begin_phase(env_.phase == Phase::trace); }

  private:
    struct Place {  ///< where a ray stands: an input's buffer, or at last the own ray's register
        int side;
        int index;
    };

    void end_of_elaboration() override {
        for (int side = 0; side < side_count; ++side) {
            for (int index = 0; index < env_.classes.count && in[side].size() > 0; ++index) {
                const bool answers_only = index == env_.classes.answer && env_.classes.count > 1;
                if (!answers_only && env_.classes.used(index, side % 2 == 0, opposite(Side(side))))
                    places_.push_back({side, index});
            }
        }
        places_.push_back({-1, 0});
    }

    /// One cycle, in the order of Cell::step().
    void run() {
        now_ = env_.scheduler.now();
        wakeup_ = Wakeup();
        if (env_.phase == Phase::load) {
            pass_load();
        } else {
            if (traversal_.packet()) traversal_.finish(now_, wakeup_);
            pass_answers();
            inject();
            pass_rays();
            if (!traversal_.packet()) test_ray();
        }
        if (wakeup_.next != never) env_.scheduler.wake(*this, wakeup_.next);
    }

    void pass_load() {
        LinkIn& from = load_in.size() > 0 ? *load_in[0] : *in[int(Side::west)][0];
        const Message head = from.front(0);
        if (head.kind != Message::Kind::load) return;
        LoadItem& item = *head.load;
        if (load_ != &item) {
            load_ = &item;
            const CostTable& costs = env_.costs();
            load_done_ = now_ + (LoadingUnit::makes_voxel(item, x_) ? costs.load_voxel : costs.load_forward);
        }
        if (now_ < load_done_) return wakeup_.at(load_done_);
        const bool last = LoadingUnit::ends_at(item, x_, env_.width());
        if (!last && !out[int(Side::east)]->can_send(0, wakeup_.next)) return;
        LoadingUnit::take(item, x_, store_, env_.context);
        if (!store_.voxels.empty())
            SC_REPORT_ERROR("own_cell", "a voxel lies here, and this cell can't trace");
        if (item.kind == LoadItem::Kind::end_of_scene) {
            ++env_.counters.cells_loaded;
            env_.counters.last_progress = now_;
        }
        from.pop(0);
        load_ = nullptr;
        ++(last ? env_.counters.loads_delivered : env_.counters.load_hops);
        if (last) env_.pools.loads.give_back(&item);
        if (!last) out[int(Side::east)]->send(0, Message(&item), env_.cycles_for(env_.load_bits(item)));
        if (from.front(0).kind != Message::Kind::none) wakeup_.at(now_ + 1);
    }

    /// Oldest first; an answer for this pixel is home.
    void pass_answers() {
        std::vector<std::pair<Cycle, int>> sides;
        for (int side = 0; side < side_count; ++side) {
            if (in[side].size() > 0 && in[side]->front(env_.classes.answer).kind == Message::Kind::answer)
                sides.emplace_back(in[side]->arrival(env_.classes.answer), side);
        }
        std::sort(sides.begin(), sides.end());
        for (const auto& [arrival, side] : sides) {
            const Cycle ready = arrival + env_.costs().route_return;
            Answer* answer = in[side]->front(env_.classes.answer).answer;
            if (now_ < ready) {
                wakeup_.at(ready);
            } else if (leaves(*answer)) {
                in[side]->pop(env_.classes.answer);
                if (home(*answer))
                    env_.pools.answers.give_back(answer);
                else
                    send(answer);
                if (in[side]->occupancy(env_.classes.answer) > 0) wakeup_.at(now_ + 1);
            }
        }
    }
    bool home(const Answer& answer) const { return answer.home_x == x_ && answer.home_y == y_; }
    /// Delivers an answer that is home; else says whether it can be sent on now.
    bool leaves(const Answer& answer) {
        if (!home(answer))
            return out[int(Router::way_home(answer, x_, y_))]->can_send(env_.classes.answer, wakeup_.next);
        wakeup_.at(now_ + 1);
        if (delivered_ == now_) return false;
        delivered_ = now_;
        ++env_.counters.answers_delivered;
        if (answer.kind == Answer::Kind::postponed) {
            injector_.primary_postponed(env_.machine, answer.id, now_);
            return true;
        }
        Pixel& pixel = env_.picture.at(x_, y_);
        pixel.colour = answer.colour;
        pixel.cycle = std::uint32_t(now_ - env_.phase_start);
        injector_.primary_answered();
        ++env_.counters.pixels_done;
        env_.counters.last_progress = now_;
        return true;
    }
    void send(Answer* answer) {
        const bool intensity = answer->kind == Answer::Kind::intensity;
        ++env_.counters.rays.return_hops;
        if (env_.phase == Phase::trace) ++env_.pixel_hops[pixel_of(answer->id)];
        out[int(Router::way_home(*answer, x_, y_))]->send(
            env_.classes.answer, Message(answer), intensity ? env_.cycles.intensity : env_.cycles.verdict,
            env_.answer_routing);
    }

    void inject() {
        if (injector_.ray() || env_.draining || !injector_.primary_due(now_, wakeup_)) return;
        if (injector_.primary_sent()) {
            ++env_.counters.rays.primary;
            record_background(env_.picture.at(x_, y_));
        }
        RayPacket* packet = env_.pools.rays.take();
        packet->ray = primary_ray(env_.context, x_, y_);
        packet->launched = now_;
        ++env_.counters.rays_sent;
        injector_.load(*packet);
    }

    RayPacket* ray_at(const Place& place) {
        if (place.side < 0) return injector_.ray();
        const Message head = in[place.side]->front(place.index);
        return head.kind == Message::Kind::ray ? head.ray : nullptr;
    }
    void remove(const Place& place) {
        if (place.side < 0)
            injector_.left();
        else
            in[place.side]->pop(place.index);
        if (place.side < 0 || in[place.side]->occupancy(place.index) > 0) wakeup_.at(now_ + 1);
    }
    /// The next untested ray, in turn.
    void test_ray() {
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const std::size_t at = (traversal_.next() + i) % places_.size();
            RayPacket* packet = ray_at(places_[at]);
            if (!packet || packet->stage != RayPacket::Stage::untested) continue;
            const std::uint32_t cycles = TraversalUnit::test(
                *packet, {store_, DepthRuns(), env_.context, env_.classes, x_, y_}, env_.costs());
            env_.counters.traversal_cycles += cycles;
            traversal_.start(*packet, std::uint32_t(at), now_ + cycles);
            return wakeup_.at(traversal_.done());
        }
    }
    /// Those that were tested, oldest first.
    void pass_rays() {
        std::vector<std::pair<Cycle, std::size_t>> tested;
        for (std::size_t at = 0; at < places_.size(); ++at) {
            const RayPacket* packet = ray_at(places_[at]);
            if (packet && packet->stage == RayPacket::Stage::decided)
                tested.emplace_back(packet->decided, at);
        }
        std::sort(tested.begin(), tested.end());
        for (const auto& [since, at] : tested) pass(*ray_at(places_[at]), places_[at]);
    }
    void pass(RayPacket& packet, const Place& place) {
        Ray& ray = packet.ray;
        const Need need = packet.need;
        if (need.kind == Need::Kind::output) {
            if (!out[int(need.side)]->can_send(need.index, wakeup_.next)) return;
            remove(place);
            ++(need.leaves ? env_.counters.rays.return_hops : env_.counters.rays.ray_hops);
            env_.counters.rays.exterior += need.leaves;
            if (env_.phase == Phase::trace) ++env_.pixel_hops[pixel_of(ray.id)];
            ++packet.hops;
            if (!need.leaves) {
                cross(ray, packet.visit.crossing, env_.context.arithmetic);
                packet.stage = RayPacket::Stage::untested;
            }
            out[int(need.side)]->send(need.index, Message(&packet),
                                      is_shadow(ray.kind) ? env_.cycles.shadow_ray : env_.cycles.ray);
        } else if (need.kind == Need::Kind::border_walk) {
            start_outside(ray, packet.visit.hit.t, env_.context.arithmetic);
            packet.stage = RayPacket::Stage::untested;
        } else {
            end(packet, place, need);
        }
    }
    /// A ray that ends here, in an answer or without one.
    void end(RayPacket& packet, const Place& place, const Need& need) {
        if (need.kind == Need::Kind::nothing) {
            ++env_.counters.rays_silent;
            env_.counters.last_progress = now_;
        } else {
            Answer answer = answer_to(packet.ray, need.answer);
            if (need.lost) answer.colour = env_.context.background;
            if (!leaves(answer)) return;
            ++env_.counters.answers_sent;
            ++env_.counters.rays_answered;
            if (!home(answer)) {
                Answer* sent = env_.pools.answers.take();
                *sent = answer;
                send(sent);
            }
        }
        env_.counters.rays.lost += need.lost;
        remove(place);
        env_.pools.rays.give_back(&packet);
    }

    Environment& env_;
    const int x_;
    const int y_;
    Cycle now_ = 0;
    Wakeup wakeup_;
    std::vector<Place> places_;
    TraversalUnit traversal_;
    Injector injector_;
    CellStore store_;          ///< stays empty
    Cycle delivered_ = never;  ///< cycle of the last answer that came home: one in a cycle
    LoadItem* load_ = nullptr;
    Cycle load_done_ = 0;
};

}  // namespace raycell
