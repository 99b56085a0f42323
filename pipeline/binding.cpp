#include "pipeline/binding.hpp"

#include <tuple>

#include "pipeline/machine_parts.hpp"

namespace raycell {
namespace {

using Unit = Binding::Unit;

void consider_links_between_cells(const MachineParts& parts, Binding& most) {
    const Array& array = parts.array;
    for (std::size_t i = 0; i < array.links().size(); ++i) {
        const Cycle cycles = array.links()[i].busy_cycles();
        if (cycles < most.cycles) continue;
        const Side side = array.side_of(i);
        const Cell& sink = array.cells()[array.sink_of(i)];
        most.consider({Unit::cell_link, sink.x() - step_x(side), sink.y() - step_y(side), side, cycles});
    }
}

std::string cell_of(const Binding& b) {
    return "cell (" + std::to_string(b.x) + ", " + std::to_string(b.y) + ")";
}

}  // namespace

void Binding::consider(const Binding& other) {
    const auto place = [](const Binding& b) { return std::tie(b.unit, b.y, b.x, b.side); };
    if (other.cycles > cycles || (other.cycles == cycles && cycles > 0 && place(other) < place(*this)))
        *this = other;
}

std::string name_of(const Binding& b) {
    const std::string row = "row " + std::to_string(b.y);
    switch (b.unit) {
        case Unit::none:
            break;
        case Unit::geometry:
            return "geometry of the lane from " + row;
        case Unit::precomputation:
            return "precomputation of the lane from " + row;
        case Unit::feed_link:
            return "the feed's link into " + row;
        case Unit::distributor:
            return "distributor of " + row;
        case Unit::row_link:
            return "link into the first cell of " + row;
        case Unit::cell_link:
            return std::string("link ") + name_of(b.side) + " of " + cell_of(b);
        case Unit::loading_unit:
            return "loading units of " + cell_of(b);
        case Unit::traversal_unit:
            return "traversal units of " + cell_of(b);
        case Unit::shading_unit:
            return "shading unit of " + cell_of(b);
        case Unit::exterior:
            return "the exterior processors";
        case Unit::exterior_link:
            return "a link of the exterior";
        case Unit::tree:
            return "the tree of pixel (" + std::to_string(b.x) + ", " + std::to_string(b.y) + ") alone";
    }
    return "nothing";
}

Binding binding_of_load(const MachineParts& parts) {
    Binding most;
    for (const auto& lane : parts.lanes) {
        const int y = lane->rows.first;
        most.consider({Unit::geometry, -1, y, Side::east, lane->geometry.statistics().busy_cycles});
        most.consider(
            {Unit::precomputation, -1, y, Side::east, lane->precomputation.statistics().busy_cycles});
        most.consider({Unit::feed_link, -1, y, Side::east, lane->polygons.busy_cycles()});
        most.consider({Unit::feed_link, -1, y, Side::east, lane->trapezes.busy_cycles()});
    }
    for (const int y : parts.environment.share.rows()) {
        const RowDistributor& row = parts.distribution.row(y);
        most.consider({Unit::distributor, -1, y, Side::east, row.statistics().busy_cycles});
        most.consider({Unit::row_link, -1, y, Side::east, row.east->busy_cycles()});
        if (row.down) most.consider({Unit::feed_link, -1, y + 1, Side::east, row.down->busy_cycles()});
    }
    consider_links_between_cells(parts, most);
    for (const Cell& cell : parts.array.cells()) {
        // The mean of the cell's units, which take voxels in turn.
        const Cycle cycles = cell.statistics(parts.scheduler.now()).loading_cycles /
                             Cycle(parts.environment.machine.loading_units);
        most.consider({Unit::loading_unit, cell.x(), cell.y(), Side::east, cycles});
    }
    return most;
}

Binding binding_of_trace(const MachineParts& parts) {
    Binding most;
    const Cycle now = parts.scheduler.now();
    consider_links_between_cells(parts, most);
    const Cycle units = Cycle(parts.environment.machine.traversal_units);
    for (const Cell& cell : parts.array.cells()) {
        const CellStatistics s = cell.statistics(now);
        most.consider({Unit::traversal_unit, cell.x(), cell.y(), Side::east, s.traversal_cycles / units});
        most.consider({Unit::shading_unit, cell.x(), cell.y(), Side::east, s.shading_cycles});
    }
    if (!parts.exterior) return most;
    const auto processors = std::uint64_t(parts.environment.machine.exterior_processors);
    most.consider(
        {Unit::exterior, -1, -1, Side::east, parts.exterior->statistics().busy_cycles / processors});
    for (const auto& link : parts.exterior->links())
        most.consider({Unit::exterior_link, -1, -1, Side::east, link->busy_cycles()});
    return most;
}

}  // namespace raycell
