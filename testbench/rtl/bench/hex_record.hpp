// Golden vectors from the files for $readmemh, and from the head what names the fields of a message. Needs
// nothing of the model: a bench around any RTL cell can use it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rtl {

enum class What { in, free, phase, drain, out, take, pixel, end = 15 };

struct Line {
    std::uint64_t cycle = 0;
    What what = What::end;
    int side = 0;
    int index = 0;  ///< buffer class; of a phase 1 precast, 2 trace; of drain 0 or 1
    std::uint32_t link = 0;
    int bits = 0;
    std::string message;   ///< digits, the first bit sent on the left
    std::uint64_t id = 0;  ///< of the ray; no wire carries it, the text beside the digits does
};

/// Bits of a message, from its left.
std::uint64_t bits_of(const std::string& digits, int first, int count);

using Layout = std::vector<std::pair<std::string, int>>;  ///< fields and their bits, the first sent first

struct HexRecord {
    std::string name;
    int x = 0;
    int y = 0;
    std::map<std::string, Layout> layouts;  ///< ray, shadow_ray, intensity, verdict
    std::vector<Line> in;
    std::vector<Line> out;
    std::uint64_t last = 0;

    /// The first field in which two messages differ: "field 'dx' is 5, expected 7"; empty if none does.
    std::string difference(const std::string& is, const std::string& expected, bool load) const;
    std::string kind(const std::string& digits) const;
};

/// `path`: NAME.txt; NAME.in.hex and NAME.out.hex are beside it. Throws std::runtime_error naming the file.
HexRecord read_record(const std::string& path);

}  // namespace rtl
