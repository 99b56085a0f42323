#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

constexpr int setup_link = 6;     // 3 + 102 + 6 = 111 bits
constexpr int features_link = 6;  // 3 + 36 + 36 + 12 + 16 + 1 = 104 bits
constexpr int span_link = 56;     // 3 + 20 + 4 + (5 + 4 + 9 + 12) · 36 + 3 + 3 = 1113 bits
constexpr int end_link = 1;       // 3 bits

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
        // The second waits for room: the first is on the wires for 6 cycles from 8 on and is taken out in 14.
        script.in(1, Side::west, setup_link, setup)
            .take(7 + load_forward, Side::west, 0)
            .out(7 + load_forward, Side::east, setup_link, setup)
            .free(14, Side::east, 0)
            .in(9, Side::west, 1, features)
            .take(15, Side::west, 0)
            .out(15, Side::east, features_link, features)
            .free(21, Side::east, 0)
            .in(30, Side::west, end_link, end)
            .take(32, Side::west, 0)
            .out(32, Side::east, end_link, end);
        all.push_back(script.until(60));
    }
    {
        Script script("span", "a span that reaches on makes a voxel, advances by one cell and goes on");
        script.setup().scene.objects.push_back(Material());
        const LoadItem here = span_of(script.setup(), 4, {0.5, 0, 4}, {2, 0, 0}, {0, 3, 0}, 1, 1);
        LoadItem next = here;
        next.span.x = 2;
        // In the coordinates of the next cell: x here is x - 1 there.
        for (int i = 0; i < next.span.edge_count; ++i)
            next.span.edges[std::size_t(i)].c += next.span.edges[std::size_t(i)].a;
        script.in(1, Side::west, 1, here)
            .take(2 + load_voxel, Side::west, 0)
            .out(2 + load_voxel, Side::east, span_link, next);
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
            .take(8, Side::west, 0)
            .out(8, Side::east, setup_link, setup)
            .in(9, Side::west, end_link, end)
            .free(80, Side::east, 0)  // room from the next cycle on
            .take(81, Side::west, 0)
            .out(81, Side::east, end_link, end);
        all.push_back(script.until(120));
    }
    return all;
}

}  // namespace raycell
