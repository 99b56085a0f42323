// A message as the links carry it: a pointer to what travels. Owned by whoever holds it last.
#pragma once

#include "cells/channels/stall.hpp"
#include "cells/memory/pool.hpp"
#include "model/loading/span.hpp"
#include "model/machine/message.hpp"
#include "model/machine/need.hpp"
#include "model/tracing/tracing.hpp"

namespace raycell {

/// A ray and what the cell that it stands in knows about it already.
struct RayPacket {
    enum class Stage : std::uint8_t { untested, in_test, decided };
    Ray ray;
    Visit visit;
    Stage stage = Stage::untested;
    Need need;                  ///< once it has been tested
    std::uint32_t hops = 0;     ///< since it was put on its way
    std::uint64_t decided = 0;  ///< cycle in which the test was over
    Wait wait;
    std::uint64_t launched = 0;  ///< cycle in which it was put on its way
};
static_assert(sizeof(RayPacket) == 3 * 64);  // lines of memory: every hop moves them all

/// A load message: polygons from geometry, trapezes from precomputation and down the column of distributors,
/// spans in the rows; the others are broadcast.
struct LoadItem {
    enum class Kind : std::uint8_t { setup, features, polygon, trapeze, span, end_of_scene };
    Kind kind = Kind::end_of_scene;
    std::uint32_t object = 0;  ///< features
    Polygon polygon;
    Span span;
    Trapeze trapeze;
    CornerIntensities intensities{};
};

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
