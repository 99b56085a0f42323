#include "pipeline/verdict.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "pipeline/machine_waits.hpp"

namespace raycell {
namespace {

/// One line for each node of the knots (without knots: for each node), oldest first.
std::vector<std::string> report_of(const WaitGraph& graph) {
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

}  // namespace

bool Judge::phase_complete() const {
    const Counters& c = totals_;
    const std::uint64_t cells = parts_.cell_count();
    switch (parts_.environment.phase) {
        case Phase::load:
            return c.cells_loaded == cells;
        case Phase::precast:
            return c.rays_sent == c.rays_answered + c.rays_silent + c.rays_destroyed &&
                   c.answers_sent == c.answers_delivered &&
                   joined_.sum(std::any_of(parts_.array.cells().begin(), parts_.array.cells().end(),
                                           [](const Cell& cell) { return cell.busy(); })) == 0;
        case Phase::trace:
            return c.pixels_done == cells * std::uint64_t(parts_.environment.context.scene.frame.block());
    }
    return false;
}

Verdict Judge::verdict_of(bool locked) {
    // A knot stays for ever, whatever the limit; anything else may only be congestion.
    if (joined_.sum(parts_.scheduler.limit_reached()) > 0)
        return locked ? Verdict::deadlock : Verdict::cycle_limit;
    if (parts_.environment.draining) {
        // Without a knot, messages that stand still may be freed by rays that draining holds back.
        const bool at_rest = !parts_.scheduler.stopped();
        if (joined_.sum(at_rest && !buffers_empty()) > 0 && !locked) expect_no_work();
        return locked ? Verdict::deadlock : Verdict::livelock;
    }
    expect_no_work();
    if (parts_.environment.phase != Phase::load && !locked)
        throw std::logic_error("internal error: a run stands still without a knot");
    return Verdict::deadlock;
}

void Judge::judge(bool interrupted, RunResult& result) {
    if (interrupted) {  // a user who interrupts does not want to wait for a proof
        result.verdict = Verdict::interrupted;
        return;
    }
    result.waits = MachineWaits(parts_).graph();
    const bool locked = result.waits.deadlocked();
    result.verdict = verdict_of(locked);
    result.report =
        locked || parts_.environment.phase == Phase::load ? report_of(result.waits) : stuck_report();
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

bool Judge::buffers_empty() const {
    const auto empty = [](const Link& link) {
        for (int index = 0; index < link.classes(); ++index) {
            if (link.occupancy(index) > 0) return false;
        }
        return true;
    };
    if (!std::all_of(parts_.array.links().begin(), parts_.array.links().end(), empty)) return false;
    return !parts_.exterior || (!parts_.exterior->busy() &&
                                std::all_of(parts_.exterior->links().begin(), parts_.exterior->links().end(),
                                            [&](const std::unique_ptr<Link>& link) { return empty(*link); }));
}

/// Checks that no cell can move. If a step changes anything, a wake was lost, and the verdict would be the
/// model's fault, not the machine's: throws std::logic_error.
void Judge::expect_no_work() {
    const std::uint64_t before = parts_.array.schedule_hash();
    const Cycle stopped = parts_.scheduler.now();
    parts_.scheduler.set_now(stopped + (Cycle(1) << 40));  // past every transfer, cost and back-off
    for (Cell& cell : parts_.array.cells()) cell.step(parts_.scheduler.now());
    parts_.scheduler.set_now(stopped);
    if (joined_.sum(parts_.array.schedule_hash() != before) > 0)
        throw std::logic_error("internal error: a cell that could move was not woken");
}

std::vector<std::string> Judge::stuck_report() const {
    std::vector<std::vector<Joined::RowLine>> sections(2);  // cells, then the border's links
    for (const Cell& cell : parts_.array.cells()) {
        for (std::string& line : describe_blocked(cell)) sections[0].push_back({cell.y(), std::move(line)});
    }
    if (parts_.exterior) {
        for (const auto& link : parts_.exterior->links()) {
            for (int index = 0; index < link->classes(); ++index) {
                if (link->occupancy(index) == 0) continue;
                const Cycle since = std::min(link->arrival(index), parts_.scheduler.now());
                sections[1].push_back({0, "link " + link->name() + " class " + std::to_string(index) +
                                              " since cycle " + std::to_string(since) + ": " +
                                              std::to_string(link->occupancy(index)) + " messages"});
            }
        }
    }
    std::vector<std::string> lines = joined_.lines(std::move(sections));
    const auto age = [](const std::string& line) {
        const auto at = line.find("since cycle ");
        return at == std::string::npos ? 0ULL : std::stoull(line.substr(at + 12));
    };
    std::stable_sort(lines.begin(), lines.end(),
                     [&](const std::string& a, const std::string& b) { return age(a) < age(b); });
    return lines;
}

std::vector<std::pair<int, int>> blocked_cells(const Array& array, std::size_t most) {
    std::vector<std::tuple<Cycle, int, int>> found;  // (since, y, x)
    for (const Cell& cell : array.cells()) {
        // Busy cells without a message in their inputs come last.
        const Cycle since = cell.busy() ? std::min(cell.oldest_arrival(), never - 1) : cell.oldest_arrival();
        if (since != never) found.emplace_back(since, cell.y(), cell.x());
    }
    std::sort(found.begin(), found.end());
    if (found.size() > most) found.resize(most);
    std::vector<std::pair<int, int>> cells;
    for (const auto& [since, y, x] : found) cells.emplace_back(x, y);
    return cells;
}

}  // namespace raycell
