// How a run ended: verdicts, their proof, and what was stuck.
#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "pipeline/machine.hpp"

namespace raycell {

bool Machine::phase_complete() const {
    const Counters& c = environment_.counters;
    const std::uint64_t cells = std::uint64_t(environment_.width()) * std::uint64_t(environment_.height());
    switch (environment_.phase) {
        case Phase::load:
            return c.cells_loaded == cells;
        case Phase::precast:
            return c.rays_sent == c.rays_answered + c.rays_silent + c.rays_destroyed &&
                   c.answers_sent == c.answers_delivered &&
                   std::none_of(array_.cells().begin(), array_.cells().end(),
                                [](const Cell& cell) { return cell.busy(); });
        case Phase::trace:
            return c.pixels_done == cells;
    }
    return false;
}

void Machine::judge(RunResult& result) {
    if (interrupted_) {  // whoever interrupts does not want to wait for a proof
        result.verdict = Verdict::interrupted;
        return;
    }
    if (environment_.phase != Phase::load) result.waits = wait_graph();
    const bool locked = result.waits.deadlocked();
    if (scheduler_.limit_reached()) {
        // What is locked stays so, whatever the limit; anything else may only be congested.
        result.verdict = locked ? Verdict::deadlock : Verdict::cycle_limit;
    } else if (environment_.draining) {
        const bool at_rest = !scheduler_.stopped();
        if (at_rest && !buffers_empty() && !locked) {
            throw std::logic_error("internal error: what stands still waits for nothing");
        }
        result.verdict = locked ? Verdict::deadlock : Verdict::livelock;
    } else {
        result.verdict = Verdict::deadlock;
        if (kick_finds_work()) throw std::logic_error("internal error: a cell that could move was not woken");
        if (environment_.phase != Phase::load && !locked) {
            throw std::logic_error("internal error: a run stands still without a knot");
        }
    }
    result.report = locked ? knot_report(result.waits) : stuck_report();
    for (const auto& knot : result.waits.knots()) {
        result.knot_formed = std::min<Cycle>(result.knot_formed, result.waits.formed(knot));
        for (const WaitGraph::Index i : knot) {
            const WaitGraph::Node& node = result.waits.nodes()[i];
            result.knot_cells.emplace_back(node.x, node.y);
        }
    }
    std::sort(result.knot_cells.begin(), result.knot_cells.end(), [](const auto& a, const auto& b) {
        return std::tie(a.second, a.first) < std::tie(b.second, b.first);
    });
    result.knot_cells.erase(std::unique(result.knot_cells.begin(), result.knot_cells.end()),
                            result.knot_cells.end());
}

WaitGraph Machine::wait_graph() const {
    WaitMap map;
    for (const Cell& cell : array_.cells()) cell.add_places(map);
    if (exterior_) exterior_->add_places(map);
    for (const Cell& cell : array_.cells()) cell.add_waits(map);
    if (exterior_) exterior_->add_waits(map);
    map.graph().analyse();
    return std::move(map.graph());
}

/// The nodes of all knots, a line each, oldest first.
std::vector<std::string> Machine::knot_report(const WaitGraph& graph) {
    std::vector<WaitGraph::Index> order;
    for (const auto& knot : graph.knots()) order.insert(order.end(), knot.begin(), knot.end());
    std::stable_sort(order.begin(), order.end(), [&](WaitGraph::Index a, WaitGraph::Index b) {
        return graph.nodes()[a].since < graph.nodes()[b].since;
    });
    std::vector<std::string> lines;
    for (const WaitGraph::Index i : order) {
        const WaitGraph::Node& node = graph.nodes()[i];
        lines.push_back("cell (" + std::to_string(node.x) + ", " + std::to_string(node.y) + ") " + node.what +
                        " since cycle " + std::to_string(node.since) + ": " + node.holds + ", waits for " +
                        node.wants);
    }
    return lines;
}

bool Machine::buffers_empty() const {
    const auto empty = [](const Link& link) {
        for (int index = 0; index < link.classes(); ++index) {
            if (link.occupancy(index) > 0) return false;
        }
        return true;
    };
    if (!std::all_of(array_.links().begin(), array_.links().end(), empty)) return false;
    return !exterior_ || (!exterior_->busy() &&
                          std::all_of(exterior_->links().begin(), exterior_->links().end(),
                                      [&](const std::unique_ptr<Link>& link) { return empty(*link); }));
}

/// Nothing moves by itself: if a step of any cell now changes something, its waking was lost, and the verdict
/// would be the model's fault, not the machine's.
bool Machine::kick_finds_work() {
    const std::uint64_t before = array_.schedule_hash();
    const Cycle stopped = scheduler_.now();
    scheduler_.set_now(stopped + (Cycle(1) << 40));  // past every transfer, cost and back-off
    for (Cell& cell : array_.cells()) cell.step(scheduler_.now());
    scheduler_.set_now(stopped);
    return array_.schedule_hash() != before;
}

std::vector<std::string> Machine::stuck_report() const {
    std::vector<std::string> lines;
    for (const Cell& cell : array_.cells()) {
        auto more = cell.describe_blocked();
        lines.insert(lines.end(), more.begin(), more.end());
    }
    const auto add_links = [&lines](const std::vector<std::unique_ptr<Link>>& links) {
        for (const auto& link : links) {
            for (int index = 0; index < link->classes(); ++index) {
                if (link->occupancy(index) == 0) continue;
                lines.push_back("link " + link->name() + " class " + std::to_string(index) + " since cycle " +
                                std::to_string(link->arrival(index)) + ": " +
                                std::to_string(link->occupancy(index)) + " messages");
            }
        }
    };
    add_links(distribution_.links());
    add_links(row_links_);
    if (exterior_) add_links(exterior_->links());
    const auto age = [](const std::string& line) {
        const auto at = line.find("since cycle ");
        return at == std::string::npos ? 0ULL : std::stoull(line.substr(at + 12));
    };
    std::stable_sort(lines.begin(), lines.end(),
                     [&](const std::string& a, const std::string& b) { return age(a) < age(b); });
    return lines;
}

std::vector<std::pair<int, int>> Machine::blocked_cells(std::size_t most) const {
    std::vector<std::tuple<Cycle, int, int>> found;  // (since, y, x)
    for (const Cell& cell : array_.cells()) {
        // Cells that hold rays but no message come last.
        const Cycle since = cell.busy() ? std::min(cell.oldest_arrival(), never - 1) : cell.oldest_arrival();
        if (since != never) found.emplace_back(since, cell.y(), cell.x());
    }
    std::sort(found.begin(), found.end());
    if (found.size() > most) found.resize(most);
    std::vector<std::pair<int, int>> cells;
    for (const auto& [since, y, x] : found) cells.emplace_back(x, y);
    return cells;
}

void Machine::collect_time_outs(RunResult& result) const {
    const auto index = [&](int x, int y) {
        return std::size_t(y) * std::size_t(environment_.width()) + std::size_t(x);
    };
    // 2: holds a node of a knot; 1: one that waits for a knot.
    std::vector<int> locked(array_.cells().size(), 0);
    for (const WaitGraph::Node& node : result.waits.nodes()) {
        int& state = locked[index(node.x, node.y)];
        if (node.state == WaitGraph::State::knot) state = 2;
        if (node.state == WaitGraph::State::tail) state = std::max(state, 1);
    }
    const auto seen = [&](WaitGraph::Index i) {
        const WaitGraph::Node& node = result.waits.nodes()[i];
        return array_.cell(node.x, node.y).time_out().since() != never;
    };
    const auto& knots = result.waits.knots();
    const auto missed = std::count_if(knots.begin(), knots.end(), [&](const auto& knot) {
        return std::none_of(knot.begin(), knot.end(), seen);
    });
    for (int log = TimeOut::least_log; log <= TimeOut::most_log; ++log) {
        TimeOutResult sum;
        sum.cycles = Cycle(1) << log;
        // Where nothing moves any more, a wait that goes on lasts for ever: longer than any time-out.
        sum.missed_knots = std::uint64_t(missed);
        Cycle first = never;
        for (std::size_t i = 0; i < locked.size(); ++i) {
            const TimeOut& time_out = array_.cells()[i].time_out();
            (locked[i] ? sum.early_alarms : sum.false_alarms) += time_out.ended(log);
            sum.knot_cells += locked[i] == 2;
            if (!locked[i] || time_out.since() == never) continue;
            ++(locked[i] == 2 ? sum.knot_alarms : sum.tail_alarms);
            if (locked[i] == 2) first = std::min(first, time_out.since() + sum.cycles);
        }
        if (first != never) sum.first_alarm_delay = std::int64_t(first) - std::int64_t(result.knot_formed);
        result.time_outs.push_back(sum);
    }
}

}  // namespace raycell
