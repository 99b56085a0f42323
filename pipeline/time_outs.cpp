// The alarms that time-outs in every cell would have raised, compared with the proof.
#include <algorithm>
#include <array>

#include "pipeline/results.hpp"

namespace raycell {

void Results::collect_time_outs(RunResult& result) const {
    const auto index = [&](int x, int y) {
        return std::size_t(y) * std::size_t(parts_.environment.width()) + std::size_t(x);
    };
    // By cell. 2: it holds a node of a knot; 1: only tails.
    std::vector<int> locked(parts_.cell_count(), 0);
    for (const WaitGraph::Node& node : result.waits.nodes()) {
        int& state = locked[index(node.x, node.y)];
        if (node.state == WaitGraph::State::knot) state = 2;
        if (node.state == WaitGraph::State::tail) state = std::max(state, 1);
    }
    const auto seen = [&](WaitGraph::Index i) {
        const WaitGraph::Node& node = result.waits.nodes()[i];
        return parts_.environment.share.contains(node.y) &&
               parts_.array.cell(node.x, node.y).time_out().since() != never;
    };
    std::uint64_t missed = 0;
    for (const auto& knot : result.waits.knots()) {
        missed += joined_.sum(std::uint64_t(std::count_if(knot.begin(), knot.end(), seen))) == 0;
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
        for (std::size_t i = 0; i < parts_.array.cells().size(); ++i) {
            const Cell& cell = parts_.array.cells()[i];
            const TimeOut& time_out = cell.time_out();
            const int state = locked[index(cell.x(), cell.y())];
            (state ? mine.all.early_alarms : mine.all.false_alarms) += time_out.ended(log);
            mine.all.knot_cells += state == 2;
            if (!state || time_out.since() == never) continue;
            ++(state == 2 ? mine.all.knot_alarms : mine.all.tail_alarms);
            if (state == 2) mine.first = std::min(mine.first, time_out.since() + mine.all.cycles);
        }
    }
    sums = joined_.of_all(sums, [](auto& a, const auto& b) {
        for (std::size_t at = 0; at < a.size(); ++at) a[at].join(b[at]);
    });
    for (Sums& all : sums) {
        // When nothing moves any more, a wait that goes on lasts for ever, longer than any time-out.
        all.all.missed_knots = missed;
        if (all.first != never)
            all.all.first_alarm_delay = std::int64_t(all.first) - std::int64_t(result.knot_formed);
        result.time_outs.push_back(all.all);
    }
}

}  // namespace raycell
