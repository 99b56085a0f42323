// Writes value change dumps (VCD, IEEE 1364-2005, section 18).
//
// Not SystemC's own sc_trace: that compares every traced value in every delta cycle from elaboration to the
// end of the simulation, can't be told to begin late or to stop, and knows no words. Probes know when a cell
// may have changed, and want windows and a limit of the file's size.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cells/clock/scheduler.hpp"

namespace raycell {

/// Declarations first: scopes and signals; then begin(), then for each cycle at() and set().
class VcdWriter {
  public:
    using Signal = std::uint32_t;
    static constexpr std::uint64_t no_ray = ~std::uint64_t(0);

    /// What has been declared, in order, for save files.
    struct Declaration {
        enum class Kind { scope, end_of_scope, flag, number, word, ray };
        Kind kind;
        std::string name;
        int bits = 1;
    };

    /// `file` stays the caller's, who looks for errors (ferror) when he closes it. A cycle lasts `period_ps`
    /// picoseconds. The file will have `limit` bytes at most, but for declarations that are longer alone.
    VcdWriter(std::FILE* file, std::uint64_t period_ps, std::uint64_t limit);

    void open_scope(const std::string& name);
    void close_scope();
    Signal add_flag(const std::string& name);
    /// An unsigned number.
    Signal add_number(const std::string& name, int bits);
    /// One of `words`, which must outlive the writer; the value is the index.
    Signal add_word(const std::string& name, const char* const* words);
    /// A ray's id, written as reports do, pixel/branch; `no_ray` is "-".
    Signal add_ray(const std::string& name);

    /// Ends the declarations and writes what has been set so far as the values of this cycle.
    void begin(Cycle cycle);
    /// What is set from now on belongs to this cycle; never earlier than the last.
    void at(Cycle cycle) { cycle_ = cycle; }
    void set(Signal signal, std::uint64_t value);
    /// The last value holds until the beginning of this cycle.
    void end(Cycle cycle);

    /// A cycle's time as viewers count it: in the whole unit, ps, ns, us or ms, of the time scale.
    std::uint64_t display_time(Cycle cycle) const { return cycle * units_per_cycle_ * units_shown_; }

    std::uint64_t bytes() const { return written_ + buffer_.size(); }
    /// Whether the limit was reached: nothing is written any more. The last whole cycle is before at()'s.
    bool stopped() const { return stopped_; }
    const std::vector<Declaration>& declarations() const { return declarations_; }

  private:
    struct Value {
        Declaration::Kind kind;
        const char* const* words = nullptr;
        std::string code;
        std::uint64_t value = 0;
    };

    Signal add(Declaration::Kind kind, const std::string& name, int bits, const char* const* words);
    void header();
    bool stamp(Cycle cycle);
    void write_value(const Value& value);
    void flush();

    std::FILE* file_;
    std::uint64_t limit_;
    std::uint64_t units_per_cycle_;
    std::uint64_t units_shown_ = 1;  ///< 1, 10 or 100: the time scale's number
    std::string timescale_;
    std::vector<Declaration> declarations_;
    std::vector<Value> values_;
    std::string buffer_;
    std::uint64_t written_ = 0;
    std::uint64_t longest_cycle_ = 0;  ///< bytes if every signal changes
    Cycle cycle_ = 0;
    Cycle stamped_ = never;
    bool begun_ = false;
    bool stopped_ = false;
};

}  // namespace raycell
