// Cycles without a free-running clock: a time wheel that wakes only the clients that have work.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <systemc>
#include <vector>

namespace raycell {

using Cycle = std::uint64_t;
constexpr Cycle never = ~Cycle(0);

/// An object that acts in discrete cycles. It is woken at most once per cycle.
class Client {
  public:
    virtual ~Client() = default;
    /// Makes the client's process run in this evaluation phase.
    virtual void activate() = 0;
    /// Hint: the client will be activated soon.
    virtual void foreseen() const {}
    /// Last cycle in which it was activated; `never` before the first.
    Cycle woken() const { return woken_; }

  protected:
    // Bits that links keep for their sinks and sources: Link::watch() and Link::tell_room().
    std::uint32_t pending_ = 0;
    std::uint32_t room_made_ = 0;

  private:
    friend class Scheduler;
    friend class Link;
    Cycle woken_ = never;
    Cycle due_ = never;  ///< the cycle of its latest entry in the scheduler
};

/// Keeps the cycles of a run: one SC_METHOD that runs in each cycle in which a client must be woken.
class Scheduler : public sc_core::sc_module {
  public:
    SC_HAS_PROCESS(Scheduler);
    Scheduler(sc_core::sc_module_name name, sc_core::sc_time period);

    Cycle now() const { return now_; }
    sc_core::sc_time period() const { return period_; }

    /// Activates `client` in `cycle`, which must lie after now() (or be now() before anything has run).
    void wake(Client& client, Cycle cycle) {
        if (client.due_ == cycle) return;  // already entered: entries of later cycles are never removed
        client.due_ = cycle;
        if (cycle - now_ < slots) {
            std::vector<Client*>& due = wheel_[cycle % slots];
            if (due.capacity() == 0 && !spare_.empty()) {
                due.swap(spare_.back());
                spare_.pop_back();
            }
            due.push_back(&client);
            busy_[cycle % slots / 64] |= std::uint64_t(1) << (cycle % 64);
        } else {
            far_[cycle].push_back(&client);
        }
        if (cycle < scheduled_) schedule(cycle);
    }

    /// Sets the last cycle that may run; limit_reached() tells whether a later cycle was needed.
    void set_limit(Cycle limit) { limit_ = limit; }
    /// Whether the watch ended the run.
    bool stopped() const { return stopped_; }
    bool limit_reached() const { return limit_reached_; }

    /// `watch` is called before the clients of a cycle are woken. If it returns false, the run ends and no
    /// client is woken any more.
    void set_watch(bool (*watch)(void*, Cycle), void* argument) {
        watch_ = watch;
        watch_argument_ = argument;
    }

    /// `sampler` is called before each cycle that is run, with the number of the cycle run before it: the
    /// state is still the one at that cycle's end.
    void set_sampler(std::function<void(Cycle)> sampler) { sampler_ = std::move(sampler); }

    /// The visible state changes in `cycle`, but no client acts before cycle `acts`. If there is a sampler,
    /// it is called for `cycle` too. Nothing else happens in that cycle, and the watch is not called:
    /// sampling does not change a run.
    void sample_at(Cycle cycle, Cycle acts) {
        if (!sampler_ || acts > limit_) return;
        samples_.insert(cycle);
        if (cycle < scheduled_) schedule(cycle);
    }

    /// Sets the clock of a stopped run without activating any client, to look at the machine as it would be
    /// later.
    void set_now(Cycle now) { now_ = now; }

    /// Samples the last cycle of a run. To be called after sc_start(), because no later cycle samples it.
    void sample() {
        if (sampler_) sampler_(now_);
    }
    /// The cycle that will be run next (inside a sampler: that is about to run); `never` if none is known.
    Cycle next() const { return scheduled_; }

    /// For a machine that shares its cycles with other ranks (pipeline/ranks/rank_exchange.hpp). `meet` is
    /// called at the end of every cycle run, with the next cycle in which a client here must be woken. It
    /// returns the next cycle to run, the same for all ranks; `never` ends the run. It may wake clients.
    void set_meeting(Cycle (*meet)(void*, Cycle), void* argument) {
        meet_ = meet;
        meet_argument_ = argument;
    }
    /// To be called before each sc_start(): other ranks may have work in cycles in which this one has none.
    void begin() {
        if (meet_) meeting_.notify(sc_core::SC_ZERO_TIME);
    }

    /// The clients known to be woken in a cycle after now(), for prefetching; `cycle` must be less than one
    /// turn of the wheel ahead.
    const std::vector<Client*>& foreseen(Cycle cycle) const { return wheel_[cycle % slots]; }

    std::uint64_t activations() const { return activations_; }

    /// Begins the next cycle without SystemC's kernel; false if there is none. Used to measure the kernel's
    /// cost: the caller must run the activated clients before the next call.
    bool run_next();

  private:
    static constexpr Cycle slots = 4096;  // of the wheel: a power of two, above every usual delay

    void tick();
    void hold_meeting();
    void schedule(Cycle cycle);
    void notify(Cycle cycle);
    Cycle next_busy() const;

    sc_core::sc_time period_;
    sc_core::sc_event next_;
    sc_core::sc_event meeting_;
    std::vector<std::vector<Client*>> wheel_;
    std::array<std::uint64_t, slots / 64> busy_{};  ///< a bit for each list of the wheel that is not empty
    std::vector<std::vector<Client*>> spare_;       ///< lists of past cycles, for reuse; the latest first
    std::vector<Client*> running_;
    std::map<Cycle, std::vector<Client*>> far_;  ///< entries beyond one turn of the wheel
    Cycle now_ = 0;
    Cycle kernel_now_ = 0;  ///< the kernel's cycle: it does not see cycles without work here
    Cycle scheduled_ = never;
    Cycle limit_ = never;
    std::uint64_t activations_ = 0;
    bool limit_reached_ = false;
    bool stopped_ = false;
    bool without_kernel_ = false;
    bool (*watch_)(void*, Cycle) = nullptr;
    void* watch_argument_ = nullptr;
    Cycle (*meet_)(void*, Cycle) = nullptr;
    void* meet_argument_ = nullptr;
    std::function<void(Cycle)> sampler_;
    std::set<Cycle> samples_;  ///< future cycles of sample_at()
};

}  // namespace raycell
