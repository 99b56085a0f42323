#include "cells/environment.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "cells/channels/link.hpp"
#include "model/machine/stall.hpp"

namespace raycell {

void Environment::stall(Link& link, const std::string& name) const {
    if (!(machine.stall > 0)) return;
    std::uint64_t who = 0;
    for (const char c : name) who = mix_bits(who, std::uint64_t(c));
    link.set_stall(machine.stall, machine.seed, who);
}

void join(Counters& sum, const Counters& other) {
    // All but the last are sums of words, so that none can be forgotten here.
    static_assert(std::is_trivially_copyable_v<Counters> && sizeof(Counters) % sizeof(std::uint64_t) == 0);
    constexpr std::size_t words = sizeof(Counters) / sizeof(std::uint64_t);
    static_assert(offsetof(Counters, last_progress) == (words - 1) * sizeof(std::uint64_t));
    std::uint64_t a[words];
    std::uint64_t b[words];
    std::memcpy(a, &sum, sizeof sum);
    std::memcpy(b, &other, sizeof other);
    for (std::size_t i = 0; i + 1 < words; ++i) a[i] += b[i];
    a[words - 1] = std::max(a[words - 1], b[words - 1]);
    std::memcpy(static_cast<void*>(&sum), a, sizeof sum);
}

int Environment::load_bits(const LoadItem& item) const {
    switch (item.kind) {
        case LoadItem::Kind::setup:
            return bits.setup(context.scene.sources.size());
        case LoadItem::Kind::features:
            return bits.features;
        case LoadItem::Kind::polygon:
            return int(item.polygon.vertices.size()) * bits.vertex + bits.polygon;
        case LoadItem::Kind::trapeze:
            return bits.trapeze;
        case LoadItem::Kind::span:
            return bits.span;
        case LoadItem::Kind::end_of_scene:
            break;
    }
    return bits.end_of_scene;
}

}  // namespace raycell
