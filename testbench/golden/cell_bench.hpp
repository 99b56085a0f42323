// One cell alone: a driver plays its neighbours, and what it does is compared with what is expected.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cells/hosts/cell_module.hpp"
#include "testbench/golden/file.hpp"

namespace raycell {

/// A cell with links on its sides, as an array would have it. The driver does what `events` tell the cell, in
/// their cycles; whatever the cell sends (out) or takes from its buffers (take) must be the next expected
/// event of that buffer, in the same cycle, word for word; a token "*" stands for anything. Build all benches
/// of a process before the first run.
class CellBench : public sc_core::sc_module, public Client, private LinkObserver {
  public:
    SC_HAS_PROCESS(CellBench);
    /// `events` in the order of their cycles; nothing is run after cycle `last`. Throws GoldenError for
    /// events that the cell has no buffers for.
    CellBench(sc_core::sc_module_name name, const CellSetup& setup, std::vector<GoldenEvent> events,
              Cycle last);

    /// Runs to the end and returns what was wrong, in the order of its cycles, a line each; `most` lines at
    /// most.
    std::vector<std::string> run(std::size_t most = 10);
    /// Comparisons made so far: messages and takes that were as expected.
    std::uint64_t matched() const { return matched_; }

    Environment& environment() { return environment_; }
    CellModule& module() { return module_; }
    Cell& cell() { return module_.cell(); }
    Cycle last() const { return last_; }

    void activate() override { wake_.notify(); }

  private:
    using Key = std::array<int, 3>;  ///< what, side, class
    static bool begin_cycle(void* self, Cycle now);
    void drive();
    void send(const GoldenEvent& event);
    void free(const GoldenEvent& event);
    void change(const GoldenEvent& event, Cycle now);
    std::string objection(const Message& message, int index) const;
    std::string objection_to_answer(const Answer& answer) const;
    void sent(const Link& link, int index, const Message& message, int cycles, Cycle now) override;
    void popped(const Link& link, int index, const Message& message, Cycle now) override;
    void compare(const GoldenEvent& event);
    std::string difference(const GoldenEvent& is, const GoldenEvent& expected) const;
    void compare_pixel();
    void report(const GoldenEvent& event, const std::string& what);
    void schedule_next();
    void make_links();

    CellSetup setup_;
    Scheduler scheduler_;
    Picture picture_;
    Environment environment_;
    CellModule module_;
    Words words_;
    std::array<std::unique_ptr<Link>, side_count> in_;
    std::array<std::unique_ptr<Link>, side_count> out_;
    std::unique_ptr<Link> load_;
    std::vector<GoldenEvent> stimuli_;
    std::size_t next_change_ = 0;  ///< first of the stimuli that no cycle has looked at for a phase
    std::size_t next_ = 0;         ///< first of the stimuli that is still to be driven
    std::map<Key, std::deque<GoldenEvent>> expected_;
    std::vector<GoldenEvent> pixels_;
    Cycle last_;
    sc_core::sc_event wake_;
    std::vector<std::string> failures_;
    std::size_t most_failures_ = 10;
    std::uint64_t matched_ = 0;
    bool shadow_bits_ = false;  ///< they have been set to lit: loading is over
    bool given_up_ = false;     ///< what it is told makes no sense any more
};

}  // namespace raycell
