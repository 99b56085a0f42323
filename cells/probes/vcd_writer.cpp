#include "cells/probes/vcd_writer.hpp"

#include <charconv>

namespace raycell {
namespace {

constexpr std::size_t flush_at = 1 << 16;
constexpr std::uint64_t room_for_the_end = 200;  ///< bytes: comment and last time

/// The format's identifier code of a signal: short, of printable characters.
std::string code_of(std::size_t number) {
    constexpr std::size_t first = 33;
    constexpr std::size_t count = 94;
    std::string code;
    do {
        code += char(first + number % count);
        number /= count;
    } while (number > 0);
    return code;
}

void append_number(std::string& text, std::uint64_t number) {
    char digits[24];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

void append_binary(std::string& text, std::uint64_t number) {
    char digits[64];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number, 2).ptr);
}

}  // namespace

VcdWriter::VcdWriter(std::FILE* file, std::uint64_t period_ps, std::uint64_t limit)
    : file_(file), limit_(limit), units_per_cycle_(period_ps) {
    // The coarsest unit that divides the period: 1, 10 or 100 of ps, ns, us or ms.
    constexpr const char* units[] = {"ps", "ns", "us", "ms"};
    int power = 0;
    while (units_per_cycle_ > 0 && units_per_cycle_ % 10 == 0 && power < 11) {
        units_per_cycle_ /= 10;
        ++power;
    }
    units_shown_ = power % 3 == 0 ? 1 : power % 3 == 1 ? 10 : 100;
    timescale_ = std::to_string(units_shown_) + " " + units[power / 3];
    buffer_.reserve(2 * flush_at);
}

void VcdWriter::open_scope(const std::string& name) {
    declarations_.push_back({Declaration::Kind::scope, name});
}

void VcdWriter::close_scope() { declarations_.push_back({Declaration::Kind::end_of_scope, ""}); }

VcdWriter::Signal VcdWriter::add(Declaration::Kind kind, const std::string& name, int bits,
                                 const char* const* words) {
    declarations_.push_back({kind, name, bits});
    values_.push_back({kind, words, code_of(values_.size()), 0});
    return Signal(values_.size() - 1);
}

VcdWriter::Signal VcdWriter::add_flag(const std::string& name) {
    return add(Declaration::Kind::flag, name, 1, nullptr);
}

VcdWriter::Signal VcdWriter::add_number(const std::string& name, int bits) {
    return add(Declaration::Kind::number, name, bits, nullptr);
}

VcdWriter::Signal VcdWriter::add_word(const std::string& name, const char* const* words) {
    return add(Declaration::Kind::word, name, 1, words);
}

VcdWriter::Signal VcdWriter::add_ray(const std::string& name) {
    return add(Declaration::Kind::ray, name, 1, nullptr);
}

void VcdWriter::header() {
    buffer_ += "$version raycell $end\n$comment one cycle: ";
    append_number(buffer_, units_per_cycle_);
    buffer_ += " x " + timescale_ + " $end\n$timescale " + timescale_ + " $end\n";
    std::size_t signal = 0;
    for (const Declaration& d : declarations_) {
        if (buffer_.size() > flush_at) flush();
        if (d.kind == Declaration::Kind::scope) {
            buffer_ += "$scope module " + d.name + " $end\n";
            continue;
        }
        if (d.kind == Declaration::Kind::end_of_scope) {
            buffer_ += "$upscope $end\n";
            continue;
        }
        const std::string& code = values_[signal++].code;
        // Strings are an extension of the format, read by GTKWave and others; numbers would need a table of
        // names.
        const bool word = d.kind == Declaration::Kind::word || d.kind == Declaration::Kind::ray;
        buffer_ += std::string("$var ") + (word ? "string" : "wire") + " " + std::to_string(d.bits) + " " +
                   code + " " + d.name;
        if (d.bits > 1) buffer_ += " [" + std::to_string(d.bits - 1) + ":0]";
        buffer_ += " $end\n";
        constexpr std::uint64_t longest_value = 66;
        longest_cycle_ += longest_value + code.size();
    }
    buffer_ += "$enddefinitions $end\n";
}

void VcdWriter::begin(Cycle cycle) {
    header();
    begun_ = true;
    cycle_ = cycle;
    if (!stamp(cycle)) return;
    buffer_ += "$dumpvars\n";
    for (const Value& value : values_) write_value(value);
    buffer_ += "$end\n";
}

bool VcdWriter::stamp(Cycle cycle) {
    if (stopped_) return false;
    if (stamped_ == cycle) return true;
    if (bytes() + longest_cycle_ + room_for_the_end > limit_) {
        stopped_ = true;
        buffer_ += "$comment stopped before cycle ";
        append_number(buffer_, cycle);
        buffer_ += ": the file has reached its limit of ";
        append_number(buffer_, limit_);
        buffer_ += " bytes $end\n#";
        append_number(buffer_, cycle * units_per_cycle_);
        buffer_ += '\n';
        flush();
        return false;
    }
    if (buffer_.size() > flush_at) flush();
    stamped_ = cycle;
    buffer_ += '#';
    append_number(buffer_, cycle * units_per_cycle_);
    buffer_ += '\n';
    return true;
}

void VcdWriter::set(Signal signal, std::uint64_t value) {
    Value& v = values_[signal];
    if (v.value == value) return;
    v.value = value;
    if (begun_ && stamp(cycle_)) write_value(v);
}

void VcdWriter::write_value(const Value& v) {
    switch (v.kind) {
        case Declaration::Kind::flag:
            buffer_ += v.value ? '1' : '0';
            break;
        case Declaration::Kind::number:
            buffer_ += 'b';
            append_binary(buffer_, v.value);
            buffer_ += ' ';
            break;
        case Declaration::Kind::word:
            buffer_ += 's';
            buffer_ += v.words[v.value];
            buffer_ += ' ';
            break;
        case Declaration::Kind::ray:
            buffer_ += 's';
            if (v.value == no_ray) {
                buffer_ += '-';
            } else {
                append_number(buffer_, v.value >> 32);
                buffer_ += '/';
                append_number(buffer_, v.value & 0xffffffffU);
            }
            buffer_ += ' ';
            break;
        case Declaration::Kind::scope:
        case Declaration::Kind::end_of_scope:
            return;
    }
    buffer_ += v.code;
    buffer_ += '\n';
}

void VcdWriter::end(Cycle cycle) {
    if (!begun_) header();
    if (begun_ && !stopped_) {
        buffer_ += '#';
        append_number(buffer_, cycle * units_per_cycle_);
        buffer_ += '\n';
    }
    flush();
}

void VcdWriter::flush() {
    written_ += buffer_.size();
    std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
    buffer_.clear();
}

}  // namespace raycell
