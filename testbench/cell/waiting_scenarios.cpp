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

/// The own ray of cell (1, 1), whose pixel is number 4 of the picture.
Ray own_ray(const dvec3& position, const dvec3& direction) {
    Ray ray = ray_of(RayKind::primary, position, direction);
    ray.home_x = ray.home_y = 1;
    ray.slot = 0;
    ray.generation = 0;
    ray.id = std::uint64_t(4) << 32U;
    return ray;
}

void add_own_rays(std::vector<Scenario>& all) {
    {
        Script script("own_postponed",
                      "an own ray that is postponed again and again waits twice as long each time, at last "
                      "64 times as long");
        // From the middle of the cell it meets x = 1 at t = 1, where z is dz further. The word of dz is the
        // root of 3/4 but for one last bit, which the iteration for 1/sqrt leaves.
        const dvec3 direction{0.5, 0, 227024.0 / 262144};
        script.setup().picture.viewer = ViewerMode::scene;
        script.setup().scene.frame.viewer_at_infinity = false;
        script.setup().scene.frame.eye = dvec3(1.5, 1.5, 0) - 2.0 * direction;
        const Ray from = own_ray({0.5, 0.5, 0}, direction);
        const Ray ray = moved_to(from, {0, 0.5, from.direction.z});
        script.trace(1);
        Cycle tested = 1 + walk;
        for (unsigned attempt = 0;; ++attempt) {
            script.out(tested, Side::east, east_bound, ray_link, ray)
                .free(tested + ray_link, Side::east, east_bound);
            const Cycle answered = tested + 100;
            if (attempt == 8) {
                const Answer seen = answer_for(ray, Answer::Kind::intensity, {0.5, 0.25, 1});
                const Cycle home = answered + intensity_link + return_route;
                script.in(answered, Side::east, answers, intensity_link, seen)
                    .take(home, Side::east, answers)
                    .pixel(home, {0.5, 0.25, 1});
                break;
            }
            const Cycle home = answered + verdict_link + return_route;
            script.in(answered, Side::east, answers, verdict_link, answer_for(ray, Answer::Kind::postponed))
                .take(home, Side::east, answers);
            tested = home + back_off(ray.id, attempt) + walk;
        }
        all.push_back(script.until(tested + 1000));
    }
    {
        Script script("held_back", "new rays are held back, then the own ray is sent at once");
        constexpr Cycle released = 50;
        // The answer that passes in that cycle wakes the model's cell, which else would go on one cycle
        // later.
        const Answer passing = answer_for(first, Answer::Kind::lit);
        script.trace(1)
            .drain(1, true)
            .drain(released, false)
            .in(released - return_route - verdict_link, Side::east, answers, verdict_link, passing)
            .take(released, Side::east, answers)
            .out(released, Side::west, answers, verdict_link, passing)
            .pixel(released + walk, black);
        all.push_back(script.until(sent + 1000));
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
    add_own_rays(all);
    return all;
}

}  // namespace raycell
