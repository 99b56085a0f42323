#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

// Both are children of slot 0 of cell (0, 1): with M = 1 there is no other.
Ray first_ray() {
    Ray ray = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    ray.slot = 0;
    return ray;
}
const Ray first = first_ray();

Ray second_ray() {
    Ray ray = ray_of(RayKind::refracted, {0, 0.25, 6}, {1, 0, 0});
    ray.slot = 0;
    ray.child = 1;
    return ray;
}

Ray child_of_first() {
    Ray child = ray_of(RayKind::reflected, {0.75, 0.5, 5}, {-1, 0, 0});
    child.home_x = 1;
    child.slot = 0;
    child.generation = 2;
    child.leaves = 0;
    return child;
}

// With M = 1 a slot number has 1 bit instead of 4, so a ray has 239 bits.
constexpr int short_ray_link = 12;
constexpr Cycle hit = sent + short_ray_link + walk + compare;
constexpr Cycle child_sent = hit + set_up + reflect;
constexpr Cycle child_tested = child_sent + walk + compare_run;
// The second is tested while the first is set up.
constexpr Cycle second_hit = hit + 1 + short_ray_link + walk + compare;
static_assert(second_hit < child_sent);
/// By now both are where they wait.
constexpr Cycle settled = child_tested + 100;

/// M = 1. A ray hits and waits for its child; another one comes in behind it and hits too.
Script full_store(const std::string& name, const std::string& says, Recovery recovery) {
    Script script = mirrored_cell(name, says);
    script.setup().machine.ray_store = 1;
    script.setup().machine.recovery = recovery;
    script.in(sent, Side::west, east_bound, short_ray_link, first)
        .take(hit, Side::west, east_bound)
        .out(child_tested, Side::west, west_bound, short_ray_link, moved_to(child_of_first(), {1, 0.5, 5}))
        .in(hit + 1, Side::west, east_bound, short_ray_link, second_ray());
    return script;
}

void add_full_stores(std::vector<Scenario>& all) {
    {
        Script script = full_store("full_store", "a ray that finds no slot is destroyed, its parent is told",
                                   Recovery::postpone);
        script.take(second_hit, Side::west, east_bound)
            .out(second_hit, Side::west, answers, verdict_link,
                 answer_for(second_ray(), Answer::Kind::postponed));
        all.push_back(script.until(settled + 3000));
    }
    {
        Script script = full_store("full_store_waits",
                                   "without recovery a ray that finds no slot waits in its buffer "
                                   "until one is free",
                                   Recovery::none);
        const Answer child = answer_for(child_of_first(), Answer::Kind::intensity, {0.5, 0.25, 1});
        constexpr Cycle home = settled + intensity_link + return_route;
        constexpr Cycle answered = home + shade;
        Ray child_of_second = child_of_first();
        child_of_second.position = {1, 0.25, 6};
        // The slot is free in the cycle in which the first ray's answer leaves.
        script.in(settled, Side::west, answers, intensity_link, child)
            .take(home, Side::west, answers)
            .out(answered, Side::west, answers, intensity_link,
                 answer_for(first, Answer::Kind::intensity, {0.5, 0.25, 1}))
            .take(answered, Side::west, east_bound)
            .free(child_tested + short_ray_link, Side::west, west_bound)
            .out(answered + set_up + reflect + walk + compare_run, Side::west, west_bound, short_ray_link,
                 child_of_second);
        all.push_back(script.until(settled + 3000));
    }
}

}  // namespace

std::vector<Scenario> waiting_scenarios() {
    std::vector<Scenario> all;
    {
        constexpr Cycle tested = sent + ray_link + walk;
        Script script =
            empty_cell("back_pressure", "a ray stays in its buffer until the neighbour has room again");
        script.in(sent, Side::west, east_bound, ray_link, first)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::east, east_bound, ray_link, first)
            .in(tested + 1, Side::west, east_bound, ray_link, second_ray())
            .free(sent + 200, Side::east, east_bound)  // room from the next cycle on
            .take(sent + 201, Side::west, east_bound)
            .out(sent + 201, Side::east, east_bound, ray_link, second_ray());
        all.push_back(script.until(settled + 3000));
    }
    {
        constexpr Cycle tested = sent + ray_link + walk;
        Script script = empty_cell("busy_wires",
                                   "one set of wires serves all classes: an answer waits for the ray that "
                                   "is on them");
        script.setup().machine.buffer_depth = 2;
        Ray far = first;
        far.home_x = 2;
        const Answer answer = answer_for(far, Answer::Kind::lit);
        script.in(sent, Side::west, east_bound, ray_link, first)
            .take(tested, Side::west, east_bound)
            .out(tested, Side::east, east_bound, ray_link, first)
            .in(tested, Side::south, answers, verdict_link, answer)
            .take(tested + ray_link, Side::south, answers)
            .out(tested + ray_link, Side::east, answers, verdict_link, answer);
        all.push_back(script.until(sent + 1000));
    }
    add_full_stores(all);
    {
        Script script = full_store("back_off",
                                   "a child whose parent is told that it was destroyed is sent again after a "
                                   "back-off, the second time after one of twice that",
                                   Recovery::postpone);
        script.take(second_hit, Side::west, east_bound)
            .out(second_hit, Side::west, answers, verdict_link,
                 answer_for(second_ray(), Answer::Kind::postponed))
            .free(child_tested + short_ray_link, Side::west, west_bound);
        constexpr Cycle home = settled + verdict_link + return_route;
        constexpr Cycle sent_again = home + back_off(ray_of_script, 0) + walk + compare_run;
        constexpr Cycle second_home = sent_again + sent + verdict_link + return_route;
        const Answer notice = answer_for(child_of_first(), Answer::Kind::postponed);
        const Ray child = moved_to(child_of_first(), {1, 0.5, 5});
        script.in(settled, Side::west, answers, verdict_link, notice)
            .take(home, Side::west, answers)
            .out(sent_again, Side::west, west_bound, short_ray_link, child)
            .free(sent_again + short_ray_link, Side::west, west_bound)
            .in(sent_again + 100, Side::west, answers, verdict_link, notice)
            .take(second_home, Side::west, answers)
            .out(second_home + back_off(ray_of_script, 1) + walk + compare_run, Side::west, west_bound,
                 short_ray_link, child);
        all.push_back(script.until(second_home + 500));
    }
    return all;
}

}  // namespace raycell
