#include "cells/hosts/array.hpp"

#include <algorithm>

#include "cells/channels/split_link.hpp"

namespace raycell {

bool Granularity::is_module(int x, int y) const {
    return every_cell || std::any_of(detail.begin(), detail.end(),
                                     [&](const CellRange& range) { return range.contains(x, y); });
}

std::size_t Granularity::modules(int width, int height) const {
    if (every_cell) return std::size_t(width) * std::size_t(height);
    if (detail.empty()) return 0;
    std::size_t sum = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) sum += is_module(x, y);
    }
    return sum;
}

Array::Array(sc_core::sc_module_name name, Environment& environment, const Granularity& granularity)
    : sc_module(name), environment_(environment), prefetch_(environment.classes, environment.width()) {
    const int width = environment.width();
    const ArrayShare& share = environment.share;
    cells_.reserve(std::size_t(width) * share.rows().size());
    for (const int y : share.rows()) {
        for (int x = 0; x < width; ++x) cells_.emplace_back(environment, x, y);
    }
    make_hosts(granularity);
    make_links();
}

namespace {

/// Makes sure that SystemC finds memory for the names of the next module: its own allocator does not notice
/// that there is none. The block given back is what the next requests are served from.
void ensure_memory() { ::operator delete(::operator new(std::size_t(1) << 16)); }

}  // namespace

void Array::make_hosts(const Granularity& granularity) {
    const auto name_at = [](const char* what, int x, int y) {
        return what + ("_" + std::to_string(x)) + "_" + std::to_string(y);
    };
    const int tile_side = granularity.tile_side;
    const int columns = (environment_.width() + tile_side - 1) / tile_side;
    const int rows = (int(environment_.share.rows().size()) + tile_side - 1) / tile_side;
    for (int i = 0; !granularity.every_cell && i < columns * rows; ++i) {
        const std::string name = name_at("tile", i % columns, i / columns);
        tiles_.push_back(std::make_unique<CellTile>(name.c_str(), environment_, prefetch_));
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Cell& cell = cells_[i];
        ensure_memory();
        if (granularity.own_cells) {
            const std::string name = name_at("own_cell", cell.x(), cell.y());
            if (auto own = granularity.own_cells(name.c_str(), environment_, cell.x(), cell.y())) {
                own->replaces(cell);
                sockets_[i] = std::move(own);
                continue;
            }
        }
        if (granularity.is_module(cell.x(), cell.y())) {
            modules_[i] =
                std::make_unique<CellModule>(name_at("cell", cell.x(), cell.y()).c_str(), environment_, cell);
        } else {
            const int row = environment_.share.place(cell.y()) / tile_side;
            cell.set_host(*tiles_[std::size_t(row * columns + cell.x() / tile_side)]);
        }
    }
}

void Array::make_links() {
    const ArrayShare& share = environment_.share;
    links_.reserve(cells_.size() * side_count);
    ways_.reserve(cells_.size() * side_count);
    for (const int y : share.rows()) {
        for (int x = 0; x < environment_.width(); ++x) {
            for (int side = 0; side < side_count; ++side) make_link(x, y, Side(side));
        }
    }
    for (const Band& band : share.bands()) {
        if (band.above) make_half_links(*band.above, band.first, Side::north);
        if (band.below) make_half_links(*band.below, band.end - 1, Side::south);
    }
}

void Array::make_link(int x, int y, Side side) {
    const int to_x = x + step_x(side);
    const int to_y = y + step_y(side);
    if (to_x < 0 || to_x >= environment_.width() || !environment_.share.contains(to_y)) return;
    Link& link = add_link(to_x, to_y, side);
    stall(link, x, y, side);
    link.connect_source(client(x, y));
    link.connect_sink(client(to_x, to_y));
    bind_out(x, y, side, link);
    bind_in(to_x, to_y, opposite(side), link);
}

/// Makes a link into cell (to_x, to_y); `side` is the side of its source over which it leads.
Link& Array::add_link(int to_x, int to_y, Side side) {
    Link& link = links_.emplace_back(environment_.scheduler, environment_.classes.count,
                                     environment_.machine.buffer_depth, environment_.classes.used_over(side));
    ways_.push_back(std::uint32_t(index(to_x, to_y)) * side_count + std::uint32_t(side));
    return link;
}

void Array::stall(Link& link, int x, int y, Side side) const {
    if (!(environment_.machine.stall > 0)) return;
    environment_.stall(link, "cell_" + std::to_string(x) + "_" + std::to_string(y) + "." + name_of(side));
}

/// Makes the half links between row y and the row beyond it on side `outwards`, which is another rank's. Both
/// ranks make, for each column, the southward link first, then the northward one.
void Array::make_half_links(SplitLinks& split, int y, Side outwards) {
    for (int x = 0; x < environment_.width(); ++x) {
        if (outwards == Side::south) {
            make_half_link_out(split, x, y, outwards);
            make_half_link_in(split, x, y, outwards);
        } else {
            make_half_link_in(split, x, y, outwards);
            make_half_link_out(split, x, y, outwards);
        }
    }
}

void Array::make_half_link_out(SplitLinks& split, int x, int y, Side side) {
    Link& link = split.make_source(environment_.scheduler, environment_.classes.count,
                                   environment_.machine.buffer_depth, environment_.classes.used_over(side));
    stall(link, x, y, side);
    link.connect_source(client(x, y));
    bind_out(x, y, side, link);
}

void Array::make_half_link_in(SplitLinks& split, int x, int y, Side from) {
    Link& link = add_link(x, y, opposite(from));
    split.add_sink(link);
    link.connect_sink(client(x, y));
    bind_in(x, y, from, link);
}

CellModule* Array::module(int x, int y) {
    if (modules_.empty()) return nullptr;
    const auto found = modules_.find(index(x, y));
    return found == modules_.end() ? nullptr : found->second.get();
}

CellSocket* Array::socket(int x, int y) {
    if (sockets_.empty()) return nullptr;
    const auto found = sockets_.find(index(x, y));
    return found == sockets_.end() ? nullptr : found->second.get();
}

Client& Array::client(int x, int y) {
    CellSocket* own = socket(x, y);
    return own ? static_cast<Client&>(*own) : cell(x, y);
}

void Array::bind_in(int x, int y, Side side, Link& link) {
    if (CellSocket* own = socket(x, y)) {
        own->in[std::size_t(side)].bind(link);
    } else if (CellModule* host = module(x, y)) {
        host->in[std::size_t(side)].bind(link);
    } else {
        cell(x, y).connect_in(side, link);
    }
}

void Array::bind_out(int x, int y, Side side, Link& link) {
    if (CellSocket* own = socket(x, y)) {
        own->out[std::size_t(side)].bind(link);
    } else if (CellModule* host = module(x, y)) {
        host->out[std::size_t(side)].bind(link);
    } else {
        cell(x, y).connect_out(side, link);
    }
}

void Array::join_border(int x, int y, Side side, Link& from_outside, Link& to_outside) {
    bind_in(x, y, side, from_outside);
    bind_out(x, y, side, to_outside);
}

void Array::join_row(int y, Link& load) {
    load.connect_sink(client(0, y));
    if (CellSocket* own = socket(0, y)) {
        own->load_in.bind(load);
    } else if (CellModule* host = module(0, y)) {
        host->load_in.bind(load);
    } else {
        cell(0, y).connect_load(load);
    }
}

/// Elaborates the cells in tiles. A module elaborates its own cell: its ports know their links only when
/// elaboration ends.
void Array::end_of_elaboration() {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (modules_.count(i) == 0 && sockets_.count(i) == 0) cells_[i].elaborate();
    }
}

/// After loading: puts the index tables of all cells into one array.
void Array::make_index() {
    std::size_t count = 0;
    for (const Cell& cell : cells_) count += cell.store().index.size();
    if (count == 0 || index_.size() > 0) return;
    index_.reserve(count);
    for (Cell& cell : cells_) {
        const IndexEntry* first = index_.begin() + index_.size();
        for (const IndexEntry& line : cell.store().index) index_.emplace_back(line);
        cell.set_index(first);
    }
}

void Array::begin_phase() {
    if (environment_.phase != Phase::load) make_index();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (sockets_.count(i) > 0) {
            sockets_[i]->begin_phase();
        } else {
            cells_[i].begin_phase();
        }
    }
    wake_all(environment_.scheduler.now() + 1);
}

void Array::begin_tree(int x, int y, int pixel) {
    if (CellSocket* own = socket(x, y)) {
        own->begin_tree(pixel);
    } else {
        cell(x, y).begin_tree(pixel);
    }
    environment_.scheduler.wake(client(x, y), environment_.scheduler.now() + 1);
}

void Array::wake_all(Cycle cycle) {
    for (Cell& cell : cells_) environment_.scheduler.wake(client(cell.x(), cell.y()), cycle);
}

std::uint64_t Array::schedule_hash() const {
    Fnv hash;
    for (const Cell& cell : cells_) hash.add(cell.schedule_hash());
    return hash.value();
}

double Array::bytes(const Granularity& granularity, int width, int height, const BufferClasses& classes) {
    // Links over the border are included, though an array may have none.
    double each = sizeof(Cell);
    for (int side = 0; side < side_count; ++side) {
        each += Link::bytes(classes.used_over(Side(side))) + sizeof(std::uint32_t);
    }
    constexpr double module = 8.3e3;  // bytes, measured: SystemC's ports, process and event
    return each * width * height + module * double(granularity.modules(width, height));
}

}  // namespace raycell
