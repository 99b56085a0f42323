// Cycles without a free-running clock: a time wheel that wakes what has something to do, and nothing else.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <systemc>
#include <vector>

namespace raycell {

using Cycle = std::uint64_t;
constexpr Cycle never = ~Cycle(0);

/// Something that acts at discrete cycles. A client is woken at most once per cycle.
class Client {
  public:
    virtual ~Client() = default;
    /// Makes the client's process run in this evaluation phase.
    virtual void activate() = 0;
    /// Whoever runs it sees that it will be activated soon.
    virtual void foreseen() const {}
    /// Last cycle in which it was activated; `never` before the first.
    Cycle woken() const { return woken_; }

  protected:
    // Bits that links keep for their ends: Link::watch() and Link::tell_room().
    std::uint32_t pending_ = 0;
    std::uint32_t room_made_ = 0;

  private:
    friend class Scheduler;
    friend class Link;
    Cycle woken_ = never;
    Cycle due_ = never;  ///< last cycle for which it was noted
};

/// One SC_METHOD that runs in each cycle in which somebody is to be woken.
class Scheduler : public sc_core::sc_module {
  public:
    SC_HAS_PROCESS(Scheduler);
    Scheduler(sc_core::sc_module_name name, sc_core::sc_time period);

    Cycle now() const { return now_; }
    sc_core::sc_time period() const { return period_; }

    /// Activates `client` in `cycle`, which must lie after now() (or be now() before anything has run).
    void wake(Client& client, Cycle cycle) {
        if (client.due_ == cycle) return;  // noted already: entries of cycles to come stay
        client.due_ = cycle;
        if (cycle - now_ < slots) {
            std::vector<Client*>& due = wheel_[cycle % slots];
            if (due.capacity() == 0 && !spare_.empty()) {
                due.swap(spare_.back());
                spare_.pop_back();
            }
            due.push_back(&client);
            ++waiting_;
        } else {
            far_[cycle].push_back(&client);
        }
        if (cycle < scheduled_) schedule(cycle);
    }

    /// No cycle after this one is run; limit_reached() tells that there would have been one.
    void set_limit(Cycle limit) { limit_ = limit; }
    /// Whether the watch ended the run.
    bool stopped() const { return stopped_; }
    bool limit_reached() const { return limit_reached_; }

    /// Called before the clients of a cycle; returning false ends the run: nobody is woken any more.
    void set_watch(bool (*watch)(void*, Cycle), void* argument) {
        watch_ = watch;
        watch_argument_ = argument;
    }

    /// Called before each cycle that is run, with the one run before it: what stood at that one's end stands
    /// still.
    void set_sampler(std::function<void(Cycle)> sampler) { sampler_ = std::move(sampler); }

    /// What can be seen changes in `cycle`, though nobody acts before `acts`: if there is a sampler, it is
    /// called for that cycle too. Nothing else happens in it, the watch is not called: sampling changes no
    /// run.
    void sample_at(Cycle cycle, Cycle acts) {
        if (!sampler_ || acts > limit_) return;
        samples_.insert(cycle);
        if (cycle < scheduled_) schedule(cycle);
    }

    /// Sets the clock of a stopped run without activating any client: to look at it as it would be later.
    void set_now(Cycle now) { now_ = now; }

    /// Has the cycle that was run last sampled; after sc_start(), when no cycle comes that would do it.
    void sample() {
        if (sampler_) sampler_(now_);
    }
    /// The cycle that will be run next, or is about to be when a sampler is called; `never` if none is known.
    Cycle next() const { return scheduled_; }

    /// For a machine that shares its cycles with others (pipeline/ranks/rank_exchange.hpp): called after
    /// every cycle that was run, when all is done in it, with the next one in which somebody here is to be
    /// woken. Returns the next cycle that is to be run, by all of them alike; `never` ends the run. It may
    /// wake clients.
    void set_meeting(Cycle (*meet)(void*, Cycle), void* argument) {
        meet_ = meet;
        meet_argument_ = argument;
    }
    /// To be called before each sc_start(): others may have something to do where nobody here has.
    void begin() {
        if (meet_) meeting_.notify(sc_core::SC_ZERO_TIME);
    }

    /// Who is to be woken in a cycle after now(), as far as it is known: for asking for memory ahead.
    const std::vector<Client*>& foreseen(Cycle cycle) const { return wheel_[cycle % slots]; }

    std::uint64_t activations() const { return activations_; }

    /// Begins the next cycle without SystemC's kernel; false if there is none. For measuring what the kernel
    /// costs: who is activated is to be run before the next call.
    bool run_next();

  private:
    static constexpr Cycle slots = 4096;  // power of two, above every usual delay

    void tick();
    void hold_meeting();
    void schedule(Cycle cycle);
    void notify(Cycle cycle);
    Cycle next_busy() const;

    sc_core::sc_time period_;
    sc_core::sc_event next_;
    sc_core::sc_event meeting_;
    std::vector<std::vector<Client*>> wheel_;
    std::vector<std::vector<Client*>> spare_;  ///< room of cycles gone by: used last first, it is in a cache
    std::vector<Client*> running_;
    std::map<Cycle, std::vector<Client*>> far_;  ///< beyond one turn of the wheel
    Cycle now_ = 0;
    Cycle kernel_now_ = 0;  ///< at which the kernel stands: cycles that only others run pass it by
    Cycle scheduled_ = never;
    Cycle limit_ = never;
    std::uint64_t waiting_ = 0;  ///< entries in the wheel
    std::uint64_t activations_ = 0;
    bool limit_reached_ = false;
    bool stopped_ = false;
    bool without_kernel_ = false;
    bool (*watch_)(void*, Cycle) = nullptr;
    void* watch_argument_ = nullptr;
    Cycle (*meet_)(void*, Cycle) = nullptr;
    void* meet_argument_ = nullptr;
    std::function<void(Cycle)> sampler_;
    std::set<Cycle> samples_;  ///< cycles to come of sample_at()
};

}  // namespace raycell
