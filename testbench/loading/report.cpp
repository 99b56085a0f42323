#include "testbench/loading/report.hpp"

#include <algorithm>
#include <map>

#include "model/machine/message.hpp"
#include "testbench/common/report_json.hpp"

namespace raycell::loading {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> unit_groups = {"geometry", "precomputation", "distribution", "cells"};
constexpr std::array<const char*, 5> link_groups = {"polygons", "trapezes", "down", "rows", "east"};

double share(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

/// Cells at their voxels, which they make while they look at messages.
Json making(const Loading& l) {
    const Layout& layout = l.plan.layout;
    std::uint64_t spans = 0;
    std::uint64_t sum = 0;
    std::uint64_t most_kept = 0;
    std::size_t busiest = layout.cell(0, 0);
    for (std::size_t i = busiest; i < layout.units(); ++i) {
        const UnitUse& use = l.watch.units()[i];
        if (use.making > l.watch.units()[busiest].making) busiest = i;
        spans += use.spans;
        sum += use.making;
        most_kept = std::max(most_kept, use.most_kept);
    }
    const double cycles = double(l.result.load_cycles) * double(l.plan.loading_units);
    const double cells = double(layout.units() - layout.cell(0, 0));
    return {{"spans", spans},
            {"busy_cycles", sum},
            {"busy_share", share(double(sum), cells * cycles)},
            {"busiest", layout.unit_name(busiest)},
            {"busiest_share", share(double(l.watch.units()[busiest].making), cycles)},
            {"most_kept", most_kept}};
}

/// One group of units: sums, and the busiest unit.
Json stage(const Loading& l, UnitGroup group) {
    const Layout& layout = l.plan.layout;
    UnitUse sum;
    std::uint64_t units = 0;
    std::size_t busiest = 0;
    for (std::size_t i = 0; i < layout.units(); ++i) {
        if (layout.unit_group(i) != group) continue;
        const UnitUse& use = l.watch.units()[i];
        if (units == 0 || use.busy_cycles > l.watch.units()[busiest].busy_cycles) busiest = i;
        ++units;
        sum.messages += use.messages;
        sum.busy_cycles += use.busy_cycles;
        sum.starved_cycles += use.starved_cycles;
        sum.blocked_cycles += use.blocked_cycles;
        sum.queue_full += use.queue_full;
        for (std::size_t out = 0; out < sum.waits.size(); ++out) {
            sum.waits[out].full += use.waits[out].full;
            sum.waits[out].busy += use.waits[out].busy;
        }
    }
    const double cycles = double(l.result.load_cycles);
    const double all = double(units) * cycles;
    Json json = {{"units", units},
                 {"messages", sum.messages},
                 {"busy_cycles", sum.busy_cycles},
                 {"busy_share", share(double(sum.busy_cycles), all)},
                 {"busiest", layout.unit_name(busiest)},
                 {"busiest_share", share(double(l.watch.units()[busiest].busy_cycles), cycles)},
                 {"starved_cycles", sum.starved_cycles},
                 {"starved_share", share(double(sum.starved_cycles), all)},
                 {"blocked_cycles", sum.blocked_cycles},
                 {"blocked_share", share(double(sum.blocked_cycles), all)}};
    const auto wait = [](const OutputWait& w) {
        return Json{{"output_full", w.full}, {"output_busy", w.busy}};
    };
    if (group != UnitGroup::distributors) {
        json["waits"] = wait(sum.waits[0]);
    } else {
        json["waits"] = {{"east", wait(sum.waits[0])}, {"down", wait(sum.waits[1])}};
    }
    if (group == UnitGroup::cells) {
        json["waits"]["queue_full"] = sum.queue_full;
        json["voxels"] = making(l);
    }
    return json;
}

double occupancy(const Loading& l, const LinkUse& use) {
    return share(double(use.occupied_cycles), double(l.result.load_cycles));
}

/// One group of links: sums, the one whose wires are busiest, the fullest buffer.
Json links(const Loading& l, LinkGroup group) {
    const Layout& layout = l.plan.layout;
    LinkUse sum;
    std::uint64_t count = 0;
    std::size_t busiest = 0;
    std::size_t fullest = 0;
    const std::vector<LinkUse>& uses = l.watch.links();
    for (std::size_t i = 0; i < layout.links(); ++i) {
        if (layout.link_group(i) != group || layout.absent(i)) continue;
        if (count == 0 || uses[i].wire_cycles > uses[busiest].wire_cycles) busiest = i;
        if (count == 0 || uses[i].occupied_cycles > uses[fullest].occupied_cycles) fullest = i;
        ++count;
        sum.sent += uses[i].sent;
        sum.wire_cycles += uses[i].wire_cycles;
        sum.occupied_cycles += uses[i].occupied_cycles;
        sum.peak = std::max(sum.peak, uses[i].peak);
        sum.depth = uses[i].depth;
    }
    if (count == 0) return {{"links", 0}};
    const double cycles = double(l.result.load_cycles);
    return {{"links", count},
            {"depth", sum.depth},
            {"messages", sum.sent},
            {"busy_share", share(double(sum.wire_cycles), double(count) * cycles)},
            {"busiest", layout.link_name(busiest)},
            {"busiest_share", share(double(uses[busiest].wire_cycles), cycles)},
            {"occupancy",
             {{"peak", sum.peak},
              {"mean", occupancy(l, sum) / double(count)},
              {"fullest", layout.link_name(fullest)},
              {"fullest_mean", occupancy(l, uses[fullest])}}}};
}

/// What the cells of a column received over the links into them.
struct Column {
    Cycle first = never;
    Cycle last_of_first_row = 0;
    Cycle last = 0;
    std::uint64_t messages = 0;
    std::uint64_t voxels = 0;
    std::uint64_t busiest_cell = 0;
};

Column column(const Loading& l, int x) {
    const Layout& layout = l.plan.layout;
    Column sum;
    for (int y = 0; y < layout.height; ++y) {
        const std::size_t cell = layout.cell(x, y);
        const LinkUse& use = l.watch.links()[layout.input_of(cell)];
        sum.first = std::min(sum.first, use.first_arrival);
        sum.last = std::max(sum.last, use.last_arrival);
        if (y == 0) sum.last_of_first_row = use.last_arrival;
        sum.messages += use.delivered;
        sum.voxels += l.cells[cell - layout.cell(0, 0)]->voxels.size();
        const UnitUse& work = l.watch.units()[cell];
        sum.busiest_cell =
            std::max({sum.busiest_cell, work.busy_cycles, work.making / std::uint64_t(l.plan.loading_units)});
    }
    return sum;
}

/// JSON null for `never`.
Json cycle(Cycle c) { return c == never ? Json() : Json(c); }

Json wavefront(const Loading& l) {
    Json first = Json::array();
    Json last = Json::array();
    for (int x = 0; x < l.plan.layout.width; ++x) {
        const Column c = column(l, x);
        first.push_back(cycle(c.first));
        last.push_back(c.first == never ? Json() : Json(c.last));
    }
    return {{"first_arrival", first}, {"last_arrival", last}};
}

Json voxels(const Loading& l) {
    std::map<std::size_t, std::uint64_t> histogram;
    for (const CellStore* cell : l.cells) ++histogram[cell->voxels.size()];
    Json pairs = Json::array();
    for (const auto& [voxels_of_cell, cells] : histogram)
        pairs.push_back(Json::array({voxels_of_cell, cells}));
    const StorageCounts& s = l.result.storage;
    return {{"stored", s.voxels},
            {"occupied_cells", s.occupied_cells},
            {"max_per_cell", s.max_voxels},
            {"mean_per_occupied_cell", share(double(s.voxels), double(s.occupied_cells))},
            {"bits_total", s.bits},
            {"max_bits_per_cell", s.max_cell_bits},
            {"overflowed", s.overflowed},
            {"cells_by_voxels", pairs}};
}

Json checks(const Loading& l) {
    Json json = Json::object();
    for (const auto& [name, faults] : l.checks)
        json[name] = {{"faults", faults.count}, {"first", faults.first}};
    return json;
}

Json bound(const Loading& l) {
    const LoadPlan::Bound bound = l.plan.bound();
    const auto part = [](const LoadPlan::Bound& b) { return Json{{"of", b.of}, {"cycles", b.cycles}}; };
    return {{"cycles", bound.cycles},
            {"of", bound.of},
            {"efficiency", share(double(bound.cycles), double(l.result.load_cycles))},
            {"busiest", part(l.plan.busiest())},
            {"longest_way", part(l.plan.longest_way)}};
}

}  // namespace

Json report(const Loading& l) {
    const RunResult& r = l.result;
    const LoadCounts& items = l.plan.counts;
    const double cycles = double(r.load_cycles);
    const Formats formats(l.picture.numbers.word_bits, l.picture.numbers.rounding, extent_of(l.scene.frame));
    const MessageBits bits = message_bits(l.picture, l.machine, formats);
    Json json;
    json["verdict"] = name_of(r.verdict);
    json["checks"] = checks(l);
    json["cycles"] = {{"load", r.load_cycles},
                      {"per_polygon", share(cycles, double(items.polygons))},
                      {"per_trapeze", share(cycles, double(items.trapezes))},
                      {"per_span", share(cycles, double(items.spans))},
                      {"per_voxel", share(cycles, double(r.storage.voxels))}};
    json["simulated_seconds"] = cycles / (l.machine.clock_mhz * 1e6);
    json["bound"] = bound(l);
    json["items"] = {
        {"polygons", items.polygons},           {"outside", l.scene.polygons.size() - items.polygons},
        {"trapezes", items.trapezes},           {"spans", items.spans},
        {"voxels", r.storage.voxels},           {"sent_polygons", l.plan.sent_polygons},
        {"sent_trapezes", l.plan.sent_trapezes}};
    json["messages"] = {{"sent", r.counters.loads_sent},
                        {"delivered", r.counters.loads_delivered},
                        {"hops", r.counters.load_hops}};
    json["message_bits"] = {
        {"polygon", bits.polygon},          {"vertex", bits.vertex},
        {"features", bits.features},        {"setup", bits.setup(SourceCounts(l.scene.sources, 1))},
        {"surface", bits.surface},          {"trapeze", bits.longest_trapeze()},
        {"span", bits.longest_span()},      {"edge", bits.edge},
        {"end_of_scene", bits.end_of_scene}};
    for (std::size_t i = 0; i < unit_groups.size(); ++i)
        json["stages"][unit_groups[i]] = stage(l, UnitGroup(i));
    for (std::size_t i = 0; i < link_groups.size(); ++i)
        json["links"][link_groups[i]] = links(l, LinkGroup(i));
    json["wavefront"] = wavefront(l);
    json["voxels"] = voxels(l);
    json["report"] = r.report;
    json["hash"] = {{"schedule", hex(r.schedule_hash)}};
    return json;
}

std::string columns_csv(const Loading& l) {
    std::string text =
        "x,first_arrival,last_arrival,last_arrival_row_0,messages,voxels,busiest_cell_cycles\n";
    for (int x = 0; x < l.plan.layout.width; ++x) {
        const Column c = column(l, x);
        text += std::to_string(x) + "," + (c.first == never ? "" : std::to_string(c.first)) + "," +
                std::to_string(c.last) + "," + std::to_string(c.last_of_first_row) + "," +
                std::to_string(c.messages) + "," + std::to_string(c.voxels) + "," +
                std::to_string(c.busiest_cell) + "\n";
    }
    return text;
}

std::string rows_csv(const Loading& l) {
    const Layout& layout = l.plan.layout;
    std::string text =
        "y,taken,busy_cycles,starved_cycles,blocked_cycles,east_full,east_busy,down_full,down_busy,"
        "sent_east,east_wire_cycles,sent_down,down_wire_cycles\n";
    for (int y = 0; y < layout.height; ++y) {
        const UnitUse& use = l.watch.units()[layout.distributor(y)];
        const LinkUse& east = l.watch.links()[layout.row(y)];
        const LinkUse& down = l.watch.links()[layout.down(y)];  // all 0 where it is absent
        const std::uint64_t fields[] = {use.messages,       use.busy_cycles,   use.starved_cycles,
                                        use.blocked_cycles, use.waits[0].full, use.waits[0].busy,
                                        use.waits[1].full,  use.waits[1].busy, east.sent,
                                        east.wire_cycles,   down.sent,         down.wire_cycles};
        text += std::to_string(y);
        for (const std::uint64_t field : fields) text += "," + std::to_string(field);
        text += "\n";
    }
    return text;
}

std::string links_csv(const Loading& l) {
    const Layout& layout = l.plan.layout;
    std::string text =
        "link,group,x,y,messages,wire_cycles,needed_cycles,depth,peak,occupied_cycles,first_arrival,last_"
        "arrival\n";
    for (std::size_t i = 0; i < layout.links(); ++i) {
        if (layout.absent(i)) continue;
        const LinkUse& use = l.watch.links()[i];
        const Layout::Place place = layout.link_place(i);
        text += layout.link_name(i) + "," + link_groups[std::size_t(layout.link_group(i))] + "," +
                std::to_string(place.x) + "," + std::to_string(place.y) + "," + std::to_string(use.sent) +
                "," + std::to_string(use.wire_cycles) + "," + std::to_string(l.plan.links[i].cycles) + "," +
                std::to_string(use.depth) + "," + std::to_string(use.peak) + "," +
                std::to_string(use.occupied_cycles) + "," +
                (use.first_arrival == never ? "" : std::to_string(use.first_arrival)) + "," +
                std::to_string(use.last_arrival) + "\n";
    }
    return text;
}

}  // namespace raycell::loading
