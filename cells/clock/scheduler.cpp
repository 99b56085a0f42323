#include "cells/clock/scheduler.hpp"

#include <algorithm>

#include "cells/memory/fetch_line.hpp"

namespace raycell {

Scheduler::Scheduler(sc_core::sc_module_name name, sc_core::sc_time period)
    : sc_module(name), period_(period), wheel_(slots) {
    SC_METHOD(tick);
    sensitive << next_;
    dont_initialize();
    SC_METHOD(hold_meeting);
    sensitive << meeting_;
    dont_initialize();
}

void Scheduler::schedule(Cycle cycle) {
    if (stopped_) return;
    if (cycle > limit_) {
        limit_reached_ = true;
        return;
    }
    scheduled_ = cycle;
    if (without_kernel_ || meet_) return;  // the meeting decides the next cycle
    notify(cycle);
}

void Scheduler::notify(Cycle cycle) {
    // An earlier notification replaces a later one.
    next_.notify(sc_core::sc_time::from_value(period_.value() * (cycle - kernel_now_)));
}

/// Ends a cycle that is shared with other ranks. Cycles in which no client here is woken are run in this
/// loop: they cost no more than the meeting.
void Scheduler::hold_meeting() {
    for (;;) {
        const Cycle next = meet_(meet_argument_, scheduled_);
        if (next == never) return;
        if (next == scheduled_) {
            notify(next);
            return;
        }
        now_ = next;
        if (watch_ && !watch_(watch_argument_, now_)) {
            stopped_ = true;
            return;
        }
    }
}

Cycle Scheduler::next_busy() const {
    Cycle next = far_.empty() ? never : far_.begin()->first;
    if (!samples_.empty()) next = std::min(next, *samples_.begin());
    // 64 cycles at a time: few are busy while cells make voxels.
    for (Cycle c = now_ + 1; c < now_ + slots && c < next;) {
        const std::uint64_t busy = busy_[c % slots / 64] >> (c % 64);
        if (busy != 0) return std::min(next, c + Cycle(__builtin_ctzll(busy)));
        c += 64 - c % 64;
    }
    return next;
}

bool Scheduler::run_next() {
    without_kernel_ = true;
    if (scheduled_ == never) return false;
    tick();
    return true;
}

void Scheduler::tick() {
    if (sampler_) sampler_(now_);
    now_ = kernel_now_ = scheduled_;
    scheduled_ = never;
    const bool acts = !wheel_[now_ % slots].empty() || far_.count(now_) > 0;
    if (!samples_.empty()) samples_.erase(now_);
    if (acts && watch_ && !watch_(watch_argument_, now_)) {
        stopped_ = true;
        return;
    }
    running_.clear();
    if (running_.capacity() > 0) spare_.push_back(std::move(running_));
    running_ = std::move(wheel_[now_ % slots]);
    wheel_[now_ % slots] = {};
    busy_[now_ % slots / 64] &= ~(std::uint64_t(1) << (now_ % 64));
    const auto far = far_.find(now_);
    if (far != far_.end()) {
        if (running_.capacity() == 0 && !spare_.empty()) {
            running_.swap(spare_.back());
            spare_.pop_back();
        }
        running_.insert(running_.end(), far->second.begin(), far->second.end());
        far_.erase(far);
    }
    constexpr std::size_t ahead = 16;  // clients; one that has not run for a while is in no cache
    for (std::size_t i = 0; i < running_.size(); ++i) {
        if (i + ahead < running_.size()) fetch_line(running_[i + ahead]);
        Client* client = running_[i];
        if (client->woken_ == now_) continue;
        client->woken_ = now_;
        ++activations_;
        client->activate();
    }
    const Cycle next = next_busy();
    if (next < scheduled_) schedule(next);
    if (meet_) meeting_.notify(sc_core::SC_ZERO_TIME);  // after all activated processes have run
}

}  // namespace raycell
