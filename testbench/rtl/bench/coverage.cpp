#include "testbench/rtl/bench/coverage.hpp"

namespace rtl {
namespace {

constexpr const char* side_names[] = {"east", "south", "west", "north", "home"};
constexpr int ray_classes = classes - 1;
constexpr int places = sides * ray_classes + 1;
constexpr int own = places - 1;
constexpr int requesters = sides + places;

int side_of_place(int place) { return place / ray_classes; }
std::string from(int requester) {
    if (requester < sides) return std::string("answer from ") + side_names[requester];
    if (requester == sides + own) return "own ray";
    return std::string("ray from ") + side_names[side_of_place(requester - sides)];
}

/// Entry `at` of an array of 48 bits each.
template <typename Wide>
std::uint64_t bits48(const Wide& wide, int at) {
    std::uint64_t value = 0;
    for (int part = 0; part < 3; ++part) {
        const int low = 48 * at + 16 * part;
        value |= std::uint64_t(wide[low / 32] >> (low % 32) & 0xffff) << (16 * part);
    }
    return value;
}

}  // namespace

Coverage::Coverage() {
    for (int r = 0; r < sides; ++r) {
        for (int to = 0; to <= sides; ++to)
            if (to != r) bin(from(r) + " to " + side_names[to]);
    }
    for (int p = 0; p < places; p += p < own ? ray_classes : 1) {
        const std::string who = from(sides + p);
        for (int to = 0; to < sides; ++to)
            if (p == own || to != side_of_place(p)) bin(who + " to " + side_names[to]);
        bin(who + " ends here, answer to home");
        if (p != own) bin(who + " ends here, answer goes on");
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
    const Vempty_cell& top = cell.top();
    if (top.draining) count("new rays held back");
    if (top.phase == 1) count("phase precast");
    int untested = 0;
    for (int p = 0; p < places; ++p) untested += top.untested >> p & 1;
    if (untested >= 2) count("two rays wait for a test");
    if (untested > 2) count("more rays than free units");
    if (top.pixel_valid) count("pixel complete");
    if (top.again) count("ray is tested again outside the cube");
    if (!top.asks) return;
    int going = 0;
    const auto goal = [&](int r) { return int(top.goal >> (3 * r) & 7); };
    const auto asks = [&](int r) { return top.asks >> r & 1; };
    for (int r = 0; r < requesters; ++r) {
        if (!asks(r)) continue;
        const bool answer = r < sides;
        const bool goes = top.goes >> r & 1;
        if (!goes) {
            if (top.stalls_full >> r & 1)
                count(answer ? "answer waits: far buffer is full" : "ray waits: far buffer is full");
            if (top.stalls_wires >> r & 1)
                count(answer ? "answer waits: wires are busy" : "ray waits: wires are busy");
        }
        for (int other = 0; other < r; ++other) {
            if (!asks(other) || goal(other) != goal(r)) continue;
            count(goal(r) == home ? "two want home" : "two ask for one output");
            const auto since = [&](int who) { return bits48(top.asks_since, who); };
            if (since(other) == since(r)) count("tie: two asked since the same cycle");
            if ((other < sides) != answer) count("ray and answer ask for one output");
        }
        if (!goes) continue;
        ++going;
        if (top.overdue >> r & 1) count(answer ? "overdue answer leaves" : "overdue ray leaves");
        if (answer || !(top.silent && goal(r) == 0 && !top.out_valid))
            count_way(r, goal(r), !answer && (top.ends >> (r - sides) & 1));
    }
    if (top.silent) count("ray ends without an answer");
    if (top.postponed) count("own ray postponed");
    if (going >= 2) count("two leave in one cycle");
}

void Coverage::count_way(int requester, int to, bool ends) {
    if (requester < sides) return count(from(requester) + " to " + side_names[to]);
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
