// Writes value change dumps (VCD, IEEE 1364-2005, section 18).
//
// SystemC's sc_trace is not used: it compares every traced value in every delta cycle from elaboration to the
// end of the simulation, can't begin late or stop, and has no string values. Probes know when a cell may have
// changed, and need windows and a limit on the file's size.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cells/clock/scheduler.hpp"

namespace raycell {

/// Order of calls: the declarations of scopes and signals, then begin(), then at() and set() for each cycle.
class VcdWriter {
  public:
    using Signal = std::uint32_t;
    static constexpr std::uint64_t no_ray = ~std::uint64_t(0);

    /// One declaration; kept in order for save files.
    struct Declaration {
        enum class Kind { scope, end_of_scope, flag, number, word, ray };
        Kind kind;
        std::string name;
        int bits = 1;
    };

    /// `file` belongs to the caller, who must check for errors (ferror) on closing it. A cycle lasts
    /// `period_ps` picoseconds. The file has at most `limit` bytes, unless the declarations alone are longer.
    VcdWriter(std::FILE* file, std::uint64_t period_ps, std::uint64_t limit);

    void open_scope(const std::string& name);
    void close_scope();
    Signal add_flag(const std::string& name);
    /// An unsigned number.
    Signal add_number(const std::string& name, int bits);
    /// One of `words`, which must outlive the writer; the value is the index.
    Signal add_word(const std::string& name, const char* const* words);
    /// A ray's id, written as in reports: pixel/branch; "-" for `no_ray`.
    Signal add_ray(const std::string& name);

    /// Ends the declarations and writes the values set so far as those of this cycle.
    void begin(Cycle cycle);
    /// Values set from now on belong to this cycle, which must not be earlier than the last.
    void at(Cycle cycle) { cycle_ = cycle; }
    void set(Signal signal, std::uint64_t value);
    /// Ends the dump: the last values hold until the beginning of this cycle.
    void end(Cycle cycle);

    /// A cycle's time in the unit of viewers: the ps, ns, us or ms of the time scale, without its 10 or 100.
    std::uint64_t display_time(Cycle cycle) const { return cycle * units_per_cycle_ * units_shown_; }

    std::uint64_t bytes() const { return written_ + buffer_.size(); }
    /// Whether the limit was reached: nothing more is written. The last complete cycle is the one before
    /// at()'s.
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
