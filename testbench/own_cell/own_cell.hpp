// An example of a user's own cell: a plain SystemC module that forwards load messages, rays and answers and
// sends its pixels' primary rays. Where no voxel lies, it can replace an array's cell (own_cell_test.cpp).
#pragma once

#include <algorithm>
#include <tuple>

#include "cells/hosts/cell_socket.hpp"
#include "cells/passing.hpp"
#include "cells/units/router.hpp"
#include "cells/units/traversal_unit.hpp"

namespace raycell {

class OwnCell : public CellSocket {
  public:
    SC_HAS_PROCESS(OwnCell);
    OwnCell(sc_core::sc_module_name name, Environment& environment, int x, int y)
        : CellSocket(name),
          env_(environment),
          x_(x),
          y_(y),
          loading_(environment.machine.loading_units),
          traversal_(environment.machine.traversal_units),
          injector_(environment.own_rays) {
        SC_METHOD(run);
        sensitive << woken();
        dont_initialize();
    }
    void begin_phase() override {
        begin_tracing(injector_, env_, 0, env_.phase == Phase::trace ? env_.settings.block() : 0,
                      start_of_primaries(env_, x_, y_));
    }
    void begin_tree(int pixel) override { begin_tracing(injector_, env_, pixel, pixel + 1, 0); }

  private:
    struct Place {
        LinkIn* from;  ///< null: the register of the own ray
        int index;
    };

    void end_of_elaboration() override {
        for (int side = 0; side < side_count; ++side) {
            for (int index = 0; index < env_.classes.count && input(Side(side)); ++index)
                places_.push_back({input(Side(side)), index});
        }
        places_.push_back({nullptr, 0});
    }
    void run() {
        now_ = env_.scheduler.now();
        wakeup_ = Wakeup();
        if (env_.phase == Phase::load) {
            pass_load(loading_, *load_input(), output(Side::east), store_, env_, meter_, x_, wakeup_);
            if (!store_.voxels.empty()) SC_REPORT_ERROR("own_cell", "a voxel lies here, and it can't trace");
        } else {
            traversal_.finish(now_, wakeup_, [](std::uint32_t) {});
            pass_answers();
            inject();
            pass_rays();
            test();
        }
        if (wakeup_.next != never) env_.scheduler.wake(*this, wakeup_.next);
    }

    Message head(const Place& place) const {
        if (place.from) return place.from->front(place.index);
        return injector_.ray() ? Message(injector_.ray()) : Message();
    }
    void inject() {
        if (injector_.ray() || env_.draining) return;
        const auto number = injector_.primary_due(now_, wakeup_);
        if (number) injector_.load(*launch(begin_primary(*number, injector_, env_, x_, y_), env_));
    }
    /// Passes on answers, oldest first.
    void pass_answers() {
        std::vector<std::pair<Cycle, std::size_t>> ready;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            if (head(places_[i]).kind == Message::Kind::answer)
                ready.emplace_back(places_[i].from->arrival(places_[i].index), i);
        }
        std::sort(ready.begin(), ready.end());
        for (const auto& [since, i] : ready) {
            const Cycle routed = since + env_.costs().route_return;
            if (now_ < routed) {
                wakeup_.at(routed);
            } else if (pass(head(places_[i]).answer)) {
                remove_from(places_[i]);
            }
        }
    }
    /// Passes on tested rays, oldest first.
    void pass_rays() {
        std::vector<std::pair<Cycle, std::size_t>> ready;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Message message = head(places_[i]);
            if (message.kind == Message::Kind::ray && message.ray->stage == RayPacket::Stage::decided)
                ready.emplace_back(message.ray->decided, i);
        }
        std::sort(ready.begin(), ready.end());
        for (const auto& [since, i] : ready) {
            if (pass(*head(places_[i]).ray)) remove_from(places_[i]);
        }
    }
    void remove_from(const Place& place) {
        place.from ? place.from->pop(place.index) : injector_.left();
        if (!place.from || place.from->occupancy(place.index) > 0) wakeup_.at(now_ + 1);
    }

    /// Delivers an answer that is home, one per cycle; sends others on. False: not possible now.
    bool pass(Answer* answer) {
        if (answer->home_x == x_ && answer->home_y == y_) {
            wakeup_.at(now_ + 1);
            if (delivered_ == now_) return false;
            delivered_ = now_;
            meter_.delivered(env_.meters.counters, answer->kind, now_);
            end_primary(*answer, injector_, env_, x_, y_);
            env_.pools.answers.give_back(answer);
            return true;
        }
        LinkOut& to = *output(Router::way_home(*answer, x_, y_));
        if (!to.can_send(env_.classes.answer, wakeup_.next)) return false;
        send_answer(answer, to, env_, meter_);
        return true;
    }

    /// Sends a ray on or ends it. False: not possible now, or it stays for another test.
    bool pass(RayPacket& packet) {
        const Need need = packet.need;
        if (need.kind == Need::Kind::border_walk) {
            start_outside(packet.ray, packet.visit.hit.t, env_.context.arithmetic);
            packet.stage = RayPacket::Stage::untested;
            return false;
        }
        if (need.kind == Need::Kind::output) {
            if (!output(need.side)->can_send(need.index, wakeup_.next)) return false;
            send_ray(packet, *output(need.side), env_, meter_);
            return true;
        }
        if (need.kind == Need::Kind::response) {
            Answer* answer = env_.pools.answers.take();
            *answer = response_of(packet, env_.context);
            if (!pass(answer)) return env_.pools.answers.give_back(answer), false;
            ++env_.meters.counters.answers_sent;
        }
        end_ray(packet, env_, meter_);
        return true;
    }

    /// Tests the next untested rays, in turn, until no unit is free.
    void test() {
        const std::size_t first = traversal_.next();
        for (std::size_t i = 0; i < places_.size() && traversal_.free(); ++i) {
            const std::size_t at = (first + i) % places_.size();
            const Message message = head(places_[at]);
            if (message.kind != Message::Kind::ray || message.ray->stage != RayPacket::Stage::untested)
                continue;
            const std::uint32_t cycles = TraversalUnits::test(
                *message.ray, {store_, {}, env_.context, env_.classes, x_, y_}, env_.costs());
            meter_.tested(env_.meters.counters, message.ray->visit, cycles);
            traversal_.start(*message.ray, std::uint32_t(at), now_ + cycles);
            wakeup_.at(now_ + cycles);
        }
    }

    Environment& env_;
    const int x_, y_;
    Cycle now_ = 0;
    Wakeup wakeup_;
    std::vector<Place> places_;
    CellMeter meter_;
    LoadingUnits loading_;
    TraversalUnits traversal_;
    Injector injector_;
    CellStore store_;          ///< stays empty
    Cycle delivered_ = never;  ///< cycle of the last answer that came home
};

}  // namespace raycell
