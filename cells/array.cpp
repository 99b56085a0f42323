#include "cells/array.hpp"

namespace raycell {

Array::Array(sc_core::sc_module_name name, Environment& environment)
    : sc_module(name), environment_(environment) {
    const int width = environment.width();
    const int height = environment.height();
    cells_.reserve(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::string cell_name = "cell_" + std::to_string(x) + "_" + std::to_string(y);
            cells_.push_back(std::make_unique<CellModule>(cell_name.c_str(), environment, x, y));
        }
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (const Side side : {Side::east, Side::south, Side::west, Side::north}) {
                const int to_x = x + step_x(side);
                const int to_y = y + step_y(side);
                if (to_x < 0 || to_x >= width || to_y < 0 || to_y >= height) continue;
                CellModule& source = cell(x, y);
                CellModule& sink = cell(to_x, to_y);
                Link& link = make_link(source, sink, side);
                sinks_.push_back(index(to_x, to_y));
                sides_.push_back(side);
                source.out[std::size_t(side)].bind(link);
                sink.in[std::size_t(opposite(side))].bind(link);
            }
        }
    }
}

Link& Array::make_link(CellModule& source, CellModule& sink, Side side) {
    constexpr const char* names[] = {"east", "south", "west", "north"};
    links_.push_back(std::make_unique<Link>(environment_.scheduler, environment_.classes.count,
                                            environment_.machine.buffer_depth));
    Link& link = *links_.back();
    link.set_name(std::string(source.basename()) + "." + names[int(side)]);
    environment_.stall(link);
    link.connect_source(source);
    link.connect_sink(sink);
    return link;
}

void Array::join_border(int x, int y, Side side, LinkIn* from_outside, LinkOut* to_outside) {
    if (from_outside) cell(x, y).in[std::size_t(side)].bind(*from_outside);
    if (to_outside) cell(x, y).out[std::size_t(side)].bind(*to_outside);
}

void Array::begin_phase() {
    const Cycle next = environment_.scheduler.now() + 1;
    for (const auto& cell : cells_) {
        cell->cell().begin_phase();
        environment_.scheduler.wake(*cell, next);
    }
}

std::uint64_t Array::schedule_hash() const {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const auto& cell : cells_) hash = (hash ^ cell->cell().schedule_hash()) * 0x100000001b3ULL;
    return hash;
}

}  // namespace raycell
