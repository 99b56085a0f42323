#include "cells/hosts/cell_module.hpp"

namespace raycell {
CellModule::CellModule(sc_core::sc_module_name name, Environment& environment, Cell& cell)
    : CellPorts(name), environment_(environment), cell_(cell) {
    cell_.set_host(*this);
    SC_METHOD(run);
    sensitive << wake_;
    dont_initialize();
}

CellModule::CellModule(sc_core::sc_module_name name, Environment& environment, int x, int y)
    : CellModule(name, environment, *new Cell(environment, x, y)) {
    own_.reset(&cell_);
}

/// The link through which the cell reads a port; null if the port is not bound.
Link* CellModule::link_of(Port<LinkIn>& port) {
    if (port.size() == 0) return nullptr;
    if (auto* link = dynamic_cast<Link*>(port[0])) return link;
    auto& relay = input_relays_.emplace_back(
        std::make_unique<InputRelay>(environment_.scheduler, environment_.classes.count, *port[0]));
    relay->link().connect_sink(cell_);
    channel_events_.push_back(&port->default_event());
    return &relay->link();
}

Link* CellModule::link_of(Port<LinkOut>& port) {
    if (port.size() == 0) return nullptr;
    if (auto* link = dynamic_cast<Link*>(port[0])) return link;
    channel_events_.push_back(&port->default_event());
    return output_relays_
        .emplace_back(std::make_unique<Link>(environment_.scheduler, environment_.classes.count, *port[0]))
        .get();
}

void CellModule::end_of_elaboration() {
    for (int side = 0; side < side_count; ++side) {
        const auto i = std::size_t(side);
        if (Link* link = link_of(in[i])) cell_.connect_in(Side(side), *link);
        if (Link* link = link_of(out[i])) cell_.connect_out(Side(side), *link);
    }
    if (Link* link = link_of(load_in)) cell_.connect_load(*link);
    cell_.elaborate();
    if (channel_events_.empty()) return;
    SC_METHOD(ring);
    for (const sc_core::sc_event* event : channel_events_) sensitive << *event;
    dont_initialize();
}

void CellModule::run() {
    for (auto& relay : input_relays_) relay->look();
    const Cycle next = cell_.step(environment_.scheduler.now());
    if (next != never) environment_.scheduler.wake(cell_, next);
}

}  // namespace raycell
