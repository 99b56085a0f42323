// What a check found wrong: how often, and the first cases in words.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycell::loading {

struct Faults {
    static constexpr std::size_t most_shown = 5;
    std::uint64_t count = 0;
    std::vector<std::string> first;

    void add(const std::string& what) {
        ++count;
        if (first.size() < most_shown) first.push_back(what);
    }
};

}  // namespace raycell::loading
