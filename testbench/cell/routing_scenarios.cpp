#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

// Sent in 100, there in 113, tested until 117 (with the estimated costs).
constexpr Cycle tested = sent + ray_link + walk;

void add_rays(std::vector<Scenario>& all) {
    const Ray east = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    {
        Script script = empty_cell("straight", "a ray crosses an empty cell in walk_step cycles");
        script.in(sent, Side::west, east_bound, ray_link, east)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::east, east_bound, ray_link, east);  // x = 0 of the next cell, as it was here
        all.push_back(script.until(sent + 1000));
    }
    {
        // From (0, 0.5) it meets y = 1 at t = 1, x = 0.25, where z is dz further.
        const Ray down = ray_of(RayKind::reflected, {0, 0.5, 5}, {0.25, 0.5, 0.829});
        Script script =
            empty_cell("turn", "a ray leaves over the side that it meets first, in its own buffer class");
        script.in(sent, Side::west, east_bound, ray_link, down)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::south, east_bound, ray_link, moved_to(down, {0.25, 0, 5 + down.direction.z}));
        all.push_back(script.until(sent + 1000));
    }
    {
        const Ray west = ray_of(RayKind::refracted, {1, 0.5, 5}, {-1, 0, 0});
        Script script =
            empty_cell("opposite", "rays of both directions pass each other, tested one after the other");
        script.in(sent, Side::west, east_bound, ray_link, east)
            .in(sent, Side::east, west_bound, ray_link, west)
            .take(tested, Side::east, west_bound)
            .out(tested, Side::west, west_bound, ray_link, west)
            .take(tested + walk, Side::west, east_bound)
            .out(tested + walk, Side::east, east_bound, ray_link, east);
        all.push_back(script.until(sent + 1000));
    }
}

void add_ends(std::vector<Scenario>& all) {
    {
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 0.5;  // the source is in this cell
        Script script = empty_cell("lit", "a shadow ray that reaches its source is answered with a verdict");
        script.in(sent, Side::west, east_bound, shadow_link, shadow)
            .take(sent + shadow_link + walk, Side::west, east_bound)
            .out(sent + shadow_link + walk, Side::west, answers, verdict_link,
                 answer_for(shadow, Answer::Kind::lit));
        all.push_back(script.until(sent + 1000));
    }
    {
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 2.5;
        Ray passed = shadow;
        passed.reach = 1.5;  // it has come one cell nearer to the source
        Script script =
            empty_cell("shadow", "a shadow ray that passes carries the way that is left to its source");
        script.in(sent, Side::west, east_bound, shadow_link, shadow)
            .take(sent + shadow_link + walk, Side::west, east_bound)
            .out(sent + shadow_link + walk, Side::east, east_bound, shadow_link, passed);
        all.push_back(script.until(sent + 1000));
    }
}

/// A ray that leaves through the front (`back`: the back) at t = 0.5, at (0.75, dy / 2), and then meets x = 1
/// at t = 0.5 more. dy is an even word, so that all this is exact.
Ray leaving(bool back) {
    constexpr double dy = 185364.0 / 262144;  // about the root of 1/2
    return ray_of(RayKind::reflected, {0.5, 0, back ? 9.75 : 0.25}, {0.5, dy, back ? 0.5 : -0.5});
}

/// The own ray behind the cube, on its way to the border.
Ray own_outside() {
    Ray ray = ray_of(RayKind::primary, {0.5, 0.5, 10}, {0, 0, 1});
    ray.home_x = 1;
    ray.home_y = 1;
    ray.slot = 0;
    ray.generation = 0;
    ray.outside = true;
    return ray;
}

void add_exits(std::vector<Scenario>& all) {
    for (const bool back : {false, true}) {
        const Ray ray = leaving(back);
        const std::string face = back ? "back" : "front";
        {
            Script script(face + "_nothing", "a ray that leaves through the " + face +
                                                 ", where nothing is, is answered with the background");
            script.setup().scene.background = {0.25, 0.5, 1};
            script.trace(1)
                .pixel(1 + walk, {0.25, 0.5, 1})
                .in(sent, Side::north, east_bound, ray_link, ray)
                .take(tested, Side::north, east_bound)
                .out(tested, Side::west, answers, intensity_link,
                     answer_for(ray, Answer::Kind::intensity, {0.25, 0.5, 1}));
            all.push_back(script.until(sent + 1000));
        }
        {
            Script script(face + "_outside", "a ray that leaves through the " + face +
                                                 ", where something is, is tested once more and goes on "
                                                 "outside the cube");
            script.setup().picture.exterior = ExteriorMode::host;
            script.setup().scene.beyond[std::size_t(back ? face_back : face_front)] = true;
            Ray outside = moved_to(ray, {0, ray.direction.y, back ? 10.25 : -0.25});
            outside.outside = true;
            // With something behind the back the own ray goes there too: straight, so always to the east.
            if (!back) script.trace(1).pixel(1 + walk, black);
            script.in(sent, Side::north, east_bound, ray_link, ray)
                .take(tested + walk, Side::north, east_bound)
                .out(tested + walk, Side::east, east_bound, ray_link, outside);
            if (back) {
                script.trace(1).out(1 + 2 * walk, Side::east, east_bound, ray_link, own_outside());
                script.free(1 + 2 * walk + ray_link, Side::east, east_bound);
            }
            all.push_back(script.until(sent + 1000));
        }
    }
}

/// A ray whose z at the side is exactly that of a face of the cube: it does not leave.
void add_reached_faces(std::vector<Scenario>& all) {
    for (const bool back : {false, true}) {
        // From (0.5, 0.5) it meets x = 1 at t = 1, y = 0.75, where z is dz further.
        const double dz = ray_of(RayKind::reflected, {}, {0.5, 0.25, back ? 0.829 : -0.829}).direction.z;
        const double z = back ? 10 : 0;
        const Ray ray = ray_of(RayKind::reflected, {0.5, 0.5, z - dz}, {0.5, 0.25, dz});
        const std::string face = back ? "back" : "front";
        Script script = empty_cell(face + "_reached", "a ray that just reaches the " + face +
                                                          " where it meets a side goes on over the side");
        script.in(sent, Side::north, east_bound, ray_link, ray)
            .take(tested, Side::north, east_bound)
            .out(tested, Side::east, east_bound, ray_link, moved_to(ray, {0, 0.75, z}));
        all.push_back(script.until(sent + 1000));
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
    constexpr Cycle routed = sent + intensity_link + return_route;
    {
        Script script = empty_cell("return", "an answer goes along x first, then along y");
        script.in(sent, Side::south, answers, intensity_link, to_far)
            .take(routed, Side::south, answers)
            .out(routed, Side::east, answers, intensity_link, to_far)
            .in(sent + 50, Side::south, answers, verdict_link, to_above)
            .take(sent + 50 + verdict_link + return_route, Side::south, answers)
            .out(sent + 50 + verdict_link + return_route, Side::north, answers, verdict_link, to_above);
        all.push_back(script.until(sent + 1000));
    }
    {
        Script script = empty_cell("return_order",
                                   "of two answers for one output the older goes first, the other when "
                                   "the neighbour has room");
        const Answer verdict = answer_for(far, Answer::Kind::lit);
        script.in(sent, Side::south, answers, intensity_link, to_far)
            .in(sent, Side::west, answers, verdict_link, verdict)
            .take(sent + verdict_link + return_route, Side::west, answers)
            .out(sent + verdict_link + return_route, Side::east, answers, verdict_link, verdict)
            .free(sent + 10, Side::east, answers)
            .take(sent + 11, Side::south, answers)
            .out(sent + 11, Side::east, answers, intensity_link, to_far);
        all.push_back(script.until(sent + 1000));
    }
}

}  // namespace

std::vector<Scenario> routing_scenarios() {
    std::vector<Scenario> all;
    add_rays(all);
    add_ends(all);
    add_exits(all);
    add_reached_faces(all);
    add_answers(all);
    return all;
}

}  // namespace raycell
