#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

const Ray arriving = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});

// Sent in 100, there in 113, tested until 131: it hits and takes a slot. The shading unit sets it up until
// 182.
constexpr Cycle hit = sent + ray_link + walk + compare;
constexpr Cycle child_sent = hit + set_up + reflect;
// The child is tested in its own cell. It can't hit the polygon that it leaves, so only its depth run is
// compared.
constexpr Cycle child_tested = child_sent + walk + compare_run;

Ray child_of_arriving() {
    Ray child = ray_of(RayKind::reflected, {0.75, 0.5, 5}, {-1, 0, 0});
    child.home_x = 1;
    child.slot = 0;
    child.generation = 2;
    child.leaves = 0;
    child.leaves_front = false;
    return child;
}

/// The ray comes in and its child goes out.
Script with_child(const std::string& name, const std::string& says) {
    Script script = mirrored_cell(name, says);
    script.in(sent, Side::west, east_bound, ray_link, arriving)
        .take(hit, Side::west, east_bound)
        .out(child_tested, Side::west, west_bound, ray_link, moved_to(child_of_arriving(), {1, 0.5, 5}));
    return script;
}

}  // namespace

std::vector<Scenario> hit_scenarios() {
    std::vector<Scenario> all;
    all.push_back(with_child("hit", "a ray hits a mirror, takes a slot and sends its child")
                      .until(child_tested + 1000));
    {
        const Answer child = answer_for(child_of_arriving(), Answer::Kind::intensity, {0.5, 0.25, 1});
        constexpr Cycle answered = child_tested + 100;
        constexpr Cycle home = answered + intensity_link + return_route;
        Script script =
            with_child("hit_returns", "when the child's answer is home, the hit is shaded and answered");
        script.in(answered, Side::west, answers, intensity_link, child)
            .take(home, Side::west, answers)
            .out(home + shade, Side::west, answers, intensity_link,
                 answer_for(arriving, Answer::Kind::intensity, {0.5, 0.25, 1}));
        all.push_back(script.until(home + shade + 1000));
    }
    {
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 2;
        constexpr Cycle blocked = sent + shadow_link + walk + compare;
        Script script = mirrored_cell("blocked", "a shadow ray that hits is answered with a verdict");
        script.in(sent, Side::west, east_bound, shadow_link, shadow)
            .take(blocked, Side::west, east_bound)
            .out(blocked, Side::west, answers, verdict_link, answer_for(shadow, Answer::Kind::blocked));
        all.push_back(script.until(sent + 1000));
    }
    {
        Ray above = arriving;
        above.position.z = 0.5;
        Script script = mirrored_cell("passes_in_front",
                                      "a ray in front of a voxel's depth run is only compared with it");
        script.in(sent, Side::west, east_bound, ray_link, above)
            .take(sent + ray_link + walk + compare_run, Side::west, east_bound)
            .out(sent + ray_link + walk + compare_run, Side::east, east_bound, ray_link, above);
        all.push_back(script.until(sent + 1000));
    }
    {
        // Ambient light is a tenth of Kd · colour: 0.1 · 1 · 2.5.
        Material glowing;
        glowing.colour = dvec3(2.5);
        glowing.diffuse = 1;
        Script script("own_pixel",
                      "a hit that waits for nothing goes straight through the shading unit, here for the "
                      "cell's own pixel");
        constexpr Cycle one_edge = compare - 2;  // the other lies on the cell's border
        script.setup().scene.objects.push_back(glowing);
        script.in(1, Side::west, 1, span_of(script.setup(), 0, {1, 0, 4}, {0.9, 0, 0}, {0, 3, 0}, 1, 1))
            .take(2 + load_advance, Side::west, 0)
            .trace(walled_trace)
            .pixel(walled_trace + walk + one_edge + set_up + shade, dvec3(0.25));
        all.push_back(script.until(sent + 1000));
    }
    return all;
}

}  // namespace raycell
