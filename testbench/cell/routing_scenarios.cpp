#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

// Sent in 100, there in 113, tested until 117.
constexpr Cycle tested = 100 + ray_link + walk;

void add_rays(std::vector<Scenario>& all) {
    const Ray east = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    {
        Script script = empty_cell("straight", "a ray crosses an empty cell in walk_step cycles");
        script.in(100, Side::west, east_bound, ray_link, east)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::east, east_bound, ray_link, east);  // x = 0 of the next cell, as it was here
        all.push_back(script.until(200));
    }
    {
        // From (0, 0.25) along (3, 4)/5: it meets y = 1 at t = 0.9375, x = 0.5625.
        const Ray down = ray_of(RayKind::reflected, {0, 0.25, 5}, {0.6, 0.8, 0});
        Script script =
            empty_cell("turn", "a ray leaves over the side that it meets first, in its own buffer class");
        script.in(100, Side::west, east_bound, ray_link, down)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::south, east_bound, ray_link, moved_to(down, {0.5625, 0, 5}));
        all.push_back(script.until(200));
    }
    {
        const Ray west = ray_of(RayKind::refracted, {1, 0.5, 5}, {-1, 0, 0});
        Script script =
            empty_cell("opposite", "rays of both directions pass each other, tested one after the other");
        script.in(100, Side::west, east_bound, ray_link, east)
            .in(100, Side::east, west_bound, ray_link, west)
            .take(tested, Side::east, west_bound)
            .out(tested, Side::west, west_bound, ray_link, west)
            .take(tested + walk, Side::west, east_bound)
            .out(tested + walk, Side::east, east_bound, ray_link, east);
        all.push_back(script.until(200));
    }
}

void add_ends(std::vector<Scenario>& all) {
    {
        const Ray back = ray_of(RayKind::reflected, {0, 0.5, 9.5}, {0.6, 0, 0.8});
        Script script("background",
                      "a ray that leaves through the back, where nothing is, is answered with the "
                      "background");
        script.setup().scene.background = {0.25, 0.5, 1};
        script.trace(1)
            .pixel(1 + walk, {0.25, 0.5, 1})
            .in(100, Side::west, east_bound, ray_link, back)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::west, answers, intensity_link,
                 answer_for(back, Answer::Kind::intensity, {0.25, 0.5, 1}));
        all.push_back(script.until(200));
    }
    {
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 0.5;  // the source is in this cell
        Script script = empty_cell("lit", "a shadow ray that reaches its source is answered with a verdict");
        script.in(100, Side::west, east_bound, shadow_link, shadow)
            .take(100 + shadow_link + walk, Side::west, east_bound)
            .out(100 + shadow_link + walk, Side::west, answers, verdict_link,
                 answer_for(shadow, Answer::Kind::lit));
        all.push_back(script.until(200));
    }
    {
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 2.5;
        Ray passed = shadow;
        passed.reach = 1.5;  // it has come one cell nearer to the source
        Script script =
            empty_cell("shadow", "a shadow ray that passes carries the way that is left to its source");
        script.in(100, Side::west, east_bound, shadow_link, shadow)
            .take(100 + shadow_link + walk, Side::west, east_bound)
            .out(100 + shadow_link + walk, Side::east, east_bound, shadow_link, passed);
        all.push_back(script.until(200));
    }
}

void add_answers(std::vector<Scenario>& all) {
    Ray far = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    far.home_x = 2;
    far.home_y = 0;
    const Answer to_far = answer_for(far, Answer::Kind::intensity, {1, 0.5, 0.25});
    Ray above = far;
    above.home_x = 1;
    const Answer to_above = answer_for(above, Answer::Kind::blocked);
    // Sent in 100, there in 104, through the router in 105.
    constexpr Cycle routed = 100 + intensity_link + return_route;
    {
        Script script = empty_cell("return", "an answer goes along x first, then along y");
        script.in(100, Side::south, answers, intensity_link, to_far)
            .take(routed, Side::south, answers)
            .out(routed, Side::east, answers, intensity_link, to_far)
            .in(150, Side::south, answers, verdict_link, to_above)
            .take(152, Side::south, answers)
            .out(152, Side::north, answers, verdict_link, to_above);
        all.push_back(script.until(200));
    }
    {
        Script script = empty_cell("return_order",
                                   "of two answers for one output the older goes first, the other when "
                                   "the neighbour has room");
        const Answer verdict = answer_for(far, Answer::Kind::lit);
        script.in(100, Side::south, answers, intensity_link, to_far)
            .in(100, Side::west, answers, verdict_link, verdict)
            .take(102, Side::west, answers)  // there in 101
            .out(102, Side::east, answers, verdict_link, verdict)
            .free(110, Side::east, answers)
            .take(111, Side::south, answers)
            .out(111, Side::east, answers, intensity_link, to_far);
        all.push_back(script.until(200));
    }
}

}  // namespace

std::vector<Scenario> routing_scenarios() {
    std::vector<Scenario> all;
    add_rays(all);
    add_ends(all);
    add_answers(all);
    return all;
}

}  // namespace raycell
