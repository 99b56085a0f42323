#include <algorithm>
#include <tuple>

#include "testbench/common/knot_report.hpp"

namespace raycell {

using Json = nlohmann::ordered_json;

Json ledger_json(const RunResult& result) {
    const Ledger& ledger = result.ledger;
    Json json = {{"destroyed", ledger.destroyed()},
                 {"listed", ledger.entries().size()},
                 {"wasted_hops", ledger.wasted_hops()},
                 {"wasted_cycles", ledger.wasted_cycles()},
                 {"by_generation", ledger.by_generation()}};
    std::uint64_t pixels = 0;
    std::size_t worst = 0;
    const std::vector<Pixel>& all = result.picture.pixels;
    for (std::size_t i = 0; i < all.size(); ++i) {
        pixels += all[i].postponed > 0;
        if (all[i].postponed > all[worst].postponed) worst = i;
    }
    json["pixels"] = pixels;
    if (pixels > 0) {
        const auto width = std::size_t(result.picture.width);
        json["worst_pixel"] = {
            {"x", worst % width}, {"y", worst / width}, {"postponed", all[worst].postponed}};
    }
    return json;
}

std::string ledger_csv(const Ledger& ledger) {
    std::vector<Ledger::Entry> entries = ledger.entries();
    // Sorted, because cells of one cycle run in any order.
    std::sort(entries.begin(), entries.end(), [](const Ledger::Entry& a, const Ledger::Entry& b) {
        return std::tie(a.cycle, a.y, a.x, a.ray) < std::tie(b.cycle, b.y, b.x, b.ray);
    });
    std::string text = "cycle,x,y,ray,generation,home_x,home_y,launched,hops\n";
    for (const Ledger::Entry& e : entries) {
        text += std::to_string(e.cycle) + ',' + std::to_string(e.x) + ',' + std::to_string(e.y) + ',' +
                ray_name(e.ray) + ',' + std::to_string(e.generation) + ',' + std::to_string(e.home_x) + ',' +
                std::to_string(e.home_y) + ',' + std::to_string(e.launched) + ',' + std::to_string(e.hops) +
                '\n';
    }
    return text;
}

Json time_outs_json(const RunResult& result) {
    Json list = Json::array();
    for (const TimeOutResult& each : result.time_outs) {
        Json json = {{"cycles", each.cycles},
                     {"false_alarms", each.false_alarms},
                     {"early_alarms", each.early_alarms}};
        if (each.knot_cells > 0) {
            json["knot_cells"] = each.knot_cells;
            json["knot_alarms"] = each.knot_alarms;
            json["missed_knots"] = each.missed_knots;
            json["tail_alarms"] = each.tail_alarms;
            if (each.knot_alarms > 0) json["first_alarm_delay"] = each.first_alarm_delay;
        }
        list.push_back(std::move(json));
    }
    return list;
}

}  // namespace raycell
