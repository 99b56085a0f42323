// A message as the links carry it: a pointer to its content, owned by the current holder.
#pragma once

#include "cells/channels/stall.hpp"
#include "cells/memory/pool.hpp"
#include "model/loading/span.hpp"
#include "model/machine/message.hpp"
#include "model/machine/need.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// A ray and what its current cell already knows about it.
struct RayPacket {
    enum class Stage : std::uint8_t { untested, in_test, decided };
    Ray ray;
    Visit visit;
    Stage stage = Stage::untested;
    Need need;                  ///< set by the test
    std::uint32_t hops = 0;     ///< since it was launched
    std::uint64_t decided = 0;  ///< cycle in which its test ended
    Wait wait;
    std::uint64_t launched = 0;  ///< cycle of its launch
};
static_assert(sizeof(RayPacket) == 3 * 64);  // three cache lines: every hop moves them all

/// A load message. Geometry sends polygons; precomputation sends for each what its trapezes share, then the
/// trapezes; both travel down the column of distributors. Spans travel in the rows. All other kinds are
/// broadcast.
struct LoadItem {
    enum class Kind : std::uint8_t { setup, features, polygon, surface, trapeze, span, end_of_scene };
    Kind kind = Kind::end_of_scene;
    std::uint32_t object = 0;  ///< features
    Polygon polygon;
    Span span;
    Trapeze trapeze;  ///< of a surface its first part alone
    CornerIntensities intensities{};
};

inline const char* name_of(LoadItem::Kind kind) {
    constexpr const char* names[] = {
        "sources and viewer", "features", "polygon", "surface", "trapeze", "span", "end of scene"};
    return names[std::size_t(kind)];
}

struct Message {
    enum class Kind : std::uint8_t { none, ray, answer, load };
    Kind kind = Kind::none;
    union {
        RayPacket* ray;
        Answer* answer;
        LoadItem* load;
    };
    Message() : ray(nullptr) {}
    explicit Message(RayPacket* r) : kind(Kind::ray), ray(r) {}
    explicit Message(Answer* a) : kind(Kind::answer), answer(a) {}
    explicit Message(LoadItem* l) : kind(Kind::load), load(l) {}
};

struct MessagePools {
    Pool<RayPacket> rays;
    Pool<Answer> answers;
    Pool<LoadItem> loads;
};

}  // namespace raycell
