// How a run ended: verdicts, their proof, and what was stuck.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

#include "cells/deadlock/cell_waits.hpp"
#include "pipeline/machine.hpp"

namespace raycell {

bool Machine::phase_complete() const {
    const Counters& c = totals_;
    const std::uint64_t cells = std::uint64_t(environment_.width()) * std::uint64_t(environment_.height());
    switch (environment_.phase) {
        case Phase::load:
            return c.cells_loaded == cells;
        case Phase::precast:
            return c.rays_sent == c.rays_answered + c.rays_silent + c.rays_destroyed &&
                   c.answers_sent == c.answers_delivered &&
                   sum(std::any_of(array_.cells().begin(), array_.cells().end(),
                                   [](const Cell& cell) { return cell.busy(); })) == 0;
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
    result.waits = wait_graph();
    const bool locked = result.waits.deadlocked();
    if (sum(scheduler_.limit_reached()) > 0) {
        // What is locked stays so, whatever the limit; anything else may only be congested.
        result.verdict = locked ? Verdict::deadlock : Verdict::cycle_limit;
    } else if (environment_.draining) {
        // Without a knot, what stands still may be freed by what is only held back while draining.
        const bool at_rest = !scheduler_.stopped();
        if (sum(at_rest && !buffers_empty()) > 0 && !locked) expect_no_work();
        result.verdict = locked ? Verdict::deadlock : Verdict::livelock;
    } else {
        result.verdict = Verdict::deadlock;
        expect_no_work();
        if (environment_.phase != Phase::load && !locked) {
            throw std::logic_error("internal error: a run stands still without a knot");
        }
    }
    result.report = locked || environment_.phase == Phase::load ? report_of(result.waits) : stuck_report();
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
    if (ranks_) {
        put_waits_together(map);
    } else {
        const Band& all = environment_.share.bands().front();
        add_places(all, map);
        add_outside_places(map);
        add_waits(all, map);
        add_outside_waits(map);
    }
    // What is still on its way, or at work, gets to where it is only later.
    for (WaitGraph::Index i = 0; i < map.graph().nodes().size(); ++i)
        map.graph()[i].since = std::min(map.graph()[i].since, scheduler_.now());
    map.graph().analyse();
    return std::move(map.graph());
}

/// The nodes of all knots or, without any, all nodes: a line each, oldest first.
std::vector<std::string> Machine::report_of(const WaitGraph& graph) {
    std::vector<WaitGraph::Index> order;
    for (const auto& knot : graph.knots()) order.insert(order.end(), knot.begin(), knot.end());
    for (WaitGraph::Index i = 0; !graph.deadlocked() && i < graph.nodes().size(); ++i) order.push_back(i);
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
void Machine::expect_no_work() {
    const std::uint64_t before = array_.schedule_hash();
    const Cycle stopped = scheduler_.now();
    scheduler_.set_now(stopped + (Cycle(1) << 40));  // past every transfer, cost and back-off
    for (Cell& cell : array_.cells()) cell.step(scheduler_.now());
    scheduler_.set_now(stopped);
    if (sum(array_.schedule_hash() != before) > 0)
        throw std::logic_error("internal error: a cell that could move was not woken");
}

std::vector<std::string> Machine::stuck_report() const {
    std::vector<std::vector<RowLine>> sections(
        2);  // cells, then the border's links: of each all ranks' together
    for (const Cell& cell : array_.cells()) {
        for (std::string& line : describe_blocked(cell)) sections[0].push_back({cell.y(), std::move(line)});
    }
    if (exterior_) {
        for (const auto& link : exterior_->links()) {
            for (int index = 0; index < link->classes(); ++index) {
                if (link->occupancy(index) == 0) continue;
                const Cycle since = std::min(link->arrival(index), scheduler_.now());
                sections[1].push_back({0, "link " + link->name() + " class " + std::to_string(index) +
                                              " since cycle " + std::to_string(since) + ": " +
                                              std::to_string(link->occupancy(index)) + " messages"});
            }
        }
    }
    std::vector<std::string> lines = joined_lines(std::move(sections));
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
    std::vector<int> locked(std::size_t(environment_.width()) * std::size_t(environment_.height()), 0);
    for (const WaitGraph::Node& node : result.waits.nodes()) {
        int& state = locked[index(node.x, node.y)];
        if (node.state == WaitGraph::State::knot) state = 2;
        if (node.state == WaitGraph::State::tail) state = std::max(state, 1);
    }
    const auto seen = [&](WaitGraph::Index i) {
        const WaitGraph::Node& node = result.waits.nodes()[i];
        return environment_.share.contains(node.y) && array_.cell(node.x, node.y).time_out().since() != never;
    };
    std::uint64_t missed = 0;
    for (const auto& knot : result.waits.knots()) {
        missed += sum(std::uint64_t(std::count_if(knot.begin(), knot.end(), seen))) == 0;
    }
    struct Sums {
        TimeOutResult all;
        Cycle first = never;
        void join(const Sums& other) {
            all.false_alarms += other.all.false_alarms;
            all.early_alarms += other.all.early_alarms;
            all.knot_cells += other.all.knot_cells;
            all.knot_alarms += other.all.knot_alarms;
            all.tail_alarms += other.all.tail_alarms;
            first = std::min(first, other.first);
        }
    };
    std::array<Sums, TimeOut::most_log - TimeOut::least_log + 1> sums;
    for (std::size_t at = 0; at < sums.size(); ++at) {
        const int log = TimeOut::least_log + int(at);
        Sums& mine = sums[at];
        mine.all.cycles = Cycle(1) << log;
        for (std::size_t i = 0; i < array_.cells().size(); ++i) {
            const Cell& cell = array_.cells()[i];
            const TimeOut& time_out = cell.time_out();
            const int state = locked[index(cell.x(), cell.y())];
            (state ? mine.all.early_alarms : mine.all.false_alarms) += time_out.ended(log);
            mine.all.knot_cells += state == 2;
            if (!state || time_out.since() == never) continue;
            ++(state == 2 ? mine.all.knot_alarms : mine.all.tail_alarms);
            if (state == 2) mine.first = std::min(mine.first, time_out.since() + mine.all.cycles);
        }
    }
    sums = joined(sums, [](auto& a, const auto& b) {
        for (std::size_t at = 0; at < a.size(); ++at) a[at].join(b[at]);
    });
    for (Sums& all : sums) {
        // Where nothing moves any more, a wait that goes on lasts for ever: longer than any time-out.
        all.all.missed_knots = missed;
        if (all.first != never)
            all.all.first_alarm_delay = std::int64_t(all.first) - std::int64_t(result.knot_formed);
        result.time_outs.push_back(all.all);
    }
}

}  // namespace raycell
