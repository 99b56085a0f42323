#include "testbench/rtl/bench/hex_record.hpp"

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rtl {
namespace {

constexpr int type_bits = 3;
constexpr std::array<const char*, 6> types{"ray", "shadow_ray", "intensity", "lit", "blocked", "postponed"};

std::ifstream opened(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + ": can't be read; expected a file of 'raycell render --golden'");
    return in;
}

/// "CYCLE_WHAT_SIDE_CLASS_LINK_BITS_MESSAGE", all hexadecimal.
Line line_of(const std::string& text, const std::string& path) {
    std::array<std::string, 7> parts;
    std::istringstream in(text);
    for (std::string& part : parts) {
        if (!std::getline(in, part, '_'))
            throw std::runtime_error(path + ": '" + text.substr(0, 60) +
                                     "': expected seven fields with _ between");
    }
    const auto number = [](const std::string& digits) { return std::strtoull(digits.c_str(), nullptr, 16); };
    return {number(parts[0]),
            What(number(parts[1])),
            int(number(parts[2])),
            int(number(parts[3])),
            std::uint32_t(number(parts[4])),
            int(number(parts[5])),
            parts[6],
            0};
}

std::vector<Line> lines_of(const std::string& path, std::uint64_t& last) {
    std::ifstream in = opened(path);
    std::vector<Line> lines;
    for (std::string text; std::getline(in, text);) {
        if (text.empty() || text[0] == '/') continue;
        lines.push_back(line_of(text, path));
    }
    if (lines.empty() || lines.back().what != What::end)
        throw std::runtime_error(path + ": it has no last line; the record is not whole");
    last = lines.back().cycle;
    lines.pop_back();
    return lines;
}

void read_head(HexRecord& record, const std::string& path) {
    std::ifstream in = opened(path);
    for (std::string text; std::getline(in, text) && text != "begin";) {
        std::istringstream words(text);
        std::string key, name, field;
        words >> key;
        if (key == "cell") words >> record.x >> record.y;
        if (key != "layout") continue;
        words >> name;
        while (words >> field) {
            const auto colon = field.rfind(':');
            record.layouts[name].emplace_back(field.substr(0, colon), std::atoi(field.c_str() + colon + 1));
        }
    }
}

/// The ids of the messages that come in, from the remarks of the text: "... ; pixel 250 branch 0 kind
/// primary".
void read_ids(HexRecord& record, const std::string& path) {
    std::ifstream in = opened(path);
    std::string text;
    while (std::getline(in, text) && text != "begin") {
    }
    std::size_t next = 0;
    while (std::getline(in, text)) {
        if (text.find(" in ") == std::string::npos) continue;
        while (next < record.in.size() && record.in[next].what != What::in) ++next;
        if (next == record.in.size()) return;
        Line& line = record.in[next++];
        const auto remark = text.find("; pixel ");
        if (remark == std::string::npos) continue;
        std::istringstream words(text.substr(remark + 2));
        std::string name;
        std::uint64_t pixel = 0, branch = 0;
        if (words >> name >> pixel >> name >> branch) line.id = pixel << 32 | branch;
    }
}

}  // namespace

std::uint64_t bits_of(const std::string& digits, int first, int count) {
    std::uint64_t value = 0;
    for (int i = first; i < first + count; ++i) {
        const char digit = std::size_t(i / 4) < digits.size() ? digits[std::size_t(i / 4)] : '0';
        const int nibble = digit <= '9' ? digit - '0' : digit - 'a' + 10;
        value = value << 1 | unsigned(nibble >> (3 - i % 4) & 1);
    }
    return value;
}

std::string HexRecord::kind(const std::string& digits) const {
    const std::uint64_t type = bits_of(digits, 0, type_bits);
    return type < types.size() ? types[type] : "type " + std::to_string(type);
}

std::string HexRecord::difference(const std::string& is, const std::string& expected, bool load) const {
    if (is == expected) return "";
    if (load) return "bits are " + is + ", expected " + expected;
    const std::string own = kind(is);
    const std::string other = kind(expected);
    if (own != other) return "it is '" + own + "', expected '" + other + "'";
    const bool verdict = own == "lit" || own == "blocked" || own == "postponed";
    const auto layout = layouts.find(verdict ? "verdict" : own);
    if (layout != layouts.end()) {
        int at = 0;
        for (const auto& [field, bits] : layout->second) {
            const std::uint64_t a = bits_of(is, at, bits);
            const std::uint64_t b = bits_of(expected, at, bits);
            if (a != b)
                return "field '" + field + "' is " + std::to_string(a) + ", expected " + std::to_string(b);
            at += bits;
        }
    }
    return "bits are " + is + ", expected " + expected;
}

HexRecord read_record(const std::string& path) {
    const std::string suffix = ".txt";
    if (path.size() <= suffix.size() || path.substr(path.size() - suffix.size()) != suffix)
        throw std::runtime_error(
            path + ": expected golden vectors, NAME.txt with NAME.in.hex and NAME.out.hex beside it");
    const std::string stem = path.substr(0, path.size() - suffix.size());
    HexRecord record;
    record.name = path;
    read_head(record, path);
    std::uint64_t last = 0;
    record.in = lines_of(stem + ".in.hex", record.last);
    read_ids(record, path);
    record.out = lines_of(stem + ".out.hex", last);
    return record;
}

}  // namespace rtl
