// What loading.sv does for a message, step by step: a script of calls, copies and jumps.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "testbench/cell/unit_calls.hpp"

namespace raycell {

/// The unit's own memories.
enum class LoadMemory : std::uint8_t { voxels, edges, table };
/// What it writes out: the traversal units' store; of the shading unit voxels, objects, sources.
enum class LoadPort : std::uint8_t { store, voxels, objects, sources };

/// One step. Fields a, b, c are numbers of the unit's fields; what works on `count` words does one a cycle,
/// and every other step takes a cycle, a call as long as it runs.
struct LoadStep {
    enum class Op : std::uint8_t {
        end,
        fail,        ///< ends; the unit can't do what it was told
        rewind,      ///< the ports' addresses begin at 0 again
        set,         ///< a = value
        add_number,  ///< a = b + value
        add,         ///< a = b + c
        copy,        ///< a, ... = b, ...
        get,         ///< a, ... = the memory's words from b + number c on
        put,         ///< the memory's words from b on = c, ...
        write,       ///< b, ... to a port, from its next address on
        take,        ///< a, ... = parts of the message
        send,        ///< these parts of the message that goes on = b, ...
        call,
        jump,
        jump_is,     ///< if b is the number c
        jump_equal,  ///< if b is c
    };
    Op op = Op::end;
    std::size_t a = 0, b = 0, c = 0;
    std::int64_t value = 0;  ///< a number, a call, where to jump, or what has_count() says
    std::size_t count() const { return has_count() ? std::size_t(value & 63) : 1; }
    std::size_t place() const { return std::size_t(value >> 6); }  ///< memory or port
    bool has_count() const { return op >= Op::copy && op <= Op::send; }
    bool jumps() const { return op >= Op::jump; }
};

/// Writes a script. Fields are named; those of a block stand beside each other in the order of the unit.
class LoadScript {
  public:
    explicit LoadScript(const UnitCalls& unit) : unit_(unit) {}

    void label(const std::string& name) { labels_[name] = std::int64_t(steps_.size()); }
    void end() { emit({LoadStep::Op::end}); }
    void fail() { emit({LoadStep::Op::fail}); }
    void rewind() { emit({LoadStep::Op::rewind}); }
    void set(const std::string& a, std::int64_t value) { emit({LoadStep::Op::set, f(a), 0, 0, value}); }
    void add(const std::string& a, const std::string& b, std::int64_t value) {
        emit({LoadStep::Op::add_number, f(a), f(b), 0, value});
    }
    void move(const std::string& a, const std::string& b) { add(a, b, 0); }
    void sum(const std::string& a, const std::string& b, const std::string& c) {
        emit({LoadStep::Op::add, f(a), f(b), f(c)});
    }
    void copy(const std::string& a, const std::string& b, std::size_t count) {
        emit({LoadStep::Op::copy, f(a), f(b), 0, std::int64_t(count)});
    }
    void get(LoadMemory memory, const std::string& a, const std::string& address, std::size_t count,
             std::size_t offset = 0) {
        emit({LoadStep::Op::get, f(a), f(address), offset, std::int64_t(std::size_t(memory) << 6U | count)});
    }
    void put(LoadMemory memory, const std::string& address, const std::string& from, std::size_t count) {
        emit({LoadStep::Op::put, 0, f(address), f(from), std::int64_t(std::size_t(memory) << 6U | count)});
    }
    /// Fields in this order; those beside each other are one step.
    void write(LoadPort port, const std::vector<std::string>& names);
    void take(const std::string& a, std::size_t count) {
        emit({LoadStep::Op::take, f(a), 0, 0, std::int64_t(count)});
    }
    void send(const std::string& b, std::size_t count) {
        emit({LoadStep::Op::send, 0, f(b), 0, std::int64_t(count)});
    }
    void call(const std::string& name) {
        emit({LoadStep::Op::call, 0, 0, 0, std::int64_t(unit_.call(name))});
    }
    void jump(const std::string& to) { jump({LoadStep::Op::jump}, to); }
    void jump_is(const std::string& b, std::size_t number, const std::string& to) {
        jump({LoadStep::Op::jump_is, 0, f(b), number}, to);
    }
    void jump_equal(const std::string& b, const std::string& c, const std::string& to) {
        jump({LoadStep::Op::jump_equal, 0, f(b), f(c)}, to);
    }

    /// Finds where the jumps go. Throws std::logic_error for a label that there is not.
    void finish();
    const std::vector<LoadStep>& steps() const { return steps_; }
    std::size_t entry(const std::string& label) const { return std::size_t(labels_.at(label)); }
    /// For $readmemh, a step a word: op, a, b, c, value.
    std::string file() const;
    std::string constants() const;

  private:
    std::size_t f(const std::string& field) const { return unit_.field(field); }
    void emit(const LoadStep& step) { steps_.push_back(step); }
    void jump(const LoadStep& step, const std::string& to);
    int field_bits() const { return bits_of(unit_.fields().size()); }
    int value_bits() const;

    const UnitCalls& unit_;
    std::vector<LoadStep> steps_;
    std::map<std::string, std::int64_t> labels_;
    std::vector<std::pair<std::size_t, std::string>> jumps_;
};

}  // namespace raycell
