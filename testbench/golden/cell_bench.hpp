// A bench for one cell: a driver plays its neighbours and compares what the cell does with what is expected.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cells/hosts/cell_module.hpp"
#include "testbench/golden/file.hpp"
#include "testbench/golden/packing.hpp"

namespace raycell {

/// A cell with links on its sides, as in an array. The driver applies the events that the cell is told, in
/// their cycles. Whatever the cell sends (out) or takes from a buffer (take) must be the next expected event
/// of that buffer, in the same cycle, with the same bits (or, where there are none, the same words). Build
/// all benches of a process before the first run.
class CellBench : public sc_core::sc_module, public Client, private LinkObserver {
  public:
    SC_HAS_PROCESS(CellBench);
    /// `events` in the order of their cycles; nothing runs after cycle `last`. Throws GoldenError for events
    /// of buffers that the cell does not have, for what is no message, and for a message whose bits and words
    /// differ.
    CellBench(sc_core::sc_module_name name, const CellSetup& setup, std::vector<GoldenEvent> events,
              Cycle last);

    /// Runs to the end and returns what was wrong, a line each, `most` lines at most: events that differed,
    /// in the order of cycles, then those that never came, then the pixel.
    std::vector<std::string> run(std::size_t most = 10);
    /// Number of messages, takes and pixels so far that were as expected.
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
    void check(const GoldenEvent& event);
    Message message_of(const GoldenEvent& event);

    CellSetup setup_;
    Scheduler scheduler_;
    Picture picture_;
    Environment environment_;
    CellModule module_;
    Words words_;
    Packing packing_;
    std::array<std::unique_ptr<Link>, side_count> in_;
    std::array<std::unique_ptr<Link>, side_count> out_;
    std::unique_ptr<Link> load_;
    std::vector<GoldenEvent> stimuli_;
    std::size_t next_change_ = 0;  ///< first stimulus not yet checked for a phase or drain
    std::size_t next_ = 0;         ///< first stimulus not yet driven
    std::map<Key, std::deque<GoldenEvent>> expected_;
    std::vector<GoldenEvent> pixels_;
    Cycle last_;
    sc_core::sc_event wake_;
    std::vector<std::string> failures_;
    std::size_t most_failures_ = 10;
    std::uint64_t matched_ = 0;
    bool shadow_bits_ = false;  ///< they were set to lit, since loading is over
    bool given_up_ = false;     ///< the stimuli no longer make sense
};

}  // namespace raycell
