#include "testbench/rtl/bench/verilated_cell.hpp"

#ifdef RTL_FAULTS
#ifdef RTL_WHOLE
#include "Vwhole_cell_raycell_numbers.h"
#else
#include "Vempty_cell_raycell_numbers.h"
#endif
#endif

namespace rtl {
namespace {

constexpr int word = 32;
constexpr char digits_of[] = "0123456789abcdef";

template <typename Wide>
std::uint32_t bit(const Wide& wide, int at) {
    return wide[at / word] >> (at % word) & 1;
}

/// Puts digits into `width` bits from `low` on, the first digit at the top. Both are multiples of a digit.
template <typename Wide>
void put_digits(Wide& wide, int low, int width, const std::string& digits) {
    for (int i = 0; i < width / 4; ++i) {
        const char c = std::size_t(i) < digits.size() ? digits[std::size_t(i)] : '0';
        const std::uint32_t value = c <= '9' ? std::uint32_t(c - '0') : std::uint32_t(c - 'a' + 10);
        const int at = low + width - 4 - 4 * i;
        wide[at / word] = (wide[at / word] & ~(15U << (at % word))) | value << (at % word);
    }
}

template <typename Wide>
std::string get_digits(const Wide& wide, int low, int width) {
    std::string digits(std::size_t(width / 4), '0');
    for (int i = 0; i < width / 4; ++i) {
        const int at = low + width - 4 - 4 * i;
        digits[std::size_t(i)] = digits_of[wide[at / word] >> (at % word) & 15];
    }
    return digits;
}

/// Ports of up to 64 bits as words.
template <typename Port>
void put_bits(Port& port, int low, int width, std::uint64_t value) {
    const std::uint64_t mask = ((std::uint64_t(1) << width) - 1) << low;
    port = Port((std::uint64_t(port) & ~mask) | (value << low & mask));
}

}  // namespace

#ifdef RTL_FAULTS
int fault_of_all = 0;
#endif

static_assert(message_bits % 4 == 0, "a message port is a whole number of digits");

VerilatedCell::VerilatedCell(VerilatedContext& context, int x, int y)
    : top_(std::make_unique<Top>(&context, "cell")) {
    top_->x = x;
    top_->y = y;
}

void VerilatedCell::reset(const std::string& viewer) {
#ifdef RTL_FAULTS
    top_->eval();  // its initial value comes first
    top_->__PVT__raycell_numbers->fault = fault_of_all;
#endif
    top_->reset = 1;
    top_->phase = 0;
    begin(0);
    clock();
    top_->reset = 0;
    if (viewer.empty()) return;
    // The first bits of the viewer's message; its sources are not needed.
    top_->preset = 1;
    for (int i = 0; i < setup_bits; ++i) {
        const std::size_t digit = std::size_t(i / 4);
        const char c = digit < viewer.size() ? viewer[digit] : '0';
        const int nibble = c <= '9' ? c - '0' : c - 'a' + 10;
        const int at = setup_bits - 1 - i;
        const std::uint32_t mask = 1U << (at % word);
        auto& part = top_->preset_viewer[at / word];
        part = (nibble >> (3 - i % 4) & 1) ? part | mask : part & ~mask;
    }
    begin(0);
    clock();
    top_->preset = 0;
    begin(0);
    for (int i = 0; i < 8; ++i) clock();  // until its primary ray is made
}

void VerilatedCell::begin(std::uint64_t now) {
    top_->now = now;
    top_->in_valid = 0;
    top_->free = 0;
    top_->phase_begins = 0;
}

void VerilatedCell::phase(int code, bool begins) {
    top_->phase = code;
    top_->phase_begins = begins;
}

void VerilatedCell::in(int side, int index, std::uint32_t cycles, const std::string& message,
                       std::uint64_t id) {
    top_->in_valid |= 1 << side;
    put_bits(top_->in_class, side * class_bits, class_bits, std::uint64_t(index));
    for (int i = 0; i < 16; ++i) {
        const int at = side * 16 + i;
        const std::uint32_t mask = 1U << (at % word);
        auto& part = top_->in_cycles[at / word];
        part = (cycles >> i & 1) ? part | mask : part & ~mask;
    }
    put_digits(top_->in_message, side * message_bits, message_bits, message);
    top_->in_id[2 * side] = std::uint32_t(id);
    top_->in_id[2 * side + 1] = std::uint32_t(id >> 32);
}

void VerilatedCell::free(int side, int index) { top_->free |= 1 << (side * classes + index); }

void VerilatedCell::clock() {
    top_->clock = 0;
    top_->eval();
    top_->clock = 1;
    top_->eval();
    top_->clock = 0;
#ifdef RTL_WHOLE
    for (int i = 0; i < fast_edges && (top_->computes || top_->reset || top_->preset); ++i) fast();
#endif
}

#ifdef RTL_WHOLE
void VerilatedCell::fast() {
    top_->fast_clock = 1;
    top_->eval();
    top_->fast_clock = 0;
    top_->eval();
}
#endif

Sent VerilatedCell::sent(int side) const {
    const int index = int(top_->out_class >> (side * class_bits) & ((1 << class_bits) - 1));
    const int cycles = int(std::uint64_t(top_->out_cycles) >> (side * 16) & 0xffff);
    return {index, cycles, get_digits(top_->out_message, side * message_bits, message_bits)};
}

std::string VerilatedCell::pixel_digits() const {
    std::string digits(std::size_t(message_bits / 4), '0');
    for (int i = 0; i < 3 * word_bits; ++i) {
        const int at = 3 * word_bits - 1 - i;
        std::uint32_t value = 0;
        if constexpr (3 * word_bits > 64) {
            value = bit(reinterpret_cast<const std::uint32_t*>(&top_->pixel), at);
        } else {
            value = std::uint32_t(*reinterpret_cast<const std::uint64_t*>(&top_->pixel) >> at & 1);
        }
        const std::size_t digit = std::size_t(i / 4);
        const int nibble = (digits[digit] <= '9' ? digits[digit] - '0' : digits[digit] - 'a' + 10) |
                           int(value) << (3 - i % 4);
        digits[digit] = digits_of[nibble];
    }
    return digits;
}

}  // namespace rtl
