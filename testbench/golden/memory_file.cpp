#include "testbench/golden/memory_file.hpp"

#include <cstdio>
#include <cstdlib>

namespace raycell {
namespace {

// Codes of what happens; docs/reference/cell_tb.md has them.
constexpr unsigned end_code = 15;

unsigned code_of(GoldenEvent::What what) {
    switch (what) {
        case GoldenEvent::What::in:
            return 0;
        case GoldenEvent::What::free:
            return 1;
        case GoldenEvent::What::phase:
            return 2;
        case GoldenEvent::What::drain:
            return 3;
        case GoldenEvent::What::out:
            return 4;
        case GoldenEvent::What::take:
            return 5;
        case GoldenEvent::What::pixel:
            return 6;
    }
    return end_code;
}

/// The class; for a phase and drain, what they say.
unsigned index_of(const GoldenEvent& event) {
    if (event.what == GoldenEvent::What::phase) return event.tokens.at(0) == "precast" ? 1 : 2;
    if (event.what == GoldenEvent::What::drain) return event.tokens.at(0) == "1";
    return unsigned(event.index);
}

}  // namespace

std::string MemoryText::first_line() const {
    const int digits = (widest_ + 3) / 4;
    return "// raycell-golden 2: cycle 48 bits, what 4, side 4, class 4, link 32, bits 16, message " +
           std::to_string(4 * digits) + "\n";
}

std::string MemoryText::line(const GoldenEvent& event) const {
    std::string digits = event.bits;
    int bits = event.bit_count;
    if (event.what == GoldenEvent::What::pixel) {
        WireBits colour;
        for (const std::string& word : event.tokens)
            colour.put_signed(std::strtoll(word.c_str(), nullptr, 10), formats_.word_bits);
        digits = colour.hex();
        bits = colour.size();
    }
    return line(event.cycle, code_of(event.what), unsigned(event.side), index_of(event),
                unsigned(event.cycles), unsigned(bits), digits);
}

std::string MemoryText::last_line(Cycle last) const { return line(last, end_code, 0, 0, 0, 0, ""); }

std::string MemoryText::line(Cycle cycle, unsigned what, unsigned side, unsigned index, unsigned link,
                             unsigned bits, std::string digits) const {
    char front[64];
    std::snprintf(front, sizeof front, "%012llx_%x_%x_%x_%08x_%04x_", static_cast<unsigned long long>(cycle),
                  what, side, index, link, bits);
    digits.resize(std::size_t((widest_ + 3) / 4), '0');
    return front + digits + "\n";
}

MemoryFiles memory_files(const MemoryText& text, const std::vector<GoldenEvent>& events, Cycle last) {
    MemoryFiles files{text.first_line(), text.first_line()};
    for (const GoldenEvent& event : events) (event.expected() ? files.out : files.in) += text.line(event);
    files.in += text.last_line(last);
    files.out += text.last_line(last);
    return files;
}

}  // namespace raycell
