#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

constexpr int setup_link = 11;    // 3 + 103 + 6 + 60 + 16 + 22 + 7 = 217 bits, no source
constexpr int features_link = 6;  // 3 + 36 + 36 + 12 + 16 + 1 = 104 bits
constexpr int span_link = 36;     // 3 + 20 + 4 + 3 + (4 + 9 + 2 · 3) · 36 + 3 = 717 bits, two edges
constexpr int end_link = 1;       // 3 bits

/// When the first message, sent in 1, is passed on.
constexpr Cycle passed = 1 + setup_link + load_forward;

}  // namespace

std::vector<Scenario> loading_scenarios() {
    std::vector<Scenario> all;
    {
        Script script("broadcast",
                      "a broadcast load message is latched and passed on after load_forward cycles");
        script.setup().scene.objects.push_back(Material());
        const LoadItem setup = load_item(LoadItem::Kind::setup);
        const LoadItem features = load_item(LoadItem::Kind::features, 0);
        const LoadItem end = load_item(LoadItem::Kind::end_of_scene);
        // The second waits for room: the first is taken out of the far buffer when it is there.
        constexpr Cycle taken = passed + setup_link;
        constexpr Cycle last = taken + 1 + features_link + 10;
        script.in(1, Side::west, setup_link, setup)
            .take(passed, Side::west, 0)
            .out(passed, Side::east, setup_link, setup)
            .free(taken, Side::east, 0)
            .in(passed + 1, Side::west, 1, features)
            .take(taken + 1, Side::west, 0)
            .out(taken + 1, Side::east, features_link, features)
            .free(taken + 1 + features_link, Side::east, 0)
            .in(last, Side::west, end_link, end)
            .take(last + end_link + load_forward, Side::west, 0)
            .out(last + end_link + load_forward, Side::east, end_link, end);
        all.push_back(script.until(last + 100));
    }
    {
        Script script("span", "a span that reaches on is kept for a voxel, advances by one cell and goes on");
        script.setup().scene.objects.push_back(Material());
        const LoadItem here = span_of(script.setup(), 4, {0.5, 0, 4}, {2, 0, 0}, {0, 3, 0}, 1, 1);
        LoadItem next = here;
        next.span.x = 2;
        // In the coordinates of the next cell: x here is x - 1 there.
        for (int i = 0; i < next.span.edge_count; ++i)
            next.span.edges[std::size_t(i)].c += next.span.edges[std::size_t(i)].a;
        script.in(1, Side::west, 1, here)
            .take(2 + load_advance, Side::west, 0)
            .out(2 + load_advance, Side::east, span_link, next);
        all.push_back(script.until(100));
    }
    {
        Script script("span_full", "a span that may not be kept yet waits until the voxel before it is made");
        script.setup().scene.objects.push_back(Material());
        script.setup().machine.load_queue = 1;
        const LoadItem first = span_of(script.setup(), 4, {0.5, 0, 4}, {1, 0, 0}, {0, 3, 0}, 1, 1);
        const LoadItem second = span_of(script.setup(), 4, {1.25, 0, 4}, {0.5, 0, 0}, {0, 3, 0}, 1, 1);
        constexpr Cycle taken = 2 + load_advance;
        script.in(1, Side::west, 1, first)
            .take(taken, Side::west, 0)
            .in(taken + 1, Side::west, 1, second)
            .take(taken + load_voxel, Side::west, 0);
        all.push_back(script.until(100));
    }
    {
        Script script("span_by", "a span for cells further east passes a cell that makes a voxel");
        script.setup().scene.objects.push_back(Material());
        script.setup().machine.load_queue = 1;
        const LoadItem here = span_of(script.setup(), 4, {1.25, 0, 4}, {0.5, 0, 0}, {0, 3, 0}, 1, 1);
        const LoadItem item = span_of(script.setup(), 4, {2.25, 0, 4}, {0.5, 0, 0}, {0, 3, 0}, 1, 1);
        constexpr Cycle taken = 2 + load_advance;
        script.in(1, Side::west, 1, here)
            .take(taken, Side::west, 0)
            .in(taken + 1, Side::west, 1, item)
            .take(taken + 2 + load_forward, Side::west, 0)
            .out(taken + 2 + load_forward, Side::east, span_link, item);
        all.push_back(script.until(100));
    }
    {
        Script script("span_passes", "a span that begins further east only passes, and is not changed");
        script.setup().scene.objects.push_back(Material());
        const LoadItem item = span_of(script.setup(), 4, {2.25, 0, 4}, {0.5, 0, 0}, {0, 3, 0}, 1, 1);
        script.in(1, Side::west, 1, item)
            .take(2 + load_forward, Side::west, 0)
            .out(2 + load_forward, Side::east, span_link, item);
        all.push_back(script.until(100));
    }
    {
        Script script("load_waits", "a load message stays where it is until the neighbour has room again");
        const LoadItem setup = load_item(LoadItem::Kind::setup);
        const LoadItem end = load_item(LoadItem::Kind::end_of_scene);
        script.in(1, Side::west, setup_link, setup)
            .take(passed, Side::west, 0)
            .out(passed, Side::east, setup_link, setup)
            .in(passed + 1, Side::west, end_link, end)
            .free(80, Side::east, 0)  // room from the next cycle on
            .take(81, Side::west, 0)
            .out(81, Side::east, end_link, end);
        all.push_back(script.until(120));
    }
    return all;
}

}  // namespace raycell
