#include "testbench/protocol/search.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include "model/numbers/hash.hpp"

namespace raycell::protocol {
namespace {

/// Where a ray, its answer or its notice is.
enum Place : std::uint8_t {
    unsent = 0,
    in_register = 1,  ///< the slot's child register, or the cell's register of the own ray
    on_way = 2,       ///< + index into Ray::way
    to_set_up = 64,   ///< the three states of a slot
    waiting = 65,
    to_reply = 66,
    in_unit = 67,       ///< the shading unit, with its answer
    in_processor = 68,  ///< of the exterior, with its answer
    answer = 96,        ///< + index into Ray::back
    notice = 160,       ///< "postponed", + index into Ray::back
    again = 254,        ///< a primary ray that was postponed, where own rays are limited
    done = 255
};
constexpr std::size_t longest_way = 60;

using State = std::array<std::uint8_t, most_rays>;

bool holds_slot(std::uint8_t place) { return place >= to_set_up && place <= to_reply; }

/// The moves of a script from a given state.
class Moves {
  public:
    Moves(const Script& script, const Rules& rules) : script_(script), rules_(rules) {
        if (script.rays().size() > most_rays) throw std::length_error("too many rays");
        for (const Ray& ray : script.rays()) {
            if (ray.way.size() > longest_way || ray.back.size() > longest_way)
                throw std::length_error("too long a way");
        }
        buffers_.resize(std::size_t(script.buffer_count()));
    }

    bool final(const State& state) const {
        return std::all_of(state.begin(), state.begin() + std::ptrdiff_t(script_.rays().size()),
                           [](std::uint8_t place) { return place == done; });
    }

    const std::vector<State>& from(const State& state) {
        look_at(state);
        next_.clear();
        for (std::size_t i = 0; i < script_.rays().size(); ++i) move(i);
        return next_;
    }

    std::string describe(std::size_t ray, std::uint8_t place) const;

  private:
    const Ray& ray(std::size_t i) const { return script_.rays()[i]; }
    int cell(int x, int y) const { return y * script_.width() + x; }
    int end_cell(std::size_t i) const { return cell(ray(i).end_x, ray(i).end_y); }

    void look_at(const State& state) {
        state_ = state;
        std::fill(buffers_.begin(), buffers_.end(), 0);
        for (std::size_t i = 0; i < script_.rays().size(); ++i) {
            const std::uint8_t at = state[i];
            if (at >= on_way && at < to_set_up) buffers_[ray(i).way[std::size_t(at - on_way)]] = 1;
            if (at >= answer && at < notice) buffers_[ray(i).back[std::size_t(at - answer)]] = 1;
            if (at >= notice && at < again) buffers_[ray(i).back[std::size_t(at - notice)]] = 1;
        }
    }
    void to(std::size_t i, std::uint8_t place) {
        next_.push_back(state_);
        next_.back()[i] = place;
    }
    bool any(const std::function<bool(std::size_t)>& condition) const {
        for (std::size_t i = 0; i < script_.rays().size(); ++i) {
            if (condition(i)) return true;
        }
        return false;
    }
    bool children_done(std::size_t slot) const {
        return !any([&](std::size_t i) {
            const auto& parents = ray(i).parents;
            return state_[i] != done && std::find(parents.begin(), parents.end(), int(slot)) != parents.end();
        });
    }
    bool unit_taken(int at) const {
        return any([&](std::size_t i) { return state_[i] == in_unit && end_cell(i) == at; });
    }
    /// A slot ready to be shaded goes before a direct hit: work that was begun is finished first.
    bool slot_complete(int at) const {
        return any(
            [&](std::size_t i) { return state_[i] == waiting && end_cell(i) == at && children_done(i); });
    }
    bool slot_free(int at, int generation) const {
        std::vector<int> used(std::size_t(std::max(rules_.generations, 1)), 0);
        for (std::size_t i = 0; i < script_.rays().size(); ++i) {
            if (holds_slot(state_[i]) && end_cell(i) == at) ++used[std::size_t(ray(i).generation)];
        }
        return accepts(rules_, used, generation);
    }

    void move(std::size_t i);
    bool may_be_sent(std::size_t i) const;
    bool may_begin(std::size_t i) const;
    std::uint8_t at_home(std::size_t i, Place kind) const {
        if (kind == answer) return done;
        return rules_.own_rays > 0 && ray(i).parents.empty() ? again : unsent;
    }
    void move_at_end(std::size_t i);
    /// Sends an answer or a notice, which may be home at once.
    void set_out(std::size_t i, Place kind) {
        if (ray(i).back.empty()) return to(i, at_home(i, kind));
        if (!buffers_[ray(i).back[0]]) to(i, kind);
    }
    void pass_on(std::size_t i, Place kind) {
        const std::size_t next = std::size_t(state_[i] - kind) + 1;
        if (next == ray(i).back.size()) return to(i, at_home(i, kind));  // always taken at home
        if (!buffers_[ray(i).back[next]]) to(i, std::uint8_t(kind + next));
    }

    const Script& script_;
    Rules rules_;
    State state_{};
    std::vector<char> buffers_;
    std::vector<State> next_;
};

/// Whether a primary ray is the next of its cell and may be under way beside the others.
bool Moves::may_begin(std::size_t i) const {
    int under_way = 0;
    for (std::size_t other = 0; other < script_.rays().size(); ++other) {
        if (!ray(other).parents.empty() || ray(other).x != ray(i).x || ray(other).y != ray(i).y) continue;
        if (state_[other] == again || (other < i && state_[other] == unsent)) return false;
        under_way += state_[other] != unsent && state_[other] != done;
    }
    return under_way < rules_.own_rays;
}

bool Moves::may_be_sent(std::size_t i) const {
    const auto& parents = ray(i).parents;
    if (rules_.own_rays > 0 && parents.empty() && state_[i] == unsent && !may_begin(i)) return false;
    if (parents.size() > 1) {  // memo: the first slot to wait sends it
        return std::any_of(parents.begin(), parents.end(),
                           [&](int p) { return state_[std::size_t(p)] == waiting; });
    }
    if (!parents.empty() && state_[std::size_t(parents[0])] != waiting) return false;
    return !any([&](std::size_t other) {  // the register holds one ray at a time
        if (other == i || state_[other] != in_register) return false;
        if (!parents.empty()) return ray(other).parents == parents;
        return ray(other).parents.empty() && ray(other).x == ray(i).x && ray(other).y == ray(i).y;
    });
}

void Moves::move(std::size_t i) {
    const std::uint8_t at = state_[i];
    if (at == unsent || at == again) {
        if (may_be_sent(i)) to(i, in_register);
    } else if (at < to_set_up) {
        const std::size_t passed = at == in_register ? 0 : std::size_t(at - on_way) + 1;
        if (passed == ray(i).way.size()) return move_at_end(i);
        if (!buffers_[ray(i).way[passed]]) to(i, std::uint8_t(on_way + passed));
    } else if (at == to_set_up) {
        if (!unit_taken(end_cell(i))) to(i, waiting);
    } else if (at == waiting) {
        if (children_done(i) && !unit_taken(end_cell(i))) to(i, to_reply);
    } else if (at <= in_processor) {
        set_out(i, answer);
    } else if (at < notice) {
        pass_on(i, answer);
    } else if (at != done) {
        pass_on(i, notice);
    }
}

/// Moves a ray at the end of its way, in a buffer or in the register of the cell that sent it.
void Moves::move_at_end(std::size_t i) {
    const int here = end_cell(i);
    switch (ray(i).end) {
        case End::hit:
            if (slot_free(here, ray(i).generation)) return to(i, to_set_up);
            if (rules_.recovery == Recovery::postpone) set_out(i, notice);
            return;
        case End::direct:
            if (!unit_taken(here) && !slot_complete(here)) to(i, in_unit);
            return;
        case End::answer:
            return set_out(i, answer);
        case End::silent:
            return to(i, done);
        case End::exterior: {
            int working = 0;
            for (std::size_t k = 0; k < script_.rays().size(); ++k) working += state_[k] == in_processor;
            if (working < rules_.processors) to(i, in_processor);
            return;
        }
    }
}

std::string Moves::describe(std::size_t i, std::uint8_t place) const {
    const Ray& r = ray(i);
    const std::string at = " (" + std::to_string(r.end_x) + ", " + std::to_string(r.end_y) + ")";
    if (place == unsent) return "to be sent";
    if (place == again) return "to be sent again";
    if (place == in_register)
        return "in a register of (" + std::to_string(r.x) + ", " + std::to_string(r.y) + ")";
    if (place < to_set_up) return "in " + script_.buffer_name(r.way[std::size_t(place - on_way)]);
    if (place == to_set_up) return "takes a slot of" + at;
    if (place == waiting) return "waits in its slot of" + at;
    if (place == to_reply) return "is shaded in its slot of" + at;
    if (place == in_unit) return "is in the shading unit of" + at;
    if (place == in_processor) return "is answered outside";
    if (place < notice) return "answer in " + script_.buffer_name(r.back[std::size_t(place - answer)]);
    if (place < done)
        return "destroyed, notice in " + script_.buffer_name(r.back[std::size_t(place - notice)]);
    return "is answered";
}

/// All states seen, with their numbers: a hash table with open addressing over their bytes.
class Seen {
  public:
    explicit Seen(std::size_t bytes) : bytes_(bytes), table_(1 << 12, none) {}
    std::size_t size() const { return states_.size() / bytes_; }
    State operator[](std::size_t i) const {
        State state{};
        std::copy_n(states_.begin() + std::ptrdiff_t(i * bytes_), bytes_, state.begin());
        return state;
    }
    /// The state's number; a new state gets the next one.
    std::uint32_t number(const State& state) {
        if (2 * size() >= table_.size()) grow();
        const std::size_t slot = find(state.data());
        if (table_[slot] == none) {
            table_[slot] = std::uint32_t(size());
            states_.insert(states_.end(), state.begin(), state.begin() + std::ptrdiff_t(bytes_));
        }
        return table_[slot];
    }

  private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    std::size_t find(const std::uint8_t* state) const {
        Fnv hash;
        hash.add_bytes(state, bytes_);
        hash.fold(29);
        std::size_t slot = hash.value() & (table_.size() - 1);
        while (table_[slot] != none && !std::equal(state, state + bytes_, &states_[table_[slot] * bytes_])) {
            slot = (slot + 1) & (table_.size() - 1);
        }
        return slot;
    }
    void grow() {
        const std::size_t count = size();
        table_.assign(table_.size() * 4, none);
        for (std::size_t i = 0; i < count; ++i) table_[find(&states_[i * bytes_])] = std::uint32_t(i);
    }
    std::size_t bytes_;
    std::vector<std::uint8_t> states_;
    std::vector<std::uint32_t> table_;
};

/// The states from which one of `goals` can be reached.
std::vector<char> reaching(const std::vector<std::uint32_t>& goals, const std::vector<std::uint32_t>& first,
                           const std::vector<std::uint32_t>& targets) {
    const std::size_t count = first.size() - 1;
    std::vector<std::uint32_t> back_first(count + 1, 0);
    for (const std::uint32_t target : targets) ++back_first[target + 1];
    for (std::size_t i = 0; i < count; ++i) back_first[i + 1] += back_first[i];
    std::vector<std::uint32_t> back(targets.size());
    std::vector<std::uint32_t> fill(back_first.begin(), back_first.end() - 1);
    for (std::uint32_t from = 0; from < count; ++from) {
        for (std::uint32_t e = first[from]; e < first[from + 1]; ++e) back[fill[targets[e]]++] = from;
    }
    std::vector<char> reaches(count, 0);
    std::vector<std::uint32_t> open = goals;
    for (const std::uint32_t goal : goals) reaches[goal] = 1;
    while (!open.empty()) {
        const std::uint32_t at = open.back();
        open.pop_back();
        for (std::uint32_t e = back_first[at]; e < back_first[at + 1]; ++e) {
            if (reaches[back[e]]) continue;
            reaches[back[e]] = 1;
            open.push_back(back[e]);
        }
    }
    return reaches;
}

std::vector<std::string> trace(const Script& script, const Moves& moves, const Seen& seen,
                               const std::vector<std::uint32_t>& came_from, std::uint32_t to) {
    std::vector<std::string> lines;
    for (std::uint32_t at = to; at != 0; at = came_from[at]) {
        const State before = seen[came_from[at]];
        const State after = seen[at];
        for (std::size_t i = 0; i < script.rays().size(); ++i) {
            if (before[i] != after[i])
                lines.push_back(script.rays()[i].name + ": " + moves.describe(i, after[i]));
        }
    }
    std::reverse(lines.begin(), lines.end());
    lines.push_back("then:");
    const State last = seen[to];
    for (std::size_t i = 0; i < script.rays().size(); ++i) {
        if (last[i] != done)
            lines.push_back("  " + script.rays()[i].name + ": " + moves.describe(i, last[i]));
    }
    return lines;
}

}  // namespace

bool accepts(const Rules& rules, const std::vector<int>& used, int generation) {
    int all = 0;
    for (const int u : used) all += u;
    if (all >= rules.ray_store) return false;
    if (rules.slots == Slots::free) return true;
    // Each group has one slot of its own, the others are for all. The deepest generations share the last
    // group.
    const int groups = std::max(1, std::min(rules.ray_store, rules.generations));
    std::vector<int> group(std::size_t(groups), 0);
    for (std::size_t g = 0; g < used.size(); ++g) group[std::min(g, std::size_t(groups - 1))] += used[g];
    if (rules.slots == Slots::nested) {
        // For this group and each deeper one: the groups up to it leave one slot for every group beyond it.
        int up_to = 0;
        for (int g = 0; g < groups; ++g) {
            up_to += group[std::size_t(g)];
            const int deeper = groups - 1 - g;
            if (g >= std::min(generation, groups - 1) && up_to >= rules.ray_store - deeper) return false;
        }
        return true;
    }
    if (group[std::size_t(std::min(generation, groups - 1))] == 0) return true;
    int borrowed = 0;
    for (const int u : group) borrowed += std::max(0, u - 1);
    return borrowed < rules.ray_store - groups;
}

Result search(const Script& script, const Rules& rules, std::uint64_t most_states) {
    Moves moves(script, rules);
    Seen seen(std::max<std::size_t>(script.rays().size(), 1));
    std::vector<std::uint32_t> first{0};  // index in `targets` of each state's first move
    std::vector<std::uint32_t> targets;
    std::vector<std::uint32_t> came_from{0};
    std::vector<std::uint32_t> ends;
    std::vector<std::uint32_t> stuck;
    Result result;
    seen.number(State{});
    for (std::uint32_t at = 0; at < seen.size(); ++at) {
        const State state = seen[at];
        const std::vector<State>& next = moves.from(state);
        for (const State& after : next) {
            const std::uint32_t number = seen.number(after);
            if (number == came_from.size()) came_from.push_back(at);
            targets.push_back(number);
        }
        first.push_back(std::uint32_t(targets.size()));
        if (next.empty()) (moves.final(state) ? ends : stuck).push_back(at);
        if (seen.size() > most_states) {
            result.states = seen.size();
            return result;
        }
    }
    result.complete = true;
    result.states = seen.size();
    result.moves = targets.size();
    result.deadlocks = stuck.size();
    // The search is breadth first, so the lowest number is the nearest state.
    if (!stuck.empty()) result.way_to_deadlock = trace(script, moves, seen, came_from, stuck.front());
    std::vector<std::uint32_t> goals = ends;
    goals.insert(goals.end(), stuck.begin(), stuck.end());
    const std::vector<char> reaches = reaching(goals, first, targets);
    for (std::uint32_t i = 0; i < reaches.size(); ++i) {
        if (reaches[i]) continue;
        if (++result.traps == 1) result.way_to_trap = trace(script, moves, seen, came_from, i);
    }
    return result;
}

}  // namespace raycell::protocol
