// Who goes first, who next: messages that want the same output, tests in turn, overdue messages.
#include "testbench/cell/costs.hpp"

namespace raycell {

using namespace scripted;

namespace {

/// When a message of this many link cycles that starts in `sent` is through the router.
constexpr Cycle routed(int link) { return sent + Cycle(link) + return_route; }
/// The first cycle in which the neighbour's buffer has room again, if the neighbour takes at once what starts
/// in `cycle`.
constexpr Cycle room(Cycle cycle, int link) { return cycle + Cycle(link) + 1; }

/// An answer for cell (x, y).
Answer answer_to(int x, int y, Answer::Kind kind, unsigned slot) {
    Ray ray = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    ray.home_x = std::uint16_t(x);
    ray.home_y = std::uint16_t(y);
    ray.slot = slot;
    return answer_for(ray, kind, kind == Answer::Kind::intensity ? dvec3(0.5, 0.25, 1) : dvec3(0));
}

/// Three rays that arrive in one cycle, for three outputs; `units` test them, 1 or 2.
Scenario three_rays(const char* name, const char* purpose, int units) {
    Script script = empty_cell(name, purpose);
    script.setup().machine.traversal_units = units;
    const Ray from_east = ray_of(RayKind::reflected, {1, 0.5, 5}, {-1, 0, 0});
    const Ray from_south = ray_of(RayKind::reflected, {0.5, 1, 5}, {0, -1, 0});
    const Ray from_west = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    // The own ray was tested last, and its place is the last one.
    constexpr Cycle first = sent + ray_link + walk;
    const Cycle second = units > 1 ? first : first + walk;
    const Cycle third = second + walk;
    script.in(sent, Side::east, west_bound, ray_link, from_east)
        .in(sent, Side::south, east_bound, ray_link, from_south)
        .in(sent, Side::west, east_bound, ray_link, from_west)
        .take(first, Side::east, west_bound)
        .out(first, Side::west, west_bound, ray_link, from_east)
        .take(second, Side::south, east_bound)
        .out(second, Side::north, east_bound, ray_link, from_south)
        .take(third, Side::west, east_bound)
        .out(third, Side::east, east_bound, ray_link, from_west);
    return script.until(sent + 1000);
}

void add_ties(std::vector<Scenario>& all) {
    {
        Script script =
            empty_cell("answers_in_turn",
                       "of three answers that arrive in one cycle for one output that of the east "
                       "side goes first, then south, then west");
        const Answer east = answer_to(1, 0, Answer::Kind::intensity, 1);
        const Answer south = answer_to(1, 0, Answer::Kind::intensity, 2);
        const Answer west = answer_to(1, 0, Answer::Kind::intensity, 3);
        constexpr Cycle first = routed(intensity_link);
        constexpr Cycle second = room(first, intensity_link);
        constexpr Cycle third = room(second, intensity_link);
        script.in(sent, Side::west, answers, intensity_link, west)
            .in(sent, Side::south, answers, intensity_link, south)
            .in(sent, Side::east, answers, intensity_link, east)
            .take(first, Side::east, answers)
            .out(first, Side::north, answers, intensity_link, east)
            .free(second - 1, Side::north, answers)
            .take(second, Side::south, answers)
            .out(second, Side::north, answers, intensity_link, south)
            .free(third - 1, Side::north, answers)
            .take(third, Side::west, answers)
            .out(third, Side::north, answers, intensity_link, west);
        all.push_back(script.until(sent + 1000));
    }
    all.push_back(three_rays("tests_in_turn",
                             "of three rays that arrive in one cycle the one from the east is tested first, "
                             "then south, then west: the place after the last one tested comes first",
                             1));
    all.push_back(three_rays("two_units",
                             "of three rays that arrive in one cycle two are tested at the same time by two "
                             "units, the third when one is free",
                             2));
    {
        Script script =
            empty_cell("rays_in_turn",
                       "of two rays that want one output the one that was decided first goes first; "
                       "who was tested last is tested last");
        const Ray before = ray_of(RayKind::reflected, {0, 0.25, 5}, {1, 0, 0});
        const Ray west = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
        // From (0.5, 1) it meets x = 1 at t = 1, y = 0.75.
        const Ray south = ray_of(RayKind::reflected, {0.5, 1, 5}, {0.5, -0.25, 0.829});
        constexpr Cycle passed = sent + ray_link + walk;
        // Both are decided while the first of all still stands in the neighbour's buffer.
        constexpr Cycle emptied = passed + 1 + ray_link + 4 * walk;
        constexpr Cycle next = room(emptied + 1, ray_link);
        script.in(sent, Side::west, east_bound, ray_link, before)
            .take(passed, Side::west, east_bound)
            .out(passed, Side::east, east_bound, ray_link, before)
            .in(passed + 1, Side::west, east_bound, ray_link, west)
            .in(passed + 1, Side::south, east_bound, ray_link, south)
            .free(emptied, Side::east, east_bound)
            .take(emptied + 1, Side::south, east_bound)
            .out(emptied + 1, Side::east, east_bound, ray_link,
                 moved_to(south, {0, 0.75, 5 + south.direction.z}))
            .free(next - 1, Side::east, east_bound)
            .take(next, Side::west, east_bound)
            .out(next, Side::east, east_bound, ray_link, west);
        all.push_back(script.until(sent + 1000));
    }
}

void add_ray_and_answer(std::vector<Scenario>& all) {
    constexpr Cycle decided = sent + ray_link + walk;
    constexpr Cycle verdict_sent =
        decided - verdict_link - return_route;  // through the router when it is decided
    {
        Script script = empty_cell("answer_and_ray",
                                   "an answer and a ray that want the wires of one output in one cycle: the "
                                   "answer goes first, the ray when they are free");
        const Ray ray = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
        const Answer answer = answer_to(2, 1, Answer::Kind::lit, 1);
        script.in(sent, Side::west, east_bound, ray_link, ray)
            .in(verdict_sent, Side::south, answers, verdict_link, answer)
            .take(decided, Side::south, answers)
            .out(decided, Side::east, answers, verdict_link, answer)
            .take(decided + verdict_link, Side::west, east_bound)
            .out(decided + verdict_link, Side::east, east_bound, ray_link, ray);
        all.push_back(script.until(sent + 1000));
    }
    {
        Script script = empty_cell("answer_and_verdict",
                                   "an answer that passes goes before the verdict of a ray that ends here");
        Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
        shadow.reach = 0.5;
        constexpr Cycle ended = sent + shadow_link + walk;
        const Answer passing = answer_to(0, 1, Answer::Kind::lit, 5);
        constexpr Cycle next = room(ended, verdict_link);
        script.in(sent, Side::west, east_bound, shadow_link, shadow)
            .in(ended - verdict_link - return_route, Side::east, answers, verdict_link, passing)
            .take(ended, Side::east, answers)
            .out(ended, Side::west, answers, verdict_link, passing)
            .free(next - 1, Side::west, answers)
            .take(next, Side::west, east_bound)
            .out(next, Side::west, answers, verdict_link, answer_for(shadow, Answer::Kind::lit));
        all.push_back(script.until(sent + 1000));
    }
}

/// A hit's answer and two that pass want the west output in one cycle: the turn changes with each that goes.
void add_reply(std::vector<Scenario>& all) {
    const Ray arriving = ray_of(RayKind::reflected, {0, 0.5, 5}, {1, 0, 0});
    Ray child = ray_of(RayKind::reflected, {0.75, 0.5, 5}, {-1, 0, 0});
    child.home_x = 1;
    child.slot = 0;
    child.generation = 2;
    child.leaves = 0;
    constexpr Cycle hit = sent + ray_link + walk + compare;
    constexpr Cycle child_tested = hit + set_up + reflect + walk + compare_run;
    constexpr Cycle answered = child_tested + 100;
    constexpr Cycle home = answered + intensity_link + return_route;
    constexpr Cycle shaded = home + shade;
    constexpr Cycle second = room(shaded, verdict_link);
    constexpr Cycle third = room(second, intensity_link);
    const Answer from_east = answer_to(0, 1, Answer::Kind::lit, 4);
    const Answer from_south = answer_to(0, 1, Answer::Kind::lit, 5);
    Script script =
        mirrored_cell("reply_in_turn",
                      "of two answers that pass and one of the cell's own one that passes goes first, "
                      "then the cell's own, then the other");
    script.in(sent, Side::west, east_bound, ray_link, arriving)
        .take(hit, Side::west, east_bound)
        .out(child_tested, Side::west, west_bound, ray_link, moved_to(child, {1, 0.5, 5}))
        .in(answered, Side::west, answers, intensity_link,
            answer_for(child, Answer::Kind::intensity, {0.5, 0.25, 1}))
        .take(home, Side::west, answers)
        .in(shaded - verdict_link - return_route, Side::east, answers, verdict_link, from_east)
        .in(shaded - verdict_link - return_route, Side::south, answers, verdict_link, from_south)
        .take(shaded, Side::east, answers)
        .out(shaded, Side::west, answers, verdict_link, from_east)
        .free(second - 1, Side::west, answers)
        .out(second, Side::west, answers, intensity_link,
             answer_for(arriving, Answer::Kind::intensity, {0.5, 0.25, 1}))
        .free(third - 1, Side::west, answers)
        .take(third, Side::south, answers)
        .out(third, Side::west, answers, verdict_link, from_south);
    all.push_back(script.until(third + 1000));
}

// A message that waits is overdue from the first epoch on that begins more than the bound after its wait
// began.
constexpr Cycle bound = 65536;
constexpr Cycle epoch = 8192;
constexpr Cycle overdue_from(Cycle since) { return ((since + bound) / epoch + 1) * epoch; }

/// A verdict waits for the west output, which was full before it came. A younger answer comes last. The
/// output is free in the cycle after `freed`.
Script waiting_verdict(const std::string& name, const std::string& says, Cycle freed, bool overdue) {
    Script script = empty_cell(name, says);
    const Answer before = answer_to(0, 1, Answer::Kind::lit, 4);
    const Answer younger = answer_to(0, 1, Answer::Kind::lit, 5);
    Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
    shadow.reach = 0.5;
    const Answer verdict = answer_for(shadow, Answer::Kind::lit);
    const Cycle first = freed + 1;
    const Cycle next = room(first, verdict_link);
    const Cycle to_verdict = overdue ? first : next;
    const Cycle to_younger = overdue ? next : first;
    script.in(sent, Side::east, answers, verdict_link, before)
        .take(routed(verdict_link), Side::east, answers)
        .out(routed(verdict_link), Side::west, answers, verdict_link, before)
        .in(sent, Side::west, east_bound, shadow_link, shadow)
        .in(freed - 100, Side::east, answers, verdict_link, younger)
        .free(freed, Side::west, answers)
        .take(to_verdict, Side::west, east_bound)
        .out(to_verdict, Side::west, answers, verdict_link, verdict)
        .free(next - 1, Side::west, answers)
        .take(to_younger, Side::east, answers)
        .out(to_younger, Side::west, answers, verdict_link, younger);
    return script;
}

/// A verdict waits for the west output, which was full before it came, and so does a younger answer, until
/// both are overdue.
Scenario both_overdue() {
    Script script = empty_cell("both_overdue",
                               "of a verdict and an answer that have both waited longer than the starvation "
                               "bound the older goes first, though it is no answer that passes");
    const Answer before = answer_to(0, 1, Answer::Kind::lit, 4);
    const Answer younger = answer_to(0, 1, Answer::Kind::lit, 5);
    Ray shadow = ray_of(RayKind::shadow, {0, 0.5, 5}, {1, 0, 0});
    shadow.reach = 0.5;
    constexpr Cycle since = sent + shadow_link + walk;
    constexpr Cycle first = overdue_from(since + 100);
    constexpr Cycle next = room(first, verdict_link);
    script.in(sent, Side::east, answers, verdict_link, before)
        .take(routed(verdict_link), Side::east, answers)
        .out(routed(verdict_link), Side::west, answers, verdict_link, before)
        .in(sent, Side::west, east_bound, shadow_link, shadow)
        .in(since + 10, Side::east, answers, verdict_link, younger)
        .free(first - 1, Side::west, answers)
        .take(first, Side::west, east_bound)
        .out(first, Side::west, answers, verdict_link, answer_for(shadow, Answer::Kind::lit))
        .free(next - 1, Side::west, answers)
        .take(next, Side::east, answers)
        .out(next, Side::west, answers, verdict_link, younger);
    return script.until(first + 1000);
}

void add_overdue(std::vector<Scenario>& all) {
    constexpr Cycle since = sent + shadow_link + walk;
    constexpr Cycle from = overdue_from(since);
    all.push_back(waiting_verdict("not_overdue",
                                  "a verdict that has waited for long still goes after an answer that passes",
                                  from - 2, false)
                      .until(from + 1000));
    all.push_back(waiting_verdict("overdue",
                                  "a verdict that has waited longer than the starvation bound goes first",
                                  from - 1, true)
                      .until(from + 1000));
    all.push_back(both_overdue());
}

}  // namespace

std::vector<Scenario> turn_scenarios() {
    std::vector<Scenario> all;
    add_ties(all);
    add_ray_and_answer(all);
    add_reply(all);
    add_overdue(all);
    return all;
}

}  // namespace raycell
