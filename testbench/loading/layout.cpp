#include "testbench/loading/layout.hpp"

namespace raycell::loading {

bool Layout::absent(std::size_t link) const {
    if (link_group(link) != LinkGroup::down) return false;
    const int y = int(link - down(0));
    return y == last_row(lane_of(y));
}

UnitGroup Layout::unit_group(std::size_t unit) const {
    if (unit < precomputation(0)) return UnitGroup::geometry;
    if (unit < distributor(0)) return UnitGroup::precomputation;
    return unit < cell(0, 0) ? UnitGroup::distributors : UnitGroup::cells;
}

Layout::Place Layout::unit_place(std::size_t unit) const {
    switch (unit_group(unit)) {
        case UnitGroup::distributors:
            return {-1, int(unit - distributor(0))};
        case UnitGroup::cells: {
            const std::size_t index = unit - cell(0, 0);
            return {int(index % columns()), int(index / columns())};
        }
        case UnitGroup::geometry:
        case UnitGroup::precomputation:
            break;
    }
    return {};
}

int Layout::unit_lane(std::size_t unit) const {
    switch (unit_group(unit)) {
        case UnitGroup::geometry:
            return int(unit - geometry(0));
        case UnitGroup::precomputation:
            return int(unit - precomputation(0));
        case UnitGroup::distributors:
        case UnitGroup::cells:
            break;
    }
    return lane_of(unit_place(unit).y);
}

std::string Layout::unit_name(std::size_t unit) const {
    const Place place = unit_place(unit);
    // The stages of an only lane have no number, as in the machine.
    const std::string lane = lanes == 1 ? std::string() : "_" + std::to_string(unit_lane(unit));
    switch (unit_group(unit)) {
        case UnitGroup::geometry:
            return "geometry" + lane;
        case UnitGroup::precomputation:
            return "precomputation" + lane;
        case UnitGroup::distributors:
            return "distribution.row_" + std::to_string(place.y);
        case UnitGroup::cells:
            break;
    }
    return "cell_" + std::to_string(place.x) + "_" + std::to_string(place.y);
}

LinkGroup Layout::link_group(std::size_t link) const {
    if (link < trapezes(0)) return LinkGroup::polygons;
    if (link < down(0)) return LinkGroup::trapezes;
    if (link < row(0)) return LinkGroup::down;
    return link < row(0) + rows() ? LinkGroup::rows : LinkGroup::east;
}

Layout::Place Layout::link_place(std::size_t link) const { return unit_place(source_of(link)); }

std::string Layout::link_name(std::size_t link) const {
    const std::string source = unit_name(source_of(link));
    switch (link_group(link)) {
        case LinkGroup::polygons:
        case LinkGroup::trapezes:
            return source + ".out";
        case LinkGroup::down:
            return source + ".down";
        case LinkGroup::rows:
        case LinkGroup::east:
            break;
    }
    return source + ".east";
}

std::size_t Layout::source_of(std::size_t link) const {
    switch (link_group(link)) {
        case LinkGroup::polygons:
            return geometry(int(link - polygons(0)));
        case LinkGroup::trapezes:
            return precomputation(int(link - trapezes(0)));
        case LinkGroup::down:
            return distributor(int(link - down(0)));
        case LinkGroup::rows:
            return distributor(int(link - row(0)));
        case LinkGroup::east:
            break;
    }
    const std::size_t index = link - (row(0) + rows());
    return cell(int(index % (columns() - 1)), int(index / (columns() - 1)));
}

std::size_t Layout::sink_of(std::size_t link) const {
    switch (link_group(link)) {
        case LinkGroup::polygons:
            return precomputation(int(link - polygons(0)));
        case LinkGroup::trapezes:
            return distributor(first_row(int(link - trapezes(0))));
        case LinkGroup::down:
            return source_of(link) + 1;
        case LinkGroup::rows:
            return cell(0, int(link - row(0)));
        case LinkGroup::east:
            break;
    }
    return source_of(link) + 1;
}

std::size_t Layout::input_of(std::size_t unit) const {
    const Place place = unit_place(unit);
    const int lane = unit_lane(unit);
    switch (unit_group(unit)) {
        case UnitGroup::geometry:
        case UnitGroup::precomputation:
            return polygons(lane);
        case UnitGroup::distributors:
            return place.y == first_row(lane) ? trapezes(lane) : down(place.y - 1);
        case UnitGroup::cells:
            break;
    }
    return place.x == 0 ? row(place.y) : east(place.x - 1, place.y);
}

}  // namespace raycell::loading
