#include "testbench/rtl/bench/coverage.hpp"

namespace rtl {
namespace {

constexpr const char* side_names[] = {"east", "south", "west", "north", "home"};
int side_of_place(int place) { return place / ray_classes; }
std::string from(int requester) {
    if (requester < sides) return std::string("answer from ") + side_names[requester];
    if (requester < first_ray) return "own reply";
    const int place = requester - first_ray;
    if (place == own_place) return "own ray";
    return place > own_place ? "child" : std::string("ray from ") + side_names[side_of_place(place)];
}

}  // namespace

Coverage::Coverage() {
    for (int r = 0; r < sides; ++r) {
        for (int to = 0; to <= sides; ++to)
            if (to != r) bin(from(r) + " to " + side_names[to]);
    }
    if (replies > 0) {
        for (const char* to : side_names) bin(std::string("own reply to ") + to);
    }
    for (int p = 0; p < places && p <= own_place + 1; p += p < own_place ? ray_classes : 1) {
        const std::string who = from(first_ray + p);
        for (int to = 0; to < sides; ++to)
            if (p >= own_place || to != side_of_place(p)) bin(who + " to " + side_names[to]);
        bin(who + " ends here, answer to home");
        if (p < own_place) bin(who + " ends here, answer goes on");
    }
    if (replies > 0) {
        for (const char* what :
             {"hit takes a slot", "hit waits", "hit is postponed", "all slots are taken", "child postponed",
              "replies go before answers", "children of two slots are made"})
            bin(what);
    }
    for (const char* what :
         {"ray ends without an answer", "ray waits: far buffer is full", "answer waits: far buffer is full",
          "ray waits: wires are busy", "answer waits: wires are busy", "two ask for one output",
          "ray and answer ask for one output", "tie: two asked since the same cycle", "two want home",
          "two leave in one cycle", "overdue ray leaves", "overdue answer leaves", "two rays wait for a test",
          "more rays than free units", "ray is tested again outside the cube", "own ray postponed",
          "pixel complete", "new rays held back", "phase precast"})
        bin(what);
}

void Coverage::bin(const std::string& name) {
    order_.push_back(name);
    bins_[name] = 0;
}

void Coverage::sample(VerilatedCell& cell) {
    const Top& top = cell.top();
    if (top.draining) count("new rays held back");
    if (top.phase == 1) count("phase precast");
    int untested = 0;
    for (int p = 0; p < places; ++p) untested += int(bits_at(top.untested, p, 1));
    if (untested >= 2) count("two rays wait for a test");
    if (untested > 2) count("more rays than free units");
    if (top.pixel_valid) count("pixel complete");
    if (top.again) count("ray is tested again outside the cube");
#ifdef RTL_WHOLE
    if (top.takes_slot) count("hit takes a slot");
    if (top.slots_full) count("all slots are taken");
    if (top.child_postponed) count("child postponed");
    if (top.replies_lead) count("replies go before answers");
    if (top.feeds & (top.feeds - 1)) count("children of two slots are made");
#endif
    if (!top.asks) return;
    int going = 0;
    const auto goal = [&](int r) { return int(bits_at(top.goal, 3 * r, 3)); };
    const auto asks = [&](int r) { return bits_at(top.asks, r, 1) != 0; };
    for (int r = 0; r < requesters; ++r) {
        if (!asks(r)) continue;
        const bool answer = r < first_ray;
        const bool goes = bits_at(top.goes, r, 1) != 0;
        if (!goes) {
            if (bits_at(top.stalls_full, r, 1))
                count(answer ? "answer waits: far buffer is full" : "ray waits: far buffer is full");
            if (bits_at(top.stalls_wires, r, 1))
                count(answer ? "answer waits: wires are busy" : "ray waits: wires are busy");
        }
        for (int other = 0; other < r; ++other) {
            if (!asks(other) || goal(other) != goal(r)) continue;
            count(goal(r) == home ? "two want home" : "two ask for one output");
            const auto since = [&](int who) { return bits_at(top.asks_since, 48 * who, 48); };
            if (since(other) == since(r)) count("tie: two asked since the same cycle");
            if ((other < first_ray) != answer) count("ray and answer ask for one output");
        }
#ifdef RTL_WHOLE
        if (!answer && bits_at(top.hits, r - first_ray, 1)) {
            if (!goes) count("hit waits");
            if (goes && !top.takes_slot) count("hit is postponed");
            continue;
        }
#endif
        if (!goes) continue;
        ++going;
        if (bits_at(top.overdue, r, 1)) count(answer ? "overdue answer leaves" : "overdue ray leaves");
        if (answer || !(top.silent && goal(r) == 0 && !top.out_valid))
            count_way(r, goal(r), !answer && bits_at(top.ends, r - first_ray, 1));
    }
    if (top.silent) count("ray ends without an answer");
    if (top.postponed) count("own ray postponed");
    if (going >= 2) count("two leave in one cycle");
}

void Coverage::count_way(int requester, int to, bool ends) {
    if (requester < first_ray) return count(from(requester) + " to " + side_names[to]);
    if (ends)
        return count(to == home ? from(requester) + " ends here, answer to home"
                                : from(requester) + " ends here, answer goes on");
    count(from(requester) + " to " + side_names[to]);
}

std::size_t Coverage::hit() const {
    std::size_t hit = 0;
    for (const std::string& name : order_) hit += bins_.at(name) > 0;
    return hit;
}

std::string Coverage::table() const {
    std::string text = "| what | times |\n|---|---|\n";
    for (const std::string& name : order_)
        text += "| " + name + " | " + std::to_string(bins_.at(name)) + " |\n";
    return text + std::to_string(hit()) + " of " + std::to_string(bins()) + " seen\n";
}

}  // namespace rtl
